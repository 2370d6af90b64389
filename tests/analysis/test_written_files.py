"""What the analysis writes: whole or not there, in the place of files only, never over what it reads."""

import os
import shutil
import signal
import socket
import stat
import subprocess
import sys
import time
from pathlib import Path

import pytest
from written_runs import two_pairs

from analysis.__main__ import main
from analysis.runs.write import remove_unfinished, replacing, write_text

TOP = Path(__file__).resolve().parents[2]

# Command line, and the outputs in whose place a link to a user's file or folder is.
OUTPUTS = [
    ("figures runs/s1 --out out", "motion.png"),
    *(("export runs/s1 --format all --out out", f"{name}") for name in ("run.pvd", "run.xyz", "state_000000.vtm")),
    *(("export runs/s1 --out out", f"state_000000{name}") for name in ("", "/grains.vtp", "/contacts.vtp")),
    ("film runs/s1 --out out/film.mp4", "film.mp4"),
    ("study sticking.py runs --page out/page.html", "page.html"),
    *(("study sticking.py runs --figures out", name) for name in ("runs.csv", "comparison.csv", "sticking.png")),
]


@pytest.mark.parametrize("command, output", OUTPUTS)
def test_no_output_goes_through_a_link(own, monkeypatch, capsys, command, output):
    monkeypatch.chdir(own)
    link, mine = own / "out" / output, own / "mine"
    link.parent.mkdir(parents=True)
    if output == "state_000000":
        mine.mkdir()
    else:
        mine.write_text("mine")
    link.symlink_to(mine)
    assert main(command.split()) == 2
    said = [line for line in capsys.readouterr().err.splitlines() if "left out" not in line]
    assert len(said) == 1 and "leads to another folder; must be a file" in said[0]
    assert link.is_symlink() and (list(mine.iterdir()) == [] if mine.is_dir() else mine.read_text() == "mine")


def _device(path):
    try:
        os.mknod(path, stat.S_IFCHR | 0o600, os.makedev(1, 7))  # /dev/full
    except PermissionError:
        pytest.skip("making a device takes root")


IN_THE_WAY = {
    "a folder": Path.mkdir,
    "a FIFO": os.mkfifo,
    "a socket": lambda path: socket.socket(socket.AF_UNIX).bind(str(path)),
    "a device": _device,
    "a link to a device": lambda path: path.symlink_to("/dev/full"),
    "a link to nothing elsewhere": lambda path: path.symlink_to("../nothing"),
    "a link to a FIFO": lambda path: (os.mkfifo(path.with_name("fifo")), path.symlink_to("fifo")),
}


@pytest.mark.parametrize("kind", IN_THE_WAY)
def test_what_is_no_file_is_refused_and_stays(tmp_path, monkeypatch, kind):
    monkeypatch.chdir(tmp_path)  # a socket's path is short
    IN_THE_WAY[kind](Path("page.html"))
    before = os.lstat("page.html")
    with pytest.raises(OSError, match="; must be a file") as refused:
        write_text("page.html", "text")
    assert refused.value.filename == "page.html" and os.path.samestat(os.lstat("page.html"), before)


def test_a_link_within_the_folder_is_replaced_and_rights_stay(tmp_path):
    (tmp_path / "old.html").write_text("old")
    (tmp_path / "old.html").chmod(0o600)
    (tmp_path / "page.html").symlink_to("old.html")
    for name in ("page.html", "old.html"):
        write_text(tmp_path / name, f"new {name}")
        assert not (tmp_path / name).is_symlink() and (tmp_path / name).read_text() == f"new {name}"
        assert stat.S_IMODE((tmp_path / name).stat().st_mode) == 0o600


def test_what_killed_writers_left_goes_and_what_others_write_stays(tmp_path):
    ready, begun = os.pipe()
    for _ in range(2):
        writer = os.fork()
        if writer == 0:
            with replacing(tmp_path / "page.html"):
                os.write(begun, b".")
                time.sleep(60)
            os._exit(1)
        os.read(ready, 1)
        (own,) = tmp_path.iterdir()  # the second one has removed that of the first
        remove_unfinished(tmp_path)
        assert list(tmp_path.iterdir()) == [own]
        os.kill(writer, signal.SIGKILL)
        os.waitpid(writer, 0)
    (tmp_path / ".thesis.tex.unfinished").write_text("the user's own")
    write_text(tmp_path / "page.html", "whole")
    assert {path.name for path in tmp_path.iterdir()} == {"page.html", ".thesis.tex.unfinished"}


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
