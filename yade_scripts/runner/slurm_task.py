"""One task of a study's job array: the runs of some rows, one after another, by the rules of study.py. Called by Slurm (slurm.py).

    python3 slurm_task.py ROWS.table NUMBER TASKS      every row of that number, counted from 1, then each TASKS further on

A run that has ended is not run again, one with other parameters is refused, one that was stopped resumes. SIGUSR1, which Slurm sends
before the time limit, has the run write its checkpoint; if a run has come further in this task, the task is put into the queue
again. Exit status: 0 when all runs have ended, that of the last one that failed, 1 when one can't be run, 128 and more when it was stopped.
"""

import os
import signal
import subprocess
import sys
import time
from contextlib import suppress
from multiprocessing.connection import wait

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
from analysis.printable import printable
from analysis.runs.running import this_job
from yade_scripts.parameters.errors import one_line_errors, tell
from yade_scripts.runner import rows
from yade_scripts.runner.rows import DONE, FAILED, RUNNING, WAITING
from yade_scripts.runner.workers import Worker

POLL = 0.1  # s
ALL_SIGNALLED = 2.0  # s in which Slurm's SIGTERM to all processes of a job has reached the run


def main(arguments):
    path, number, tasks = arguments[0], int(arguments[1]), int(arguments[2])
    with one_line_errors("slurm_task.py"):
        own = rows.read(path)[number - 1 :: tasks]
    logs, task = os.path.dirname(os.path.dirname(path)), Task()
    status = 0
    for row in own:
        status = task.run(row, os.path.join(logs, f"{row.name}.log")) or status
    if task.limit_is_near and task.came_further and task.left:
        _queue_again()
    return status


class Task:
    """Runs rows; notes the signals that this process has had, whether there is something .left, and whether it .came_further."""

    def __init__(self):
        self.limit_is_near = self.came_further = self.left = False
        self._worker = self._since = None
        for number in (signal.SIGUSR1, signal.SIGTERM, signal.SIGINT):
            signal.signal(number, self._note)

    def run(self, row, log):
        """Run a row unless it has ended, must not be run, or a signal has come; the exit status."""
        if self._since is not None:
            self.left = True
            return 0
        before = rows.state(row, log, rows.traces(row, log))
        if before.kind == DONE:
            print(f"{row.name}: has ended before", flush=True)
            return 0
        if before.kind == RUNNING:
            return _refuse(row, f"is running on {before.host}")
        if before.kind == FAILED:
            return _refuse(row, before.note)
        status, after = self._run(row, log), rows.state(row, log)
        self.came_further |= after.progress > before.progress
        self.left |= after.kind == WAITING
        if after.kind == FAILED:
            return _refuse(row, after.note, status)
        print(printable(f"{row.name}: {after.kind} {after.note}".rstrip()), flush=True)
        return status or int(after.kind != DONE)

    def _run(self, row, log):
        with suppress(FileNotFoundError):
            os.remove(log)  # of a run before the task was queued again
        if not self._worker or not self._worker.is_alive():
            self._worker = Worker(log)
        self._worker.begin(row, log)
        while (status := self._worker.poll()) is None:
            wait([self._worker.connection], POLL)
            self._pass_on()
        return status

    def _note(self, number, _frame):
        self.limit_is_near |= number == signal.SIGUSR1
        self._since = self._since or time.monotonic()

    def _pass_on(self):
        """SIGTERM to the run, once: a second one would end it without its checkpoint. SIGUSR1 comes to this process alone,
        others as a rule to all of the job: then the run handles them no more."""
        delay = 0.0 if self.limit_is_near else ALL_SIGNALLED
        if self._since is not None and time.monotonic() > self._since + delay:
            handles = _handles(self._worker.run, signal.SIGTERM)
            if handles:
                self._worker.stop()
            if handles or not self.limit_is_near:  # otherwise it hasn't begun to handle them
                self._since = float("inf")


def _handles(pid, number):
    """Whether a process has a handler for a signal, so that it hasn't had it yet (run.stop_signals)."""
    try:
        with open(f"/proc/{pid}/status") as lines:
            caught = next(int(line.split()[1], 16) for line in lines if line.startswith("SigCgt"))
    except (OSError, StopIteration):
        return False
    return bool(caught >> (number - 1) & 1)


def _queue_again():
    """The time limit is near: Slurm begins this task anew, which resumes from the checkpoint."""
    subprocess.run(["scontrol", "requeue", this_job()[0]], check=False)  # says itself why not


def _refuse(row, reason, status=0):
    tell(f"{row.name}: {reason}", "slurm_task.py")
    return status or 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
