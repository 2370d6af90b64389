"""The folder of a study for logs, and processes that run its rows."""

import fcntl
import multiprocessing
import os
import shutil
import signal
import subprocess
from contextlib import suppress
from multiprocessing.connection import wait

from yade_scripts.parameters import InputError
from yade_scripts.runner.rows import summary

LOGS = os.path.join("runs", "logs")
WORKER = os.path.join(os.path.dirname(os.path.abspath(__file__)), "worker.py")
NICE = 10  # as yade-batch runs its jobs


class StudyFolder:
    """The folder of a study, LOGS/NAME: a log for each row."""

    def __init__(self, path):
        self.path, self.held = path, None

    def file(self, name):
        return os.path.join(self.path, name)

    def log(self, row):
        return self.file(f"{row.name}.log")

    def remove_logs(self, rows):
        """Remove the logs of rows: an earlier failure would still be one to --status until the row's turn comes."""
        for row in rows:
            with suppress(FileNotFoundError):
                os.remove(self.log(row))

    def lock(self):
        """Take the study for this process and its jobs; raises InputError when another has it."""
        os.makedirs(self.path, exist_ok=True)
        self.held = os.open(self.path, os.O_RDONLY)
        try:
            fcntl.flock(self.held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            what = "this study is being run by another process, or its last jobs still are"
            raise InputError(f"{self.path}: {what}; must be one at a time (--status shows how far it is)") from None


class Batch:
    """Rows at work, as many at once as `threads` allows, by workers in sessions of their own: Ctrl-C reaches this
    process alone."""

    def __init__(self, folder, rows, threads, nice=NICE):
        self._folder, self._threads, self._nice = folder, threads, nice
        self._waiting, self._workers = list(rows), []
        folder.remove_logs(rows)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        """Have the runs write their checkpoints, and wait until they have. No other row is started."""
        self._waiting = []
        for worker in self._busy():
            worker.stop()
        while self.running():
            self.wait()
        for worker in self._workers:
            worker.close()

    def running(self):
        """Start rows as far as threads are free; the rows that are running."""
        for worker in self._busy():
            worker.poll()
        busy = sum(worker.row.threads for worker in self._busy())
        fits = lambda row: not busy or busy + row.threads <= self._threads
        while busy < self._threads and (row := next(filter(fits, self._waiting), None)):
            self._waiting.remove(row)
            self._idle(row).begin(row, self._folder.log(row))
            busy += row.threads
        return [worker.row for worker in self._busy()]

    def wait(self, seconds=None):
        """Return when something has happened to a row, or after so many seconds."""
        wait([worker.connection for worker in self._busy()], seconds)

    def _busy(self):
        return [worker for worker in self._workers if worker.row]

    def _idle(self, row):
        """A worker without a row; a new one, whose start is in the row's log, when all are busy."""
        free = [worker for worker in self._workers if not worker.row and worker.process.poll() is None]
        if not free:
            free.append(Worker(self._folder.log(row), self._nice, self._folder.held))
            self._workers += free
        return free[0]


def _environment():
    """This process's, without what is for another Python than YADE's, and what would bind all runs to one core."""
    left_out = ("VIRTUAL_ENV", "PYTHONHOME", "OMP_PROC_BIND", "OMP_PLACES", "GOMP_CPU_AFFINITY")
    kept = {name: value for name, value in os.environ.items() if name not in left_out}
    folders = kept.pop("PYTHONPATH", "").split(os.pathsep)
    own = [folder for folder in folders if folder and "site-packages" not in folder]  # Debian's: dist-packages
    return {**kept, "PYTHONPATH": os.pathsep.join(own), "DISPLAY": ""}


class Worker:
    """A process of YADE that runs rows one after another (worker.py), idle until it is given one.

    It is started without a shell: names are never anything else than names. log: the file to which YADE's own
    messages go as it starts; lock: the study's, or None, which is free again when the last worker has ended."""

    def __init__(self, log, nice, lock):
        if not shutil.which("yade"):
            raise InputError("yade: no such command on PATH; must be installed (make deps)")
        self.row = self._run = None  # the process of the run, as soon as it can be stopped
        self.connection, theirs = multiprocessing.Pipe()
        with open(log, "a") as output, theirs:
            self.process = subprocess.Popen(
                ["yade", "-n", f"--nice={nice}", "-x", WORKER, str(theirs.fileno())],
                stdout=output,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                env=_environment(),
                pass_fds=[theirs.fileno(), *([] if lock is None else [lock])],
                start_new_session=True,
            )

    def begin(self, row, log):
        """Have it run a row (rows.StudyRow), which resumes if it was stopped; its output goes to the end of the log."""
        self.row, self._run, self._log, self._stopped = row, None, os.path.abspath(log), False
        task = dict(script=os.path.abspath(row.script), arguments=row.arguments, threads=row.threads, log=self._log)
        with open(log, "a"), suppress(OSError):  # a worker that has died: poll() finds out
            self.connection.send(task)

    def poll(self):
        """Without a row, and with the end of its log, when the run has ended."""
        status = self._status()
        if status is not None:
            self.row = self._run = None
            with open(self._log, "a") as log:
                log.write(summary(status if status >= 0 else 128 - status))

    def stop(self):
        """SIGTERM to the run, as soon as there is one to receive it."""
        self._stopped = True
        if self._run:
            with suppress(ProcessLookupError):
                os.kill(self._run, signal.SIGTERM)

    def close(self):
        """End the process, when its run has ended."""
        self.connection.close()
        self.process.wait()

    def _status(self):
        """The exit status of the run, negative for a signal; None while it runs."""
        try:
            while self.connection.poll():
                self._run, status = self.connection.recv()
                if status is not None:
                    return status
                if self._stopped:
                    self.stop()
        except (EOFError, OSError):  # of a worker that was killed, or could not start
            return self.process.wait()
        return None
