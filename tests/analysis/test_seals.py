"""Sums of ended runs and of studies' tables: every damage is found by what reads the file, and by `analysis verify`."""

import re
import shutil
import subprocess

import pytest
from written_runs import flip, unseal

from analysis import table
from analysis.__main__ import main
from analysis.runs.files import RunFolderError, read_summed
from analysis.runs.folder import open_run
from analysis.runs.verify import NO_SUMS
from analysis.studies.study import GALLERY

FILES = ("run.json", "history.npz", "states/000000.npz", "states/000002.npz", "ended")


def cut(file, other):
    file.write_bytes(file.read_bytes()[:-7])


def change_digit(file, other):
    """The last one of a number."""
    file.write_text(re.sub(r"\d(?=[,\n}])", lambda digit: str((int(digit[0]) + 1) % 10), file.read_text(), count=1))


DAMAGE = {
    "a flipped bit": lambda file, other: flip(file),
    "truncated": cut,
    "emptied": lambda file, other: file.write_bytes(b""),
    "of another run": lambda file, other: shutil.copy(other, file),
    "missing": lambda file, other: file.unlink(),
}
EDITED = {"a changed digit": change_digit, "a format without sums": lambda file, other: unseal(file.parent)}


def everything(path):
    found = open_run(path)
    return found.ended, found.states.times, [found.states[k] for k in range(len(found.states))]


CASES = [(name, how) for name in FILES for how in DAMAGE if (name, how) != ("ended", "missing")]  # not ended then


@pytest.mark.parametrize("name, how", CASES + [("run.json", "a changed digit")])
def test_damage_is_found_where_it_is_read_and_by_verify(run, cluster_folder, capsys, name, how):
    everything(run)
    assert main(["verify", str(run)]) == 0 and "5 files, as the run has left them" in capsys.readouterr().out
    {**DAMAGE, **EDITED}[how](run / name, cluster_folder / name)
    with pytest.raises(RunFolderError) as error:
        everything(run)
    assert main(["verify", str(run)]) == 2
    said = capsys.readouterr().err
    for text in (str(error.value), said):
        assert name in text or name == "ended"
        assert "Traceback" not in text


def test_a_mark_that_is_gone_is_noticed(run, capsys):
    (run / "ended").unlink()
    assert main(["verify", str(run)]) == 2 and "ended: missing, though the run is completed" in capsys.readouterr().err
    (run / "run.json").unlink()
    assert main(["verify", str(run)]) == 2 and "neither run.json nor ended" in capsys.readouterr().err


def test_tables_beside_runs_are_read_too(run, capsys):
    (run.parent / "figures").mkdir()
    for file in (run.parent / "runs.csv", run.parent / "figures/runs.csv"):
        shutil.copy(GALLERY / "viscous/runs.csv", file)
    (run.parent / "comparison.json").write_text("of another program")
    assert main(["verify", str(run.parent)]) == 0
    flip(run.parent / "figures/runs.csv")
    assert main(["verify", str(run.parent)]) == 2 and "figures/runs.csv" in capsys.readouterr().err


def test_states_in_each_others_place_and_one_too_many(run, capsys):
    first, last = (run / "states" / name for name in ("000000.npz", "000002.npz"))
    shutil.copy(first, run / "states" / "000003.npz")
    with pytest.raises(RunFolderError, match="000003.npz: not of this run"):
        open_run(run)
    assert main(["verify", str(run)]) == 2 and "000003.npz: not of this run" in capsys.readouterr().err
    (run / "states" / "000003.npz").rename(last)
    with pytest.raises(RunFolderError, match="000002.npz: not as it was written"):
        open_run(run).last


def test_files_of_ones_own_are_said_and_no_harm(run, capsys):
    (run / "notes.txt").write_text("mine")
    (run / "states" / "notes.txt").write_text("mine")
    everything(run)
    assert main(["verify", str(run)]) == 0
    assert "also holds notes.txt, states/notes.txt, which the run has not written" in capsys.readouterr().out


def test_sha256sum_reads_the_same(run):
    check = ["sha256sum", "--check", "--strict", "ended"]
    assert subprocess.run(check, cwd=run, capture_output=True).returncode == 0
    flip(run / "history.npz")
    assert b"history.npz: FAILED" in subprocess.run(check, cwd=run, capture_output=True).stdout


def test_runs_without_sums_are_read_and_verify_says_so(run, capsys):
    for name in ("a", "b"):
        unseal(shutil.copytree(run, run.parent / "runs" / name))
    everything(run.parent / "runs" / "a")
    assert len(table(run.parent / "runs")) == 2
    assert main(["verify", str(run.parent)]) == 0 and capsys.readouterr().out.count(NO_SUMS) == 2


@pytest.mark.parametrize("how", [how for how in DAMAGE if how != "missing"] + ["a changed digit"])
def test_damaged_tables_of_studies(tmp_path, capsys, how, name="runs.csv"):
    own = {study: tmp_path / f"{study}-{name}" for study in ("viscous", "sintered")}
    file, other = (shutil.copy(GALLERY / study / name, copy) for study, copy in own.items())
    assert main(["verify", str(file)]) == 0 and read_summed(file)
    if how == "of another run":  # a row of it
        rows = other.read_text().splitlines()
        file.write_text(file.read_text() + rows[-1])
    else:
        {**DAMAGE, **EDITED}[how](file, other)
    with pytest.raises(RunFolderError, match=str(file)):
        read_summed(file)
    assert main(["verify", str(file)]) == 2 and str(file) in capsys.readouterr().err
    assert main(["study", "viscous", str(file)]) == 2
