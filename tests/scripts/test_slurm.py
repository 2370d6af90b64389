"""Job arrays of Slurm, without Slurm: their scripts, what is submitted, and what a task does. `make test-slurm` has
the real one."""

import os
import signal
from math import ceil

from running import PYTHON, TOP, read_json, start, study, wait_for

from yade_scripts.experiments.collision import KIND
from yade_scripts.runner import rows, slurm

HEADER = "description radius velocity threads out\n"
TABLE = HEADER + "a 5 10 1 runs/a\nb 5 11 2 runs/b\nc 5 12 1 runs/c\nrefused 5 -1 1 runs/d\n"
REFUSED = "study.py: refused: line 5 of three.table: velocity = -1: must be > 0 [m/s]; the other rows are submitted\n"
SCRIPT = f"""#!/bin/sh
#SBATCH --job-name=three
#SBATCH --array=1-1%4
#SBATCH --cpus-per-task=1
#SBATCH --signal=B:USR1@60
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output=runs/logs/three/slurm-1/%a.out
exec {PYTHON} {TOP}/yade_scripts/runner/slurm.py runs/logs/three/slurm-1/rows.table "$SLURM_ARRAY_TASK_ID" 1
# sbatch --parsable --time=5 runs/logs/three/slurm-1/job.sh
"""


def write_table(folder, text=TABLE, name="three.table"):
    (folder / name).write_text(text)


def test_the_script_of_an_array(tmp_path):
    """One for each number of threads."""
    write_table(tmp_path)
    done = study(tmp_path, "three.table", "--slurm", "--dry-run", "-j", "4", "--", "--time=5")
    assert (done.returncode, done.stderr) == (1, REFUSED)
    second = SCRIPT.replace("task=1", "task=2").replace("slurm-1", "slurm-2")
    assert done.stdout == SCRIPT + "\n" + second
    assert os.listdir(tmp_path) == ["three.table"]


def test_what_waits_in_the_queue_is_shown_and_not_submitted_again(tmp_path, program):
    """sbatch writes its arguments to a file and names job 12, then 13; squeue says that all their tasks wait."""
    program("sbatch", 'echo "$@" >> sbatch; echo $((11 + $(wc -l < sbatch)))')
    program("squeue", 'for task in 1 2; do echo "$4_$task PENDING"; done')
    write_table(tmp_path)
    done = study(tmp_path, "three.table", "--slurm", "--", "--time=5", "--partition=long")
    assert (done.returncode, done.stderr) == (1, REFUSED)
    assert done.stdout.splitlines() == [
        "Slurm job 12: 2 rows in 1 tasks, 1 threads each",
        "Slurm job 13: 1 rows in 1 tasks, 2 threads each",
        "three: 4 rows, 0 done, 0 running, 1 failed, 0 in the queue before, 3 submitted",
    ]
    script = "runs/logs/three/slurm-{}/job.sh"
    options = "--parsable --time=5 --partition=long"
    assert (tmp_path / "sbatch").read_text().splitlines() == [f"{options} {script.format(n)}" for n in (1, 2)]
    assert "--array=1-1\n" in (tmp_path / script.format(1)).read_text()
    found = rows.read(tmp_path / "runs" / "logs" / "three" / "slurm-1" / "rows.table")
    assert [(row.name, row.out) for row in found] == [("a", "runs/a"), ("c", "runs/c")]
    status = study(tmp_path, "three.table", "--status").stdout.splitlines()
    notes = {"a": "12_1", "b": "13_1", "c": "12_1"}
    assert [line.split()[:2] for line in status[:3]] == [["waiting", name] for name in notes]
    assert all(line.endswith(f"Slurm job {task} pending") for line, task in zip(status, notes.values()))
    write_table(tmp_path, TABLE + "more 5 13 1 runs/more\n")
    again = study(tmp_path, "three.table", "--slurm").stdout.splitlines()
    assert again[-1].endswith("1 failed, 3 in the queue before, 1 submitted")


def test_arrays_are_no_larger_than_slurm_takes_them_and_short_rows_share_tasks():
    """A thousand tasks, and rows of one number of threads each; each row is in one of them."""
    row = lambda threads, radius: rows.StudyRow("", {}, "", KIND, KIND.parse(dict(threads=threads, radius=radius)))
    short, long, of_two = row(1, 10), row(1, 80), row(2, 80)
    seconds = short.expected_seconds
    assert seconds < slurm.SHORT < of_two.expected_seconds
    found = slurm.arrays([short, long, of_two] * 1223 + [short] * 8777)
    assert [(group[0], len(group), tasks) for group, tasks in found] == [
        (long, 612, 612), (long, 611, 612),
        (short, 10_000, ceil(10_000 * seconds / slurm.TASK)),
        (of_two, 612, 612), (of_two, 611, 612),
    ]  # fmt: skip


def test_a_task_at_its_limit_writes_a_checkpoint_and_is_put_into_the_queue_again(tmp_path, program, monkeypatch):
    task = "logs/slurm-1/rows.table"
    (tmp_path / "logs" / "slurm-1").mkdir(parents=True)
    monkeypatch.setenv("SLURM_ARRAY_JOB_ID", "12")
    monkeypatch.setenv("SLURM_ARRAY_TASK_ID", "3")
    program("scontrol", 'echo "$@" > scontrol')
    header = "description radius velocity duration checkpointInterval threads out\n"
    write_table(tmp_path, header + "ends 4 30 1e-9 1 1 ends\nlong 10 10 5e-6 0.1 2 long\n", task)
    process = start(tmp_path, PYTHON, slurm.__file__, task, "1", "1")
    wait_for((tmp_path / "long" / "checkpoint" / "recorder.npz").exists)
    process.send_signal(signal.SIGUSR1)
    output, errors = process.communicate(timeout=60)
    assert process.returncode == 128 + signal.SIGUSR1 and errors == ""
    ends, long = output.splitlines()
    assert ends == "ends: done" and long.startswith("long: waiting checkpoint at ")
    assert (tmp_path / "scontrol").read_text() == "requeue 12_3\n"
    assert read_json(tmp_path, "long", "run.json")["status"] == "interrupted"
