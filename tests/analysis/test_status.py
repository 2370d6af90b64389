"""What has become of runs, from their folders alone."""

import json
import os

import numpy as np
import pytest

from analysis.__main__ import main
from analysis.runs.format import ENDED_FILE, HISTORY_FILE, RUN_FILE, STATES_FOLDER
from analysis.runs.status import DONE, FAILED, RUNNING, SILENCE, WAITING, progress_of, run_of, state

NOW = 1_700_000_000.0


def run_folder(path, outcome, progress=None, begun=100.0, written=10.0, wall_time=0.0, ended=False):
    """A run of 1000 s of wall time that began `begun` and last wrote its history `written` seconds before NOW."""
    (path / STATES_FOLDER).mkdir(parents=True)
    run = {"outcome": outcome, "wallTime": wall_time, "derived": {"steps": 100, "timeStep": 0.01}}
    (path / RUN_FILE).write_text(json.dumps(run))
    if progress is not None:
        np.savez(path / HISTORY_FILE, time=np.array([0.0, progress]))
        os.utime(path / HISTORY_FILE, (NOW - written, NOW - written))
    if ended:
        (path / ENDED_FILE).touch()
    for name in (RUN_FILE, STATES_FOLDER):
        os.utime(path / name, (NOW - begun, NOW - begun))
    return path


def test_runs_that_are_silent_or_said_that_they_stop_are_waiting(tmp_path):
    """Figures made of them are no sign of life."""
    found = state(run_folder(tmp_path / "r", "running", 0.5, begun=SILENCE + 200.0, written=SILENCE + 1.0), NOW)
    assert found.kind == WAITING and "without a word, starts again" in found.note
    assert found.left == pytest.approx(199.0)
    assert state(tmp_path / "r", NOW - 2.0).kind == RUNNING
    folder = run_folder(tmp_path / "said", "interrupted", 0.2, written=1.0, wall_time=50.0)
    (folder / "checkpoint").mkdir()
    found = state(folder, NOW)
    assert found.kind == WAITING and found.note == "stopped, has a checkpoint" and found.left == pytest.approx(200.0)
    folder = run_folder(tmp_path / "drawn", "running", 0.5, begun=9000.0, written=8000.0)
    (folder / "figures").mkdir()
    os.utime(folder, (NOW, NOW))
    assert state(folder, NOW).kind == WAITING


def test_runs_that_have_just_begun_ended_or_failed(tmp_path):
    found = state(run_folder(tmp_path / "r", "running", begun=5.0), NOW)
    assert found.kind == RUNNING and found.left is None and found.progress == 0.0
    (tmp_path / "r" / RUN_FILE).write_text("{}")
    os.utime(tmp_path / "r" / RUN_FILE, (NOW, NOW))
    assert state(tmp_path / "r", NOW).kind == RUNNING
    assert state(run_folder(tmp_path / "a", "completed", 1.0, wall_time=7.0, ended=True), NOW).seconds == 7.0
    assert state(tmp_path / "a", NOW).kind == DONE
    found = state(run_folder(tmp_path / "b", "failed: energy is not conserved", 0.3, written=1.0), NOW)
    assert found.kind == FAILED and found.note == "failed: energy is not conserved"
    (tmp_path / "a" / RUN_FILE).write_text("{")
    assert state(tmp_path / "a", NOW).kind == FAILED


DAMAGED = ["[]", "{", '{"derived": {"steps": "x", "timeStep": 1}, "wallTime": "x", "outcome": 3}']


@pytest.mark.parametrize("content", DAMAGED)
def test_damaged_folders_have_a_state(tmp_path, content):
    folder = run_folder(tmp_path / "r", "running", 0.5)
    (folder / RUN_FILE).write_text(content)
    assert progress_of(folder, run_of(folder)) == 0.0
    assert state(folder).kind in (RUNNING, WAITING)


def test_progress_is_a_fraction(tmp_path):
    for time, progress in ((np.nan, 0.0), (-1.0, 0.0), (7.0, 1.0)):
        folder = run_folder(tmp_path / str(time), "running", time)
        assert progress_of(folder, run_of(folder)) == progress


def test_the_command_lists_a_folder_of_runs(tmp_path, capsys, monkeypatch):
    monkeypatch.setattr("time.time", lambda: NOW)
    run_folder(tmp_path / "runs" / "a", "completed", 1.0, wall_time=7.0, ended=True)
    run_folder(tmp_path / "runs" / "b", "running", 0.25, begun=110.0, wall_time=400.0)  # in earlier starts
    run_folder(tmp_path / "runs" / "c", "interrupted", 0.5, wall_time=60.0)
    assert main(["status", str(tmp_path / "runs")]) == 0
    *lines, total = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == [DONE, RUNNING, WAITING] and "25.0 %" in lines[1]
    assert total.startswith("3 runs: 1 done, 1 running, 1 waiting, 0 failed; 24:50 left")
    assert "01:00 for the waiting" in total
    assert main(["status", str(tmp_path / "runs"), "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    assert [run["kind"] for run in listed] == [DONE, RUNNING, WAITING]
    # a quarter in 500 s: 1500 s more, of which 10 have passed
    assert (listed[1]["seconds"], listed[1]["left"]) == pytest.approx((510.0, 1490.0))


def test_the_command_fails_for_a_failed_run_and_for_a_folder_without_runs(tmp_path, capsys):
    run_folder(tmp_path / "runs" / "a", "failed: no memory", 0.5)
    assert main(["status", str(tmp_path / "runs")]) == 2
    assert "failed: no memory" in capsys.readouterr().out
    (tmp_path / "empty").mkdir()
    assert main(["status", str(tmp_path / "empty")]) == 2
    assert capsys.readouterr().err.count("\n") == 1
