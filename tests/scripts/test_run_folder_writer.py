"""The run folder's files and the schedule of samples: without YADE."""

import json
import os

import numpy as np
import pytest
from refused import refused

from analysis.runs import lock
from yade_scripts.parameters.errors import InputError
from yade_scripts.run.folder import RunFolder
from yade_scripts.run.kind import MOST_SAMPLES, Schedule

RUN = {"parameters": {}, "derived": {}, "outcome": "completed"}


def ended_run(path):
    folder = RunFolder(str(path))
    folder.write_run(RUN)
    folder.write_history({"time": np.zeros(3)})
    folder.write_state(0, {"time": 0.0})
    folder.write_ended()
    folder.close()
    return path


def test_files_are_whole_and_a_write_that_fails_leaves_them_as_they_were(tmp_path):
    ended_run(tmp_path / "a" / "b")
    found = {os.path.relpath(os.path.join(at, name), tmp_path) for at, _, names in os.walk(tmp_path) for name in names}
    assert found == {"a/b/run.json", "a/b/history.npz", "a/b/ended", "a/b/states/000000.npz"}
    folder = RunFolder(str(tmp_path / "run"))
    folder.write_run({"outcome": "running"})
    with pytest.raises(ValueError):
        folder.write_run({"wallTime": float("nan")})
    assert json.loads((tmp_path / "run" / "run.json").read_text())["outcome"] == "running"
    assert sorted(os.listdir(tmp_path / "run")) == ["lock", "run.json"]


def test_an_ended_run_is_replaced_only_with_overwrite_and_another_without(tmp_path):
    """One that was killed between the mark of its end and the removal of its checkpoint has both: it is replaced, not
    resumed."""
    path, other, both = (ended_run(tmp_path / name) for name in ("run", "other", "both"))
    with pytest.raises(InputError, match="holds a run that has ended; must be another folder"):
        RunFolder(str(path))
    os.unlink(other / "ended")
    (both / "checkpoint").mkdir()
    (both / "checkpoint" / "recorder.npz").write_bytes(b"")
    for folder, options in ((path, {"overwrite": True}), (other, {}), (both, {"overwrite": True, "resume": True})):
        opened = RunFolder(str(folder), **options)
        assert opened.checkpoint is None
        opened.close()
        assert [file for file in folder.rglob("*") if file.is_file()] == []


def test_a_run_that_ends_while_its_folder_is_opened_is_not_erased(tmp_path, monkeypatch):
    """The other run comes to its end in the moment before this one takes its lock."""
    other, take = RunFolder(str(tmp_path / "run")), lock.take
    other.write_run(RUN)

    def ends_then_take(path):
        other.write_ended()
        other.close()
        return take(path)

    monkeypatch.setattr(lock, "take", ends_then_take)
    with pytest.raises(InputError, match="holds a run that has ended"):
        RunFolder(other.path)
    assert sorted(os.listdir(other.path)) == ["ended", "run.json"]


def contents(folder):
    """{name: text, or where a link leads} of everything in a folder."""
    return {
        os.path.relpath(path, folder): os.readlink(path) if path.is_symlink() else path.read_text(errors="replace")
        for path in sorted(folder.rglob("*"))
        if path.is_symlink() or not path.is_dir()
    }


OTHERS = {
    "no run": {"thesis.tex": "x"},
    "no JSON": {"run.json": "no json", "history.npz": "mine"},
    "another program's": {"run.json": '{"format": 3, "outcome": "fine"}', "history.npz": "mine"},
}


@pytest.mark.parametrize("what", OTHERS)
def test_a_folder_of_other_files_is_left_as_it_is(tmp_path, what):
    for name, text in OTHERS[what].items():
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(text)
    before = contents(tmp_path)
    for options in ({}, {"overwrite": True}, {"resume": True, "overwrite": True}):
        with refused(InputError, "exists and is no run folder"):
            RunFolder(str(tmp_path), **options)
    assert contents(tmp_path) == before


def test_what_others_put_into_a_run_folder_stays(tmp_path):
    path = ended_run(tmp_path / "run")
    others = {"notes.txt", "states/mine.npz", "checkpoint/mine"}
    (path / "checkpoint").mkdir()
    for name in (*others, "checkpoint/scene-3.yade"):
        (path / name).write_text("mine")
    RunFolder(str(path), overwrite=True).close()
    assert set(contents(path)) == others


@pytest.mark.parametrize("name", ["states", "checkpoint"])
def test_links_out_of_an_ended_run_are_not_followed(tmp_path, name):
    """A disk was full, and someone has moved a part of the run elsewhere."""
    path, elsewhere = ended_run(tmp_path / "run"), tmp_path / "elsewhere"
    (path / "checkpoint").mkdir()
    (path / name).rename(elsewhere)
    (path / name).symlink_to(elsewhere)
    before = contents(tmp_path)
    with pytest.raises(InputError, match=f"{name} is a link"):
        RunFolder(str(path), overwrite=True)
    assert contents(tmp_path) == before


def test_an_unwritable_folder_is_one_line(tmp_path):
    (tmp_path / "run").write_text("mine")
    places = {tmp_path / "run": "is a file; must be a folder", "x" * 256: "File name too long", "/proc/run": ""}
    for path, words in places.items():
        with refused(InputError, f"out = {path}: ", words, "must be a folder"):
            RunFolder(str(path), overwrite=True)


def test_a_schedule_has_both_ends_and_fits_into_memory():
    for duration, steps, interval in ((250e-9, 12950, 43), (1e-12, 1, 1), (10e-12, 10, 1), (1e-6, 51800, 50)):
        schedule = Schedule.of(duration, duration / steps)
        assert steps <= schedule.steps < steps + interval and schedule.interval == interval
        samples = schedule.steps // interval
        assert samples * interval == schedule.steps and samples >= min(300, steps)
        assert {0, samples} <= schedule.states <= set(range(samples + 1))
        assert len(schedule.states) == min(22, samples + 1)
    schedule = Schedule.of(1.0, 1e-9)  # of very many steps
    samples = schedule.steps // schedule.interval
    assert 1e9 <= schedule.steps < 1e9 + schedule.interval and 0.9 * MOST_SAMPLES < samples <= MOST_SAMPLES
