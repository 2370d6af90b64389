"""Rows that share a worker: each as if YADE had been started for it, whatever becomes of the others."""

import os
import signal

import pytest
from running import COLLIDE, PYTHON, STUDY, call, process_writing, same_bits, start, wait_for

from yade_scripts.experiments.collision import KIND
from yade_scripts.runner import rows
from yade_scripts.runner.batch import Batch, StudyFolder
from yade_scripts.runner.rows import failure

RUNS = {
    "bcca": "packing=bcca grains=32 velocity=10 duration=60e-9",
    "refused": "radius=5 stepFraction=0.4 viscoelasticTime=3e-11",  # by the run, which knows the contact
    "fails": "radius=5 velocity=3000 unusual=1 duration=10e-9 stepFraction=0.4",
    "functors": "radius=4 velocity=30 duration=15e-9 engine=functors",
    "two": "radius=5 velocity=30 duration=15e-9 threads=2",
    "killed": "radius=10 velocity=10 duration=500e-9 checkpointInterval=0.1",
    "again": "packing=bcca grains=32 velocity=10 duration=60e-9",
}


def write_table(folder, names=tuple(RUNS)):
    cells = {name: dict(word.split("=") for word in RUNS[name].split()) for name in names}
    columns = list(dict.fromkeys(column for row in cells.values() for column in row))
    lines = [" ".join(["description", "out", *columns])]
    lines += [" ".join([name, name, *(row.get(column, "*") for column in columns)]) for name, row in cells.items()]
    (folder / "rows.table").write_text("\n".join(lines) + "\n")


def log(folder, name):
    return folder / "runs" / "logs" / "rows" / f"{name}.log"


@pytest.fixture(scope="module")
def one_worker(tmp_path_factory):
    """(folder, what study.py printed) of all runs one after another, of which the worker of `killed` is killed."""
    folder = tmp_path_factory.mktemp("rows")
    write_table(folder)
    process = start(folder, PYTHON, STUDY, "rows.table", "-j", "1")
    wait_for((folder / "killed" / "checkpoint" / "recorder.npz").exists)
    run = process_writing(folder / "killed")
    with open(f"/proc/{run}/stat") as about:
        os.kill(int(about.read().rpartition(")")[2].split()[1]), signal.SIGKILL)
    output, errors = process.communicate(timeout=120)
    return folder, process.returncode, output, errors


def test_a_worker_that_is_killed_loses_its_row_alone_and_says_which(one_worker):
    folder, status, output, errors = one_worker
    assert status == 1 and output.splitlines()[-1].startswith("rows: 7 rows, 4 done, 3 failed; 4 undecided (")
    refused, fails, killed = errors.splitlines()
    assert killed.startswith("study.py: killed: killed by signal 9 (checkpoint at ")
    assert refused.startswith("study.py: refused: refused: stepFraction = 0.4: ") and "broke down" in fails
    begun = [name for name in RUNS if "Welcome to Yade" in log(folder, name).read_text()]
    assert begun == ["bcca", "again"]  # two workers
    assert same_bits(folder / "bcca", folder / "again")


@pytest.mark.parametrize("name", [name for name in RUNS if name not in ("killed", "refused", "again")])
def test_a_row_has_the_bits_of_a_process_of_its_own(one_worker, tmp_path, name):
    folder, *_ = one_worker
    call(tmp_path, "yade", "-n", "-x", COLLIDE, *RUNS[name].split(), "out=run")
    assert same_bits(folder / name, tmp_path / "run")


@pytest.fixture
def run_all(tmp_path):
    """run_all([(threads, script), ...], at once): has a Batch run these; its StudyFolder."""
    folder = StudyFolder(str(tmp_path))

    def run_all(scripts, at_once):
        made = []
        for number, (threads, text) in enumerate(scripts):
            script = tmp_path / f"{number}.py"
            script.write_text(text)
            given = KIND.parse({"threads": threads, "out": f"run{number}"})
            made.append(rows.StudyRow(str(number), {}, str(script), KIND, given))
        with Batch(folder, made, at_once) as batch:
            while batch.running():
                batch.wait(1)
        return [failure(folder.log(row), row.out) for row in made]

    return run_all


def test_rows_run_side_by_side_as_far_as_their_threads_allow(tmp_path, run_all):
    """One that takes more than there are runs alone."""
    text = """
import time
tell, until = (lambda word: print(word, {threads}, file=open("{told}", "a"))), time.monotonic() + 60
tell("begin")
while {threads} == 1 and open("{told}").read().count("begin 1") < 2 and time.monotonic() < until:
    time.sleep(0.05)
tell("end")
"""
    run_all([(threads, text.format(threads=threads, told=tmp_path / "told")) for threads in (3, 1, 1, 2)], 2)
    told = (tmp_path / "told").read_text().splitlines()
    assert told == ["begin 3", "end 3", "begin 1", "begin 1", "end 1", "end 1", "begin 2", "end 2"]


def test_what_a_row_does_to_its_process_does_not_reach_the_next(run_all):
    """Signals, streams, modules, the scene, the working folder, the memory, the end."""
    spoils = """
import os, signal, sys, numpy
signal.signal(signal.SIGTERM, signal.SIG_IGN)
os.chdir("/")
O.bodies.append(utils.sphere((0, 0, 0), 1)); O.step(); O.engines = []
numpy.mean = sys.argv = None
kept = numpy.ones(30_000_000)
os.environ["SPOILT"] = "1"
os.kill(os.getpid(), signal.SIGSEGV)
"""
    sees = """
import os, signal, sys, numpy
fine = signal.getsignal(signal.SIGTERM) == signal.SIG_DFL and os.getcwd() != "/" and not len(O.bodies) and O.iter == 0
fine = fine and len(O.engines) and numpy.mean and "SPOILT" not in os.environ and "kept" not in globals()
fine = fine and int(open("/proc/self/statm").read().split()[1]) * 4096 < 350e6
print("run folder: x (completed, 1.0 s)")
sys.exit(not fine)
"""
    assert run_all([(1, spoils), (1, sees), (2, spoils), (1, sees)], 1) == ["killed by signal 11", None] * 2
