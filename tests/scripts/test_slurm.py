"""Job arrays of Slurm, without Slurm: their scripts, what is submitted, and what a task does. `make test-slurm` has the real one."""

import os
import signal
from types import SimpleNamespace

import pytest
from running import PYTHON, TOP, study

from analysis.runs import running
from yade_scripts.experiments.collision import KIND
from yade_scripts.runner import rows, slurm, slurm_task
from yade_scripts.runner.batch import StudyFolder
from yade_scripts.runner.log import failure

HEADER = "description radius velocity threads out\n"
TABLE = HEADER + "a 5 10 1 runs/a\nb 5 11 2 runs/b\nc 5 12 1 runs/c\nrefused 5 -1 1 runs/d\n"
REFUSED = "study.py: refused: line 5 of three.table: velocity = -1: must be > 0 [m/s]; the other rows are submitted\n"
SCRIPT = f"""#!/bin/sh
#SBATCH --job-name=three
#SBATCH --array=1-2%4
#SBATCH --cpus-per-task=1
#SBATCH --signal=B:USR1@60
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=runs/logs/three/slurm-1/%a.out
exec {PYTHON} {TOP}/yade_scripts/runner/slurm_task.py runs/logs/three/slurm-1/rows.table "$SLURM_ARRAY_TASK_ID"
# sbatch --parsable --time=5 runs/logs/three/slurm-1/job.sh
"""


@pytest.fixture
def commands(program, monkeypatch):
    """sbatch, which writes its arguments to a file and names job 12, then 13; squeue, by which all their tasks wait."""
    program("sbatch", 'echo "$@" >> sbatch; echo $((11 + $(wc -l < sbatch)))')
    program("squeue", 'for task in 1 2; do echo "$4_$task PENDING"; done')
    monkeypatch.setattr(running, "_ANSWERS", {})


@pytest.fixture
def call(tmp_path, monkeypatch, capsys):
    """study.py with arguments, in this process: (exit status, stdout, stderr). It needs no lock here."""
    interrupt = signal.getsignal(signal.SIGINT)
    from yade_scripts import study as study_script

    signal.signal(signal.SIGINT, interrupt)  # a script's own, since the import
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(StudyFolder, "lock", lambda folder: os.makedirs(folder.path, exist_ok=True))

    def called(*arguments):
        try:
            status = study_script.main(list(arguments))
        except SystemExit as end:
            status = end.code
        return status, *capsys.readouterr()

    return called


def write_table(folder, text=TABLE, name="three.table"):
    (folder / name).write_text(text)


def test_the_script_of_an_array(tmp_path):
    """One for each number of threads."""
    write_table(tmp_path)
    done = study(tmp_path, "three.table", "--slurm", "--dry-run", "-j", "4", "--", "--time=5")
    assert (done.returncode, done.stderr) == (1, REFUSED)
    second = SCRIPT.replace("1-2%4", "1-1%4").replace("task=1", "task=2").replace("slurm-1", "slurm-2")
    assert done.stdout == SCRIPT + "\n" + second
    assert os.listdir(tmp_path) == ["three.table"]


def test_what_waits_in_the_queue_is_shown_and_not_submitted_again(tmp_path, commands, call):
    write_table(tmp_path)
    log = tmp_path / "runs" / "logs" / "three" / "a.log"  # of an earlier failure
    log.parent.mkdir(parents=True)
    log.write_text("collide.py: no\nJOB SUMMARY\nstatus  : 256 (FAILED)\n")
    status, output, errors = call("three.table", "--slurm", "--", "--time=5", "--partition=long")
    assert (status, errors) == (1, REFUSED)
    assert output.splitlines() == [
        "Slurm job 12: 2 tasks, 1 threads each",
        "Slurm job 13: 1 tasks, 2 threads each",
        "three: 4 rows, 0 done, 0 running, 1 failed, 0 in the queue before, 3 submitted",
    ]
    assert not log.exists()
    script = "runs/logs/three/slurm-{}/job.sh"
    options = "--parsable --time=5 --partition=long"
    assert (tmp_path / "sbatch").read_text().splitlines() == [f"{options} {script.format(n)}" for n in (1, 2)]
    assert "--array=1-2\n" in (tmp_path / script.format(1)).read_text()
    found = rows.read(tmp_path / "runs" / "logs" / "three" / "slurm-1" / "rows.table")
    assert [(row.name, row.out) for row in found] == [("a", "runs/a"), ("c", "runs/c")]
    status = call("three.table", "--status")[1].splitlines()
    notes = {"a": "12_1", "b": "13_1", "c": "12_2"}
    assert [line.split()[:2] for line in status[:3]] == [["waiting", name] for name in notes]
    assert all(line.endswith(f"Slurm job {task} pending") for line, task in zip(status, notes.values()))
    write_table(tmp_path, TABLE + "more 5 13 1 runs/more\n")
    again = call("three.table", "--slurm")[1].splitlines()
    assert again[-1].endswith("1 failed, 3 in the queue before, 1 submitted")


def test_arrays_are_no_larger_than_slurm_takes_them():
    """A thousand tasks, and rows of one number of threads each."""
    made = {number: rows.StudyRow("", {}, "", KIND, KIND.parse({"threads": str(number)})) for number in (1, 2)}
    found = slurm.arrays([made[1 + number % 2] for number in range(2446)])
    assert [(group[0].threads, len(group)) for group in found] == [(1, 1000), (1, 223), (2, 1000), (2, 223)]
    assert all(len({row.threads for row in group}) == 1 for group in found)


ONE = HEADER + "a 5 10 1 a\n"
NOT_SUBMITTED = {
    "a.table --dry-run": "--dry-run: must be given with --slurm",
    "a.table -- --time=5": "--time=5: must be given with --slurm",
    "a.table --slurm": "sbatch: Batch job submission failed: no such partition",
    "a+(b).table --slurm": "a+(b): a table's name must be of letters, digits and -_.,=+",
}


@pytest.mark.parametrize("arguments", NOT_SUBMITTED)
def test_what_cannot_be_submitted_is_one_line(tmp_path, program, call, arguments):
    program("sbatch", "echo Batch job submission failed: no such partition >&2; exit 1")
    write_table(tmp_path, ONE, arguments.split()[0])
    status, _, errors = call(*arguments.split())
    assert status == 2 and NOT_SUBMITTED[arguments] in errors.splitlines()[-1]


def test_without_slurm_it_is_one_line(tmp_path, monkeypatch, call):
    write_table(tmp_path, ONE)
    monkeypatch.setenv("PATH", str(tmp_path))
    status, _, errors = call("three.table", "--slurm")
    assert (status, errors) == (2, "study.py: sbatch: not found; must be on a machine that submits to Slurm\n")


STOPS = 'trap "echo TERM; exit 143" TERM; while :; do sleep 0.02; done'
DEAF = 'trap "echo TERM; trap - TERM" TERM; for i in $(seq 40); do sleep 0.02; done; exit 143'  # as a run is after the first


@pytest.fixture
def task(tmp_path, program):
    """begin(script of what yade does) -> Run, and its log."""
    handlers = {number: signal.getsignal(number) for number in (signal.SIGUSR1, signal.SIGTERM, signal.SIGINT)}
    row = rows.StudyRow("a", {}, "/collide.py", KIND, KIND.parse({"threads": "2"}))
    log = tmp_path / "a.log"

    def begin(script):
        program("yade", f'echo "$YADE_BATCH" "$@"; {script}')
        return slurm_task.Run(row, "rows.table:2", str(log)), log

    yield begin
    for number, handler in handlers.items():
        signal.signal(number, handler)


def after_begin(log):
    while "rows.table" not in log.read_text():
        pass


def test_a_task_runs_its_row_as_yade_batch_would(task):
    run, log = task("echo collide.py: no; exit 1")
    assert run.wait() == 1 and not run.limit_is_near
    command, *told = log.read_text().splitlines()
    assert command == "rows.table:2 -n --threads=2 -x /collide.py"
    assert told == ["collide.py: no", "", "JOB SUMMARY", "status  : 256 (FAILED)"]
    assert failure(log, "run") == "collide.py: no"
    log.unlink()
    run, log = task("kill -9 $$")
    assert run.wait() == 137 and failure(log, "run") == "killed by signal 9"


@pytest.mark.parametrize("number, near", [(signal.SIGUSR1, True), (signal.SIGTERM, False)], ids=["limit", "SIGTERM"])
def test_a_signal_to_the_task_alone_is_passed_on_once(task, monkeypatch, number, near):
    monkeypatch.setattr(slurm_task, "ALL_SIGNALLED", 0.2)
    for script in (STOPS, DEAF):
        run, log = task(script)
        after_begin(log)
        os.kill(os.getpid(), number)
        assert run.wait() == 143 and run.limit_is_near == near
        assert log.read_text().splitlines()[1:] == ["TERM"]  # once, and no summary: it has not failed
        log.unlink()


def test_a_signal_to_all_of_the_job_is_not_passed_on(task, monkeypatch):
    """Passed on, it would end the run, which has handled one, without its checkpoint."""
    monkeypatch.setattr(slurm_task, "ALL_SIGNALLED", 0.2)
    run, log = task(DEAF)
    after_begin(log)
    os.kill(run.process.pid, signal.SIGTERM)
    os.kill(os.getpid(), signal.SIGTERM)
    assert run.wait() == 143
    assert log.read_text().splitlines()[1:] == ["TERM"]


@pytest.mark.parametrize("progress, requeued", [(0.5, True), (0.1, False)], ids=["further", "no further"])
def test_a_task_at_its_limit_is_put_into_the_queue_again_if_it_came_further(
    tmp_path, program, monkeypatch, progress, requeued
):
    """Otherwise it would begin anew for ever."""
    (tmp_path / "logs" / "slurm-1").mkdir(parents=True)
    write_table(tmp_path, ONE, "logs/slurm-1/rows.table")
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("SLURM_ARRAY_JOB_ID", "12")
    monkeypatch.setenv("SLURM_ARRAY_TASK_ID", "3")
    program("scontrol", 'echo "$@" > scontrol')
    states = iter([rows.State(rows.WAITING, 0.1), rows.State(rows.WAITING, progress, note="checkpoint")])
    monkeypatch.setattr(rows, "state", lambda *_, **__: next(states))
    stopped = SimpleNamespace(limit_is_near=True, wait=lambda: 143)
    monkeypatch.setattr(slurm_task, "Run", lambda *_: stopped)
    assert slurm_task.main(["logs/slurm-1/rows.table", "1"]) == 143
    asked = tmp_path / "scontrol"
    assert asked.read_text() == "requeue 12_3\n" if requeued else not asked.exists()


def test_a_row_that_ended_or_runs_elsewhere_is_not_run(tmp_path, capsys, monkeypatch):
    write_table(tmp_path, ONE, "rows.table")
    monkeypatch.setattr(slurm_task, "Run", None)
    for state, status, text in (
        (rows.State(rows.DONE, 1.0), 0, "a: has ended before\n"),
        (rows.State(rows.RUNNING, host="node7", note="on node7"), 1, "slurm_task.py: a: is running on node7\n"),
        (rows.State(rows.FAILED, note="holds another"), 1, "slurm_task.py: a: holds another\n"),
    ):
        monkeypatch.setattr(rows, "state", lambda *_, state=state, **__: state)
        assert slurm_task.main([str(tmp_path / "rows.table"), "1"]) == status
        said = capsys.readouterr()
        assert said.out + said.err == text
