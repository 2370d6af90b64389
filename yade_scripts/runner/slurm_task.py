"""One task of a study's job array: the run of one row, by the rules of study.py. Called by Slurm (slurm.py).

    python3 slurm_task.py ROWS.table NUMBER       the row of that number, counted from 1

A run that has ended is not run again, one with other parameters is refused, one that was stopped resumes. SIGUSR1, which Slurm sends
before the time limit, has the run write its checkpoint; if it has come further in this task, the task is put into the queue
again. Exit status: that of the run; 0 when it had ended, 1 when it can't be run, 128 and more when it was stopped.
"""

import os
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__)))))
from analysis.printable import printable
from analysis.runs.running import this_job
from yade_scripts.parameters.errors import one_line_errors, tell
from yade_scripts.run import table
from yade_scripts.runner import rows
from yade_scripts.runner.job import Job
from yade_scripts.runner.rows import DONE, FAILED, RUNNING, WAITING

POLL = 0.1  # s
ALL_SIGNALLED = 2.0  # s in which Slurm's SIGTERM to all processes of a job has reached the run


def main(arguments):
    path, number = arguments[0], int(arguments[1]) - 1
    with one_line_errors("slurm_task.py"):
        row, line = rows.read(path)[number], table.read(path)[number].line
    log = os.path.join(os.path.dirname(os.path.dirname(path)), f"{row.name}.log")
    before = rows.state(row, log, rows.traces(row, log))
    if before.kind == DONE:
        print(f"{row.name}: has ended before", flush=True)
        return 0
    if before.kind == RUNNING:
        return _refuse(row, f"is running on {before.host}")
    if before.kind == FAILED:
        return _refuse(row, before.note)
    run = Run(row, f"{path}:{line}", log)
    status = run.wait()
    after = rows.state(row, log)
    if after.kind == WAITING and run.limit_is_near and after.progress > before.progress:
        _queue_again()
    if after.kind == FAILED:
        return _refuse(row, after.note, status)
    print(printable(f"{row.name}: {after.kind} {after.note}".rstrip()), flush=True)
    return status or int(after.kind != DONE)


class Run(Job):
    """yade at work on a row, and the signals that this process has had."""

    def __init__(self, *arguments):
        self.limit_is_near, self._stopped = False, None
        for number in (signal.SIGUSR1, signal.SIGTERM, signal.SIGINT):
            signal.signal(number, self._note)
        super().__init__(*arguments)

    def wait(self):
        """Its exit status, as a shell has it."""
        while (status := self.poll()) is None:
            time.sleep(POLL)
            self._pass_on()
        return status

    def _note(self, number, _frame):
        self.limit_is_near |= number == signal.SIGUSR1
        self._stopped = self._stopped or time.monotonic()

    def _pass_on(self):
        """SIGTERM to the run, once: a second one would end it without its checkpoint. SIGUSR1 comes to this process alone,
        others as a rule to all of the job: then the run handles them no more."""
        wait = 0.0 if self.limit_is_near else ALL_SIGNALLED
        if self._stopped and time.monotonic() > self._stopped + wait:
            handles = _handles(self.process.pid, signal.SIGTERM)
            if handles:
                self.process.terminate()
            if handles or not self.limit_is_near:  # otherwise it hasn't begun to handle them
                self._stopped = float("inf")


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
