"""What has become of runs, from their folders alone."""

import json
import os

import numpy as np
import pytest

from analysis.__main__ import main
from analysis.runs import lock
from analysis.runs.format import ENDED_FILE, HISTORY_FILE, RUN_FILE, STATES_FOLDER
from analysis.runs.status import DONE, FAILED, RUNNING, WAITING, state

NOW = 1_700_000_000.0


@pytest.fixture(autouse=True)
def now(monkeypatch):
    monkeypatch.setattr("time.time", lambda: NOW)


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
    os.utime(path / RUN_FILE, (NOW - begun, NOW - begun))
    return path


def test_what_ended_failed_or_was_stopped(tmp_path):
    found = state(run_folder(tmp_path / "ended", "completed", 1.0, wall_time=7.0, ended=True))
    assert found.kind == DONE and found.seconds == 7.0
    found = state(run_folder(tmp_path / "failed", "failed: energy is not conserved", 0.3))
    assert found.kind == FAILED and found.note == "failed: energy is not conserved"
    found = state(run_folder(tmp_path / "killed", "running", 0.5, begun=400.0, written=201.0))
    assert found.kind == WAITING and "without a word, starts again" in found.note
    assert found.left == pytest.approx(199.0)
    folder = run_folder(tmp_path / "stopped", "interrupted", 0.2, wall_time=50.0)
    (folder / "checkpoint").mkdir()
    found = state(folder)
    assert found.kind == WAITING and found.note == "stopped, has a checkpoint" and found.left == pytest.approx(200.0)


def test_the_command_lists_a_folder_of_runs(tmp_path, capsys):
    run_folder(tmp_path / "runs" / "a", "completed", 1.0, wall_time=7.0, ended=True)
    running = run_folder(tmp_path / "runs" / "b", "running", 0.25, begun=110.0, wall_time=400.0)  # in earlier starts
    run_folder(tmp_path / "runs" / "c", "interrupted", 0.5, wall_time=60.0)
    handle = lock.take(running)
    assert main(["status", str(tmp_path / "runs")]) == 0
    *lines, total = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == [DONE, RUNNING, WAITING] and "25.0 %" in lines[1]
    assert total.startswith("3 runs: 1 done, 1 running, 1 waiting, 0 failed; 24:50 left")
    assert "01:00 for the waiting" in total
    assert main(["status", str(tmp_path / "runs"), "--json"]) == 0
    listed = json.loads(capsys.readouterr().out)
    # a quarter in 500 s: 1500 s more, of which 10 have passed
    assert (listed[1]["seconds"], listed[1]["left"]) == pytest.approx((510.0, 1490.0))
    lock.release(running, handle)
    run_folder(tmp_path / "runs" / "d", "failed: no memory", 0.5)
    assert main(["status", str(tmp_path / "runs")]) == 2 and "failed: no memory" in capsys.readouterr().out
