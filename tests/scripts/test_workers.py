"""Rows that share a worker: each as if YADE had been started for it, whatever becomes of the others."""

import os
import signal

import pytest
from running import COLLIDE, PYTHON, STUDY, call, process_writing, same_bits, start, wait_for

from yade_scripts.experiments.collision import KIND
from yade_scripts.run import table
from yade_scripts.runner import rows
from yade_scripts.runner.batch import Batch, StudyFolder

RUNS = {
    "bcca": "packing=bcca grains=32 velocity=10 duration=60e-9",
    "functors": "radius=4 velocity=30 duration=15e-9 engine=functors",
    "two": "radius=5 velocity=30 duration=15e-9 threads=2",
    "killed": "radius=10 velocity=10 duration=500e-9 checkpointInterval=0.1",
    "again": "packing=bcca grains=32 velocity=10 duration=60e-9",
}


@pytest.fixture(scope="module")
def one_worker(tmp_path_factory):
    """(folder, what study.py printed) of all runs one after another, of which the worker of `killed` is killed."""
    folder = tmp_path_factory.mktemp("rows")
    own = {name: dict(word.split("=") for word in cells.split()) for name, cells in RUNS.items()}
    table.write(folder / "rows.table", [{"description": name, "out": name, **own[name]} for name in RUNS])
    process = start(folder, PYTHON, STUDY, "rows.table", "-j", "1")
    wait_for((folder / "killed" / "checkpoint" / "recorder.npz").exists)
    run = process_writing(folder / "killed")
    with open(f"/proc/{run}/stat") as about:
        os.kill(int(about.read().rpartition(")")[2].split()[1]), signal.SIGKILL)
    output, errors = process.communicate(timeout=120)
    return folder, process.returncode, output, errors


def test_a_worker_that_is_killed_loses_its_row_alone_and_says_which(one_worker):
    folder, status, output, errors = one_worker
    assert status == 1 and output.splitlines()[-1].startswith("rows: 5 rows, 4 done, 1 failed; 4 undecided (")
    assert errors.startswith("study.py: killed: killed by signal 9 (checkpoint at ") and errors.count("\n") == 1
    logs = {name: (folder / f"runs/logs/rows/{name}.log").read_text() for name in RUNS}
    begun = [name for name in RUNS if "Welcome to Yade" in logs[name]]
    assert begun == ["bcca", "again"]  # two workers
    assert same_bits(folder / "bcca", folder / "again")


@pytest.mark.parametrize("name", ["functors", "two"])
def test_a_row_has_the_bits_of_a_process_of_its_own(one_worker, tmp_path, name):
    folder, *_ = one_worker
    call(tmp_path, "yade", "-n", "-x", COLLIDE, *RUNS[name].split(), "out=run")
    assert same_bits(folder / name, tmp_path / "run")


def test_rows_run_side_by_side_as_far_as_their_threads_allow(tmp_path):
    """One that takes more than there are runs alone."""
    text = """
import time
tell, until = (lambda word: print(word, {threads}, file=open("{told}", "a"))), time.monotonic() + 60
tell("begin")
while {threads} == 1 and open("{told}").read().count("begin 1") < 2 and time.monotonic() < until:
    time.sleep(0.05)
tell("end")
"""
    made = []
    for number, threads in enumerate((3, 1, 1, 2)):
        script = tmp_path / f"{number}.py"
        script.write_text(text.format(threads=threads, told=tmp_path / "told"))
        given = KIND.parse({"threads": threads, "out": f"run{number}"})
        made.append(rows.StudyRow(str(number), {}, str(script), KIND, given))
    with Batch(StudyFolder(str(tmp_path)), made, 2) as batch:
        while batch.running():
            batch.wait(1)
    told = (tmp_path / "told").read_text().splitlines()
    assert told == ["begin 3", "end 3", "begin 1", "begin 1", "end 1", "end 1", "begin 2", "end 2"]
