"""A study as job arrays of Slurm: a task for each row that is left, or for several short ones.

Each job has a folder slurm-N below the study's. It holds rows.table, the rows as they are now: task k of T runs the
k-th of them and each T further on; job.sh, the script that was submitted; job, Slurm's number of it, and T; k.out, what
a task printed. The logs of the runs are where a local runner has them. Slurm starts a task by

    python3 slurm.py ROWS.table NUMBER TASKS      every row of that number, counted from 1, then each TASKS further on

SIGUSR1, which Slurm sends before the time limit, has the run write its checkpoint; if a run has come further in this
task, the task is put into the queue again. Exit status: 0 when all runs have ended, 1 when one has not, 128 and the
signal's number when stopped."""

import os
import re
import shlex
import signal
import subprocess
import sys
from itertools import groupby
from math import ceil

if __name__ == "__main__":
    sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))

from analysis.printable import printable
from analysis.runs.files import write_file
from analysis.runs.lock import states_of_job, this_job
from analysis.runs.status import DONE, FAILED, RUNNING, WAITING
from yade_scripts.parameters import InputError, one_line_errors, tell
from yade_scripts.run import table
from yade_scripts.run.parameters import file_name
from yade_scripts.run.script import StopSignals
from yade_scripts.runner import rows
from yade_scripts.runner.batch import Batch, StudyFolder

ROWS, SCRIPT, JOB = "rows.table", "job.sh", "job"
LARGEST = 1000  # tasks of an array, by Slurm's default MaxArraySize
SHORT, TASK = 60, 600  # s that a row may take to share a task with others, and that these take together, roughly
OVER = "COMPLETED CANCELLED FAILED TIMEOUT NODE_FAIL BOOT_FAIL DEADLINE OUT_OF_MEMORY PREEMPTED".split()
POLL = 0.1  # s
# USR1 comes 60 s before the time limit.
TEXT = """#!/bin/sh
#SBATCH --job-name={name}
#SBATCH --array=1-{tasks}{at_once}
#SBATCH --cpus-per-task={threads}
#SBATCH --signal=B:USR1@60
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={output}
exec {task} "$SLURM_ARRAY_TASK_ID" {tasks}
"""


def arrays(left):
    """[([row, ...], number of tasks), ...] of rows that are left: those that take as many processors each make an
    array of at most LARGEST tasks, short ones (of known time) with others in one task."""
    kind = lambda row: (row.threads, (row.expected_seconds or SHORT) < SHORT)
    found = []
    for (_, short), group in groupby(sorted(left, key=kind), key=kind):
        group = list(group)
        tasks = ceil(sum(row.expected_seconds for row in group) / TASK) if short else len(group)
        number = ceil(tasks / LARGEST)
        found += [(group[k::number], ceil(tasks / number)) for k in range(number)]
    return found


def jobs(study_folder, left, at_once=None):
    """[(folder, rows, number of tasks, text of the script) of each job array]; nothing is written.

    study_folder: batch.StudyFolder; left: rows; at_once: tasks of an array at once, at most (None: as Slurm likes).
    Raises InputError for a study whose name a job can't have."""
    name = os.path.basename(study_folder.path)
    if name != file_name(name):
        raise InputError(f"{name}: a table's name must be of letters, digits and -_.,=+ for Slurm")
    found, first = [], max(_numbers(study_folder), default=0) + 1
    for number, (group, tasks) in enumerate(arrays(left), first):
        folder = study_folder.file(f"slurm-{number}")
        script = TEXT.format(
            name=name,
            tasks=tasks,
            at_once=f"%{at_once}" if at_once else "",
            threads=group[0].threads,
            output=os.path.join(folder, "%a.out"),
            task=shlex.join([sys.executable, os.path.abspath(__file__), os.path.join(folder, ROWS)]),
        )
        found.append((folder, group, tasks, script))
    return found


def command(folder, options):
    """How the job in a folder is submitted; options: of sbatch."""
    return ["sbatch", "--parsable", *options, os.path.join(folder, SCRIPT)]


def submit(folder, group, tasks, script, options=()):
    """Submit one of jobs(); Slurm's number of it. Raises InputError and OSError."""
    os.makedirs(folder)
    own = lambda row: {"description": row.name, "out": row.out}
    cells = [{**own(row), **row.cells, "resume": 1, "!THREADS": row.threads} for row in group]
    table.write(os.path.join(folder, ROWS), cells)
    write_file(os.path.join(folder, SCRIPT), script)
    try:
        done = subprocess.run(command(folder, options), capture_output=True, text=True, stdin=subprocess.DEVNULL)
    except FileNotFoundError:
        raise InputError("sbatch: not found; must be on a machine that submits to Slurm") from None
    job = done.stdout.strip().partition(";")[0]  # a cluster's name may follow
    if done.returncode or not job.isdecimal():
        raise InputError(f'sbatch: {" ".join(done.stderr.split()) or f"exit status {done.returncode}"}')
    write_file(os.path.join(folder, JOB), f"{job} {tasks}\n")
    return job


def queued(study_folder, sure=False):
    """{(name, run folder) of a row: (its task, such as 12_3, and the task's state)} of tasks that wait or run, as
    squeue has them. sure: raise InputError where it has no answer."""
    found = {}
    for number in _numbers(study_folder):
        folder = study_folder.file(f"slurm-{number}")
        try:
            with open(os.path.join(folder, JOB)) as file:
                job, _, tasks = file.read().strip().partition(" ")
            states, why = states_of_job(job) if job.isdecimal() else (None, None)
            if sure and why:
                raise InputError(f"squeue: {why}; must tell whether job {job} is in the queue, so nothing is submitted")
            if not states:
                continue
            names = [(row.description, row.cells["out"]) for row in table.read(os.path.join(folder, ROWS))]
            tasks = int(tasks or len(names))
        except (OSError, ValueError):  # being submitted, or refused by sbatch
            continue
        for number, name in enumerate(names):
            task = f"{job}_{number % tasks + 1}"
            if states.get(task, OVER[0]) not in OVER:
                found[name] = task, states[task]
    return found


def _numbers(study_folder):
    names = os.listdir(study_folder.path) if os.path.isdir(study_folder.path) else []
    return sorted(int(name[6:]) for name in names if re.fullmatch(r"slurm-\d+", name))


# ---- what Slurm runs ----


def main(arguments):
    path, number, tasks = arguments[0], int(arguments[1]), int(arguments[2])
    stop = StopSignals((signal.SIGUSR1, signal.SIGTERM, signal.SIGINT))
    folder = StudyFolder(os.path.dirname(os.path.dirname(path)))
    states = lambda: [rows.state(row, folder.log(row)) for row in own]
    with one_line_errors("slurm.py"):
        own = rows.read(path)[number - 1 :: tasks]
    before = states()
    may_run = [row for row, now in zip(own, before) if now.kind in (WAITING, FAILED) and not now.refused]
    with Batch(folder, may_run, threads=1, nice=0) as batch:  # one after another
        while batch.running() and not stop.received:
            batch.wait(POLL)
    after = states()
    for row, state in zip(own, after):
        where = f" on {state.host}" if state.kind == RUNNING else ""
        tell_or_print = tell if state.kind in (FAILED, RUNNING) else print
        tell_or_print(printable(f"{row.name}: {state.kind}{where} {state.note}".rstrip()))
    came_further = any(now.progress > then.progress for now, then in zip(after, before))
    if stop.received == signal.SIGUSR1 and came_further and any(state.kind == WAITING for state in after):
        # Slurm begins this task anew, which resumes from the checkpoint; scontrol prints itself why not
        subprocess.run(["scontrol", "requeue", this_job()[0]], check=False)
    return 128 + stop.received if stop.received else int(any(state.kind != DONE for state in after))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
