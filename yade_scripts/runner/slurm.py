"""A study as job arrays of Slurm: a task for each row that is left, or for several short ones.

Each call of submit() makes folders slurm-N below the study's: rows.table with the rows as they are now, of which task k of T has the
k-th and each T further on; job.sh, the script that was submitted; job, Slurm's number of it, and T; k.out, what a task printed. The logs
of the runs are where a local runner has them.
"""

import os
import re
import shlex
import subprocess
import sys
from itertools import groupby
from math import ceil

from analysis.printable import shell_line
from analysis.runs.files import RunFolderError, remove_unfinished, write_file
from analysis.runs.running import states_of_job, why_unknown
from yade_scripts.run.file_name import file_name
from yade_scripts.run.table import read
from yade_scripts.runner.cost import typical_seconds
from yade_scripts.runner.rows import write

TASK_SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "slurm_task.py")
ROWS, SCRIPT, JOB = "rows.table", "job.sh", "job"
BEFORE_THE_LIMIT = 60  # s
LARGEST = 1000  # tasks of an array, by Slurm's default MaxArraySize
SHORT, TASK = 60, 600  # s that a row may take to share a task with others, and that these take together, roughly
OVER = (
    "COMPLETED",
    "CANCELLED",
    "FAILED",
    "TIMEOUT",
    "NODE_FAIL",
    "BOOT_FAIL",
    "DEADLINE",
    "OUT_OF_MEMORY",
    "PREEMPTED",
)
_FOLDER = re.compile(r"slurm-(\d+)")


class SlurmError(Exception):
    """What Slurm refused, or what a job can't be made of; the message is one line."""


def arrays(rows):
    """[([row, ...], number of tasks), ...]: rows that take as many processors each make an array of at most LARGEST tasks."""
    found = []
    for (_, short), group in groupby(sorted(rows, key=_uniform), key=_uniform):
        group = list(group)
        tasks = ceil(sum(map(typical_seconds, group)) / TASK) if short else len(group)
        number = ceil(tasks / LARGEST)
        found += [(group[k::number], ceil(tasks / number)) for k in range(number)]
    return found


def _uniform(row):
    return row.threads, typical_seconds(row) < SHORT


def job_script(study_folder, folder, rows, tasks, at_once=None):
    """Text of the script of an array of so many tasks, of rows that take as many processors each.

    study_folder: batch.StudyFolder; folder: path of the slurm-N; at_once: tasks of it at once at most (None: as Slurm likes).
    """
    name = os.path.basename(study_folder.path)
    task = shlex.join([sys.executable, TASK_SCRIPT, os.path.join(folder, ROWS)])
    return f"""#!/bin/sh
#SBATCH --job-name={name}
#SBATCH --array=1-{tasks}{f"%{at_once}" if at_once else ""}
#SBATCH --cpus-per-task={rows[0].threads}
#SBATCH --signal=B:USR1@{BEFORE_THE_LIMIT}
#SBATCH --requeue
#SBATCH --open-mode=append
#SBATCH --output={os.path.join(folder, "%a.out")}
exec {task} "$SLURM_ARRAY_TASK_ID" {tasks}
"""


def require_usable(study_folder):
    """Raise SlurmError for a name that a job can't have."""
    name = os.path.basename(study_folder.path)
    if name != file_name(name):
        raise SlurmError(f"{name}: a table's name must be of letters, digits and -_.,=+ for Slurm")


def submit(study_folder, rows, at_once=None, options=()):
    """Submit rows; yields (Slurm's number of a job, its rows, how many tasks they are). options: of sbatch. Raises SlurmError and OSError."""
    for number in _numbers(study_folder):  # of calls that were killed
        remove_unfinished(study_folder.file(f"slurm-{number}"))
    for group, tasks in arrays(rows):
        study_folder.remove_logs(group)
        yield _submit(study_folder, group, tasks, at_once, options), group, tasks


def queued(study_folder, sure=False):
    """{(name, run folder) of a row: (its task, such as 12_3, and the task's state)} of tasks that wait or run, as squeue has them. sure: raise
    SlurmError where it has no answer."""
    found = {}
    for number in _numbers(study_folder):
        folder = study_folder.file(f"slurm-{number}")
        try:
            with open(os.path.join(folder, JOB)) as file:
                job, _, tasks = file.read().strip().partition(" ")
            states = states_of_job(job) if job.isdecimal() else None
            if sure and states is None and job.isdecimal() and (why := why_unknown(job)):
                raise SlurmError(f"squeue: {why}; must tell whether job {job} is in the queue, so nothing is submitted")
            names = [(row.description, row.cells["out"]) for row in read(os.path.join(folder, ROWS))] if states else []
            tasks = int(tasks or len(names))
        except (OSError, ValueError, RunFolderError):  # being submitted, or refused by sbatch
            continue
        for number, name in enumerate(names):
            task = f"{job}_{number % tasks + 1}"
            if states.get(task, OVER[0]) not in OVER:
                found[name] = task, states[task]
    return found


def scripts(study_folder, rows, at_once=None, options=()):
    """Texts of what submit() would submit, each with the command as a comment."""
    first, groups = _next_number(study_folder), arrays(rows)
    folders = [study_folder.file(f"slurm-{number}") for number in range(first, first + len(groups))]
    texts = (job_script(study_folder, folder, *group, at_once) for folder, group in zip(folders, groups))
    return [f"{text}# {shell_line(_command(folder, options))}\n" for text, folder in zip(texts, folders)]


def _submit(study_folder, rows, tasks, at_once, options):
    folder = study_folder.file(f"slurm-{_next_number(study_folder)}")
    os.makedirs(folder)
    write(os.path.join(folder, ROWS), rows)
    write_file(os.path.join(folder, SCRIPT), job_script(study_folder, folder, rows, tasks, at_once))
    try:
        done = subprocess.run(_command(folder, options), capture_output=True, text=True, stdin=subprocess.DEVNULL)
    except FileNotFoundError:
        raise SlurmError("sbatch: not found; must be on a machine that submits to Slurm") from None
    job = done.stdout.strip().partition(";")[0]  # a cluster's name may follow
    if done.returncode or not job.isdecimal():
        raise SlurmError(f'sbatch: {" ".join(done.stderr.split()) or f"exit status {done.returncode}"}')
    write_file(os.path.join(folder, JOB), f"{job} {tasks}\n")
    return job


def _command(folder, options):
    return ["sbatch", "--parsable", *options, os.path.join(folder, SCRIPT)]


def _next_number(study_folder):
    return max(_numbers(study_folder), default=0) + 1


def _numbers(study_folder):
    try:
        names = os.listdir(study_folder.path)
    except FileNotFoundError:
        return []
    return sorted(int(found.group(1)) for found in map(_FOLDER.fullmatch, names) if found)
