"""Sums of ended runs: damage is found by what reads the file, and by `analysis verify`."""

import shutil
import subprocess

import pytest
from written_runs import flip, unseal

from analysis import table
from analysis.__main__ import main
from analysis.runs.files import RunFolderError
from analysis.runs.folder import open_run
from analysis.runs.status import NO_SUMS

FILES = ("run.json", "history.npz", "states/000000.npz", "states/000002.npz", "ended")
DAMAGE = {
    "a flipped bit": lambda file, other: flip(file),
    "truncated": lambda file, other: file.write_bytes(file.read_bytes()[:-7]),
    "emptied": lambda file, other: file.write_bytes(b""),
    "of another run": lambda file, other: shutil.copy(other, file),
    "missing": lambda file, other: file.unlink(),
}


def everything(path):
    found = open_run(path)
    return found.ended, found.states.times, [found.states[k] for k in range(len(found.states))]


@pytest.mark.parametrize("how", DAMAGE)
@pytest.mark.parametrize("name", FILES)
def test_damage_is_found_where_it_is_read_and_by_verify(run, cluster_folder, capsys, name, how):
    everything(run)
    assert main(["verify", str(run)]) == 0 and "5 files, as the run has left them" in capsys.readouterr().out
    DAMAGE[how](run / name, cluster_folder / name)
    if (name, how) == ("ended", "missing"):  # one that has not ended
        assert not open_run(run).ended
    else:
        with pytest.raises(RunFolderError):
            everything(run)
    assert main(["verify", str(run)]) == 2
    assert name in capsys.readouterr().err or name == "ended"


def test_states_in_each_others_place_and_one_too_many(run, capsys):
    first, last = (run / "states" / name for name in ("000000.npz", "000002.npz"))
    shutil.copy(first, run / "states" / "000003.npz")
    with pytest.raises(RunFolderError, match="000003.npz: not of this run"):
        open_run(run)
    assert main(["verify", str(run)]) == 2 and "000003.npz: not of this run" in capsys.readouterr().err
    (run / "states" / "000003.npz").rename(last)
    with pytest.raises(RunFolderError, match="000002.npz: not as it was written"):
        open_run(run).last


def test_files_of_ones_own_are_named_and_no_harm(run, capsys):
    (run / "notes.txt").write_text("mine")
    everything(run)
    assert main(["verify", str(run)]) == 0
    assert "also holds notes.txt, which the run has not written" in capsys.readouterr().out


def test_sha256sum_reads_the_same(run):
    check = ["sha256sum", "--check", "--strict", "ended"]
    assert subprocess.run(check, cwd=run, capture_output=True).returncode == 0
    flip(run / "history.npz")
    assert b"history.npz: FAILED" in subprocess.run(check, cwd=run, capture_output=True).stdout


def test_formats_before_5_are_read(run, capsys):
    """Format 4 had sums of archives' ends in lines that begin with #; those before had none, and an empty `ended`."""
    lines = (run / "ended").read_text().splitlines()
    more = ['# {"sha256": "0", "check": "sha256sum -c ended"}', *lines, f"# {64 * '0'}  history.npz from byte 7 on"]
    (run / "ended").write_text("\n".join(more) + "\n")
    everything(run)
    unseal(shutil.copytree(run, run.parent / "runs" / "old"))
    everything(run.parent / "runs" / "old")
    assert len(table(run.parent / "runs")) == 1
    assert main(["verify", str(run.parent)]) == 0 and capsys.readouterr().out.count(NO_SUMS) == 1
