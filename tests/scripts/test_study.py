"""study.py: a table is run to its end however often it is stopped, and a row that fails is not overlooked."""

import os
import signal

import pytest
from running import PYTHON, STUDY, collide, process_writing, read_json, same_bits, start, study, wait_for

UNDECIDED = "undecided (study.py TABLE --longer SECONDS goes on with them)"  # 10 ns are too short for an outcome
HEADER = "description radius velocity unusual duration stepFraction checkpointInterval out\n"
ROWS = {
    "ends": "ends    5  10   * 10e-9   *   *   runs/tiny/ends\n",
    "killed": "killed  10 10   * 500e-9  *   0.1 runs/tiny/killed\n",
    "fails": "fails   5  3000 1 10e-9   0.4 *   runs/tiny/fails\n",  # a step too long for such an impact
    "refused": "refused 5  -1   * =       =   *   runs/tiny/refused\n",
}


def killed_run(folder, *arguments):
    """(study.py at work on tiny.table, its run `killed`, which has a checkpoint)."""
    process, run = start(folder, PYTHON, STUDY, "tiny.table", *arguments), folder / "runs" / "tiny" / "killed"
    wait_for((run / "checkpoint" / "recorder.npz").exists)
    return process, run


def write_table(folder, name, *rows):
    (folder / name).write_text(HEADER + "".join(ROWS[row] for row in rows))


@pytest.fixture(scope="module")
def first_call(tmp_path_factory):
    """(folder, the finished study, --status midway): one row ends, one is killed, one fails, one is refused."""
    folder = tmp_path_factory.mktemp("study")
    write_table(folder, "tiny.table", *ROWS)
    process, run = killed_run(folder, "-j", "2")
    os.kill(process_writing(run), signal.SIGSTOP)  # so that it is still running when asked
    midway = study(folder, "tiny.table", "--status")
    os.kill(process_writing(run), signal.SIGKILL)
    output, errors = process.communicate(timeout=60)
    return folder, (process.returncode, output, errors), midway


def test_failures_fail_the_study_after_all_others_have_run_and_status_tells_it_meanwhile(first_call):
    folder, (status, output, errors), midway = first_call
    assert status == 1 and output.splitlines()[-1] == f"tiny: 4 rows, 1 done, 3 failed; 1 {UNDECIDED}"
    first = output.splitlines()[0]  # the estimate
    assert first.startswith("tiny: 4 rows, 1 failed, 3 to run; estimated time ")
    assert "with 2 at once, at 80 million contact updates" in first
    refused, killed, fails = errors.splitlines()
    assert killed.startswith("study.py: killed: killed by signal 9 (checkpoint at ")
    assert fails.startswith("study.py: fails: runs/tiny/fails: failed: JKRWadaEngine: the run broke down at t = ")
    assert refused.startswith("study.py: refused: line 5 of tiny.table: velocity = -1: must be > 0 [m/s]; the other")
    assert sorted(os.listdir(folder / "runs" / "tiny")) == ["ends", "fails", "killed"]
    assert midway.returncode == 0 and midway.stderr == ""
    states = [line.split()[:2] for line in midway.stdout.splitlines()]
    assert ["running", "killed"] in states and ["failed", "refused"] in states
    assert midway.stdout.splitlines()[-1].startswith("tiny: ")


def test_the_next_call_takes_up_the_killed_row_and_skips_what_has_ended(first_call, tmp_path):
    folder, _, _ = first_call
    ended = os.stat(folder / "runs" / "tiny" / "ends" / "ended").st_mtime_ns
    write_table(folder, "tiny.table", "ends", "killed")
    done = study(folder, "tiny.table")
    assert done.returncode == 0 and done.stderr == "", done.stderr
    assert "2 rows, 1 done, 1 to run, 1 of them from checkpoints; estimated time" in done.stdout
    assert done.stdout.splitlines()[-1] == f"tiny: 2 rows, 2 done, 0 failed; 1 {UNDECIDED}"
    assert os.stat(folder / "runs" / "tiny" / "ends" / "ended").st_mtime_ns == ended
    assert collide(folder, "radius=10", "velocity=10", "duration=500e-9", "out=straight").returncode == 0
    assert same_bits(folder / "runs" / "tiny" / "killed", folder / "straight")
    elsewhere = study(tmp_path, folder / "tiny.table", "--status")
    assert elsewhere.stdout == study(folder, "tiny.table", "--status").stdout and "2 done" in elsewhere.stdout


def test_a_stopped_study_leaves_checkpoints_and_no_processes(tmp_path):
    write_table(tmp_path, "tiny.table", "killed", "ends")
    table = tmp_path / "tiny.table"
    table.write_text(table.read_text().replace("500e-9", "5000e-9"))  # it must not end before it is stopped
    process, run = killed_run(tmp_path, "-j", "1")
    busy = study(tmp_path, "tiny.table")
    assert busy.returncode == 2 and "this study is being run by another process" in busy.stderr
    process.send_signal(signal.SIGTERM)
    output, errors = process.communicate(timeout=60)
    assert process.returncode == 143
    assert errors == "stopping; the runs write their checkpoints\n"
    assert output.splitlines()[-1] == "tiny: 2 rows, 0 done, 0 failed, 2 left"
    assert process_writing(run) is None
    assert read_json(run, "run.json")["status"] == "interrupted"
    assert not (tmp_path / "runs" / "tiny" / "ends").exists()
    lines = study(tmp_path, "tiny.table", "--status").stdout.splitlines()
    assert lines[0].split()[:2] == ["waiting", "killed"] and "checkpoint at " in lines[0]
