"""The run folder's files and the schedule of samples: without YADE."""

import json
import os

import numpy as np
import pytest
from refused import refused

from yade_scripts.parameters import InputError
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


def contents(folder):
    """{name: text, or where a link leads} of everything in a folder."""
    return {
        os.path.relpath(path, folder): os.readlink(path) if path.is_symlink() else path.read_text(errors="replace")
        for path in sorted(folder.rglob("*"))
        if path.is_symlink() or not path.is_dir()
    }


def test_a_folder_or_file_of_others_is_left_as_it_is(tmp_path):
    (tmp_path / "others").mkdir()
    (tmp_path / "others" / "run.json").write_text('{"format": 3, "outcome": "fine"}')
    (tmp_path / "file").write_text("mine")
    before = contents(tmp_path)
    for name, words in {"others": "exists and is no run folder", "file": "is a file; must be a folder"}.items():
        with refused(InputError, words):
            RunFolder(str(tmp_path / name), resume=True, overwrite=True)
    assert contents(tmp_path) == before


def test_what_others_put_into_a_run_folder_stays_and_links_out_of_it_are_not_followed(tmp_path):
    path = ended_run(tmp_path / "run")
    others = {"notes.txt", "states/mine.npz"}
    for name in others:
        (path / name).write_text("mine")
    RunFolder(str(path), overwrite=True).close()
    assert set(contents(path)) == others
    (path / "states").rename(tmp_path / "elsewhere")
    (path / "states").symlink_to(tmp_path / "elsewhere")
    (path / "run.json").write_text('{"format": 4, "kind": "collision", "parameters": {}, "derived": {}}')
    before = contents(tmp_path)
    with pytest.raises(InputError, match="states is a link"):
        RunFolder(str(path), overwrite=True)
    assert contents(tmp_path) == before


def test_a_schedule_has_both_ends_and_fits_into_memory():
    cases = (250e-9, 12950, 43), (1e-12, 1, 1), (10e-12, 10, 1), (1e-6, 51800, 172), (1e-6, 70000, 200)
    for duration, steps, interval in cases:
        schedule = Schedule.of(duration, duration / steps)
        assert steps <= schedule.steps < steps + interval and schedule.interval == interval
        samples = schedule.steps // interval
        assert samples * interval == schedule.steps and samples >= min(300, steps)
        assert {0, samples} <= schedule.states <= set(range(samples + 1))
        assert len(schedule.states) == min(22, samples + 1)
    schedule = Schedule.of(1.0, 1e-9)  # of very many steps
    samples = schedule.steps // schedule.interval
    assert 1e9 <= schedule.steps < 1e9 + schedule.interval and 0.9 * MOST_SAMPLES < samples <= MOST_SAMPLES
