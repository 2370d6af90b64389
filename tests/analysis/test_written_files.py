"""What the analysis writes: whole or not there, in the place of files only, never over what it reads."""

import os
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from written_runs import two_pairs

from analysis.__main__ import main
from analysis.runs.files import write_file

TOP = Path(__file__).resolve().parents[2]


@pytest.mark.parametrize("make", [Path.mkdir, os.mkfifo])
def test_what_is_no_file_is_refused_and_stays(tmp_path, make):
    make(tmp_path / "page.html")
    with pytest.raises(OSError, match="must be a file") as refused:
        write_file(tmp_path / "page.html", "text")
    assert refused.value.filename == str(tmp_path / "page.html") and not (tmp_path / "page.html").is_file()


def test_content_is_on_the_disk_before_it_takes_the_name(tmp_path, monkeypatch):
    calls = []
    for name in ("fsync", "replace"):
        real = getattr(os, name)
        monkeypatch.setattr(os, name, lambda *given, name=name, real=real: (calls.append(name), real(*given))[1])
    write_file(tmp_path / "page.html", "new")
    assert calls == ["fsync", "replace", "fsync"]


def test_a_link_is_replaced_and_what_it_leads_to_stays(tmp_path):
    (tmp_path / "mine.txt").write_text("mine")
    (tmp_path / "page.html").symlink_to("mine.txt")
    write_file(tmp_path / "page.html", "new")
    assert not (tmp_path / "page.html").is_symlink() and (tmp_path / "page.html").read_text() == "new"
    assert (tmp_path / "mine.txt").read_text() == "mine"


@pytest.mark.skipif(not shutil.which("ffmpeg"), reason="ffmpeg is not installed")
def test_a_film_that_is_stopped_leaves_nothing(own):
    two_pairs(own / "runs" / "long", 3.0, 9, states=400)
    command = [sys.executable, "-m", "analysis", "film", str(own / "runs" / "long"), "--out", str(own / "film.mp4")]
    before = set(own.iterdir())
    process = subprocess.Popen(command, cwd=TOP, stderr=subprocess.PIPE, text=True)
    while set(own.iterdir()) == before:
        assert process.poll() is None
        time.sleep(0.001)
    process.terminate()
    assert process.communicate(timeout=60)[1] == "" and process.returncode == 128 + signal.SIGTERM
    assert set(own.iterdir()) == before


# ---- nothing is written over what is read, or what others have written ----


def test_pages_of_others_stay(own, capsys, monkeypatch):
    monkeypatch.chdir(own)
    (own / "runs.csv").write_text("the user's own")
    assert main(["study", "sticking.py", "runs/s1", "--figures", "."]) == 2
    assert "runs.csv: no analysis of sticking has written it; must be another folder" in capsys.readouterr().err
    assert (own / "runs.csv").read_text() == "the user's own"


def test_a_table_is_not_written_over_itself(own, capsys, monkeypatch):
    def study(*runs):
        return main(["study", "sticking.py", *runs, "--figures", "out"])

    monkeypatch.chdir(own)
    study("runs/s1", "runs/s2")
    table, comparison = own / "out" / "runs.csv", own / "out" / "comparison.csv"
    before, text = table.stat(), table.read_text()
    comparison.unlink()
    capsys.readouterr()
    assert study("out/runs.csv") == 0 and comparison.exists()
    assert study("out/runs.csv", "runs/s3") == 2
    assert capsys.readouterr().err == "analysis: out/runs.csv: is what is read; must be another file\n"
    assert os.path.samestat(table.stat(), before) and table.read_text() == text
