"""The run folder's files, the schedule of samples, the progress bar: without YADE."""

import fcntl
import io
import json
import os
import signal
import subprocess
import sys

import numpy as np
import pytest
from refused import refused
from running import Terminal, wait_for, waits_for_a_lock

from analysis.runs.running import being_written, locked_inodes
from yade_scripts.parameters.errors import InputError
from yade_scripts.run.folder import RunFolder, RunFolderError
from yade_scripts.run.progress import progress_bar
from yade_scripts.run.schedule import MOST_SAMPLES, Schedule


def ended_run(path):
    folder = RunFolder(str(path))
    folder.write_run({"outcome": "completed"})
    folder.write_history({"time": np.zeros(3)})
    folder.write_state(0, {"time": 0.0})
    folder.write_ended()
    os.close(folder._lock)
    return path


def test_files_are_whole_and_a_write_that_fails_leaves_them_as_they_were(tmp_path):
    ended_run(tmp_path / "a" / "b")
    found = {os.path.relpath(os.path.join(at, name), tmp_path) for at, _, names in os.walk(tmp_path) for name in names}
    assert found == {"a/b/run.json", "a/b/history.npz", "a/b/ended", "a/b/states/000000.npz"}
    run = json.loads((tmp_path / "a" / "b" / "run.json").read_text())
    assert {name: run[name] for name in ("format", "outcome")} == {"format": 5, "outcome": "completed"}
    assert {f"a/b/{name}" for name in run["files"]} > found - {"a/b/run.json"}
    folder = RunFolder(str(tmp_path / "run"))
    folder.write_run({"outcome": "running"})
    with pytest.raises(ValueError):
        folder.write_run({"wallTime": float("nan")})
    with open(tmp_path / "run" / "run.json") as file:
        assert json.load(file)["outcome"] == "running"
    assert sorted(os.listdir(tmp_path / "run")) == ["run.json", "states"]


def test_an_ended_run_is_replaced_only_when_asked_and_another_without_asking(tmp_path):
    """One that was killed between the mark of its end and the removal of its checkpoint has both: it is replaced, not resumed."""
    path, other, both = (ended_run(tmp_path / name) for name in ("run", "other", "both"))
    with pytest.raises(RunFolderError, match="holds a run that has ended; must be another folder"):
        RunFolder(str(path))
    RunFolder(str(path), overwrite=True)
    os.unlink(other / "ended")
    RunFolder(str(other))
    (both / "checkpoint").mkdir()
    (both / "checkpoint" / "recorder.npz").write_bytes(b"")
    assert RunFolder(str(both), overwrite=True, resume=True).checkpoint is None
    for folder in (path, other, both):
        assert sorted(os.listdir(folder)) == ["run.json", "states"] and os.listdir(folder / "states") == []


@pytest.mark.parametrize("overwrite", [False, True])
def test_a_run_that_ends_while_its_folder_is_opened_is_not_erased(tmp_path, monkeypatch, overwrite):
    """The other run comes to its end, and gives up its lock, in the moment before this one takes it."""
    path = tmp_path / "run"
    other = RunFolder(str(path))
    other.write_history({"time": np.zeros(3)})
    take = fcntl.flock

    def ends_then_take(handle, how):
        other.write_ended()
        os.close(other._lock)
        take(handle, how)

    monkeypatch.setattr(fcntl, "flock", ends_then_take)
    if overwrite:
        RunFolder(str(path), overwrite=True)
        assert sorted(os.listdir(path)) == ["run.json", "states"]
        return
    with pytest.raises(RunFolderError, match="holds a run that has ended"):
        RunFolder(str(path))
    assert sorted(os.listdir(path)) == ["ended", "history.npz", "run.json", "states"]


@pytest.mark.parametrize(
    "left", [[], [".run.json.0123abcd.unfinished"], ["states/.000000.npz.0123abcd.unfinished"]], ids=str
)
def test_a_folder_that_a_killed_run_began_is_used(tmp_path, left):
    """states/ without run.json is what version 0.2 left."""
    (tmp_path / "run" / "states").mkdir(parents=True)
    for name in left:
        (tmp_path / "run" / name).write_bytes(b"half")
    RunFolder(str(tmp_path / "run"))
    assert sorted(os.listdir(tmp_path / "run")) == ["run.json", "states"]
    assert os.listdir(tmp_path / "run" / "states") == []


def test_a_folder_in_use_is_refused_until_the_run_is_gone(tmp_path):
    path = str(tmp_path / "run")
    begun, has_begun = os.pipe()
    other = os.fork()
    if other == 0:
        RunFolder(path)
        os.write(has_begun, b".")
        signal.pause()
    os.read(begun, 1)
    with pytest.raises(RunFolderError, match="another run is writing there"):
        RunFolder(path)
    os.kill(other, signal.SIGKILL)
    os.waitpid(other, 0)
    RunFolder(path)


LOCKS = """1: FLOCK  ADVISORY  WRITE 1234 08:01:131 0 EOF
1: -> FLOCK  ADVISORY  WRITE 5678 08:01:77 0 EOF
2: POSIX  ADVISORY  READ 1111 00:1a:17 128 128
4: FLOCK  ADVISORY  READ -1 fd:01:4026531992 0 EOF
"""


def test_a_process_that_waits_for_a_lock_does_not_hold_it(tmp_path):
    """A waiting process has a line of its own in the kernel's list."""
    path = str(tmp_path / "run")
    assert not being_written(path)
    folder = RunFolder(path)
    script = "import fcntl, os, sys; print(flush=True); fcntl.flock(os.open(sys.argv[1], os.O_RDONLY), fcntl.LOCK_EX)"
    with subprocess.Popen([sys.executable, "-c", script, path], stdout=subprocess.PIPE) as waiting:
        waiting.stdout.readline()
        wait_for(lambda: waits_for_a_lock(waiting.pid))
        assert being_written(path) and not being_written(str(tmp_path))
        waiting.kill()
    os.close(folder._lock)
    assert not being_written(path)
    assert locked_inodes(LOCKS.splitlines(keepends=True)) == {131, 4026531992}


def contents(folder):
    """{name: text, or where a link leads} of everything in a folder."""
    return {
        os.path.relpath(path, folder): os.readlink(path) if path.is_symlink() else path.read_text(errors="replace")
        for path in sorted(folder.rglob("*"))
        if path.is_symlink() or not path.is_dir()
    }


FOREIGN = "run.json has no list of the files that a run wrote"
MINE = ("history.npz", "states/000000.npz", "states/mine.npz", "checkpoint/recorder.npz", "checkpoint/mine", "mine")


OTHERS = {
    "no run": ({"thesis.tex": "x"}, "exists and is no run folder"),
    "states that someone put aside": ({"states/000000.npz": "x"}, "exists and is no run folder"),
    "a heartbeat": ({"heartbeat.json": '{"pulse": 60}'}, "exists and is no run folder"),
    "no JSON": ({"run.json": "no json"}, FOREIGN),
    "a list": ({"run.json": "[]"}, FOREIGN),
    "version 0.3": ({"run.json": '{"format": 3, "parameters": {}, "derived": {}}', "ended": ""}, FOREIGN),
    "a list that leads out": ({"run.json": '{"format": 3, "files": ["../mine", "history.npz"]}'}, FOREIGN),
    "others' files": ({"run.json": '{"format": 3, "files": []}'}, "no run has written it; must be moved|no.* checkpoint"),
}  # fmt: skip


@pytest.mark.parametrize("what", OTHERS)
@pytest.mark.parametrize("options", [{}, {"overwrite": True}, {"resume": True, "overwrite": True}], ids=str)
def test_a_folder_of_other_files_is_left_as_it_is(tmp_path, what, options):
    (files, message), path = OTHERS[what], tmp_path / "run"
    mine = dict.fromkeys(MINE if "run.json" in files else (), "mine")
    for name, text in {**mine, **files}.items():
        (path / name).parent.mkdir(parents=True, exist_ok=True)
        (path / name).write_text(text)
    before = contents(path)
    with pytest.raises(InputError, match=message) as error:
        RunFolder(str(path), **options)
    assert contents(path) == before and "\n" not in str(error.value)


def test_a_file_is_left_as_it_is_and_an_unwritable_folder_is_one_line(tmp_path):
    (tmp_path / "run").write_text("mine")
    places = {tmp_path / "run": "is a file; must be a folder", "x" * 256: "File name too long", "/proc/run": ""}
    for path, words in places.items():
        with refused(RunFolderError, f"out = {path}: ", words, "must be a folder"):
            RunFolder(str(path), overwrite=True)


@pytest.mark.parametrize("name", ["states", "checkpoint"])
def test_links_out_of_an_ended_run_are_not_followed(tmp_path, name):
    """A disk was full, and someone has moved a part of the run elsewhere."""
    path, elsewhere = ended_run(tmp_path / "run"), tmp_path / "elsewhere"
    (path / "checkpoint").mkdir()
    (path / "checkpoint" / "scene-3.yade").touch()
    (path / name).rename(elsewhere)
    (path / name).symlink_to(elsewhere)
    before = contents(tmp_path)
    with pytest.raises(RunFolderError, match=f"{name}.*: is a link"):
        RunFolder(str(path), overwrite=True)
    assert contents(tmp_path) == before


def test_what_others_put_into_a_run_folder_stays(tmp_path):
    path = ended_run(tmp_path / "run")
    others = {"notes.txt", "states/mine.npz", "states/999999.npz", "checkpoint/mine"}
    (path / "checkpoint").mkdir()
    for name in (*others, "checkpoint/scene-3.yade"):
        (path / name).write_text("mine")
    RunFolder(str(path), overwrite=True)
    assert set(contents(path)) == others | {"run.json"}


def test_schedule():
    for duration, steps, interval in ((250e-9, 12950, 43), (1e-12, 1, 1), (10e-12, 10, 1), (1e-6, 51800, 50)):
        schedule = Schedule.of(duration, duration / steps)
        assert steps <= schedule.steps < steps + interval and schedule.interval == interval
        samples = schedule.steps // interval
        assert samples * interval == schedule.steps and samples >= min(300, steps)
        assert {0, samples} <= schedule.states <= set(range(samples + 1))
        assert len(schedule.states) == min(22, samples + 1)
    schedule = Schedule.of(1.0, 1e-9)  # of very many steps: a history that fits in memory
    samples = schedule.steps // schedule.interval
    assert 1e9 <= schedule.steps < 1e9 + schedule.interval and 0.9 * MOST_SAMPLES < samples <= MOST_SAMPLES


def test_progress_shows_the_time_left_on_a_terminal_only():
    quiet, terminal = io.StringIO(), Terminal()
    for stream in (quiet, terminal):
        bar = progress_bar(200, 10, stream)
        if stream is terminal:
            bar.start_t -= 10  # ten seconds ago
        bar.update(40)
        bar.refresh()
        bar.close()
    assert quiet.getvalue() == ""
    assert " 25%|" in terminal.getvalue() and "00:10<00:37" in terminal.getvalue()
    assert terminal.getvalue().endswith("\r")
