"""Sums of ended runs: damage is found by what reads the file, and by `analysis verify`; what the
analysis writes is whole or not there, and never in the place of what it reads."""

import os
import shutil
import subprocess

import pytest
from written_runs import flip, unseal

from analysis import table
from analysis.__main__ import main
from analysis.runs.files import RunFolderError, write_file
from analysis.runs.folder import open_run
from analysis.runs.status import NO_SUMS

FILES = ("run.json", "history.npz", "states/000002.npz", "ended")
DAMAGE = {
    "a flipped bit": lambda file, other: flip(file),
    "of another run": lambda file, other: shutil.copy(other, file),
    "missing": lambda file, other: file.unlink(),
}


def everything(path):
    found = open_run(path)
    return found.ended, found.states.times, [found.states[k] for k in range(len(found.states))]


@pytest.mark.parametrize("how", DAMAGE)
@pytest.mark.parametrize("name", FILES)
def test_damage_is_found_where_it_is_read_by_verify_and_by_sha256sum(run, cluster_folder, capsys, name, how):
    (run / "notes.txt").write_text("mine")  # a file of one's own is no harm
    everything(run)
    assert main(["verify", str(run)]) == 0
    check = ["sha256sum", "--check", "--strict", "ended"]
    assert subprocess.run(check, cwd=run, capture_output=True).returncode == 0
    DAMAGE[how](run / name, cluster_folder / name)
    if (name, how) == ("ended", "missing"):  # one that has not ended
        assert not open_run(run).ended
    else:
        with pytest.raises(RunFolderError):
            everything(run)
    assert main(["verify", str(run)]) == 2
    assert name in capsys.readouterr().err or name == "ended"
    assert subprocess.run(check, cwd=run, capture_output=True).returncode != 0


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


# ---- what is written ----


def test_content_is_on_the_disk_before_it_takes_the_name(tmp_path, monkeypatch):
    calls = []
    for name in ("fsync", "replace"):
        real = getattr(os, name)
        monkeypatch.setattr(os, name, lambda *given, name=name, real=real: (calls.append(name), real(*given))[1])
    write_file(tmp_path / "page.html", "new")
    assert calls == ["fsync", "replace", "fsync"]


def test_files_of_others_and_what_is_read_are_not_written_over(own, capsys, monkeypatch):
    def study(*runs, to="out"):
        return main(["study", "sticking.py", *runs, "--figures", to])

    monkeypatch.chdir(own)
    (own / "runs.csv").write_text("the user's own")
    assert study("runs/s1", to=".") == 2 and (own / "runs.csv").read_text() == "the user's own"
    assert "runs.csv: no analysis of sticking has written it" in capsys.readouterr().err
    (own / "out").mkdir()
    (own / "out" / "README.md").write_text("the user's own")
    study("runs/s1", "runs/s2")
    table, comparison = own / "out" / "runs.csv", own / "out" / "comparison.csv"
    before, text = table.stat(), table.read_text()
    comparison.unlink()
    capsys.readouterr()
    assert study("out/runs.csv") == 0 and comparison.exists()
    assert study("out/runs.csv", "runs/s3") == 2 and "is what is read" in capsys.readouterr().err
    assert os.path.samestat(table.stat(), before) and table.read_text() == text
    assert (own / "out" / "README.md").read_text() == "the user's own"
