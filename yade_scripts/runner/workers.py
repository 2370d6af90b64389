"""Processes of YADE that run rows one after another (worker.py), started without a shell: names are never anything else than names."""

import multiprocessing
import os
import signal
import subprocess
from contextlib import suppress

from yade_scripts.runner.log import summary

SCRIPT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "worker.py")


class Worker:
    """One of them, idle until it is given a row.

    log: the file to which YADE's own messages go as it starts; options: more of yade's; process: more of subprocess.Popen's.
    """

    def __init__(self, log, options=(), pass_fds=(), **process):
        self.row = self.run = None
        self.connection, theirs = multiprocessing.Pipe()
        with open(log, "a") as output, theirs:
            self.process = subprocess.Popen(
                ["yade", "-n", *options, "-x", SCRIPT, str(theirs.fileno())],
                stdout=output,
                stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL,
                env={**os.environ, "DISPLAY": ""},
                pass_fds=(*pass_fds, theirs.fileno()),
                **process,
            )

    def is_alive(self):
        """Whether it can be given a row, now or when its run has ended."""
        return self.process.poll() is None

    def begin(self, row, log):
        """Have it run a row (rows.StudyRow), whose output goes to the end of the file log."""
        self.row, self.run, self._log, self._stopped = row, None, log, False
        arguments = [f"{name}={text}" for name, text in row.arguments.items()]
        task = dict(
            script=os.path.abspath(row.script), arguments=arguments, threads=row.threads, log=os.path.abspath(log)
        )
        with open(log, "a"), suppress(OSError):  # a worker that has died: poll() tells
            self.connection.send(task)

    def poll(self):
        """The run's exit status, as a shell has it, when it has ended; None while it runs. The log is complete then."""
        status = self._status()
        if status is None:
            return None
        self.row = self.run = None
        status = status if status >= 0 else 128 - status
        with open(self._log, "a") as log:
            log.write(summary(status))
        return status

    def stop(self):
        """SIGTERM to the run, as soon as there is one to hear it."""
        self._stopped = True
        if self.run:
            with suppress(ProcessLookupError):
                os.kill(self.run, signal.SIGTERM)

    def close(self):
        """End the process, when its run has ended."""
        self.connection.close()
        self.process.wait()

    def _status(self):
        try:
            while self.connection.poll():
                self.run, status = self.connection.recv()
                if status is not None:
                    return status
                if self._stopped:
                    self.stop()
        except (EOFError, OSError):  # of a worker that was killed, or could not start
            return self.process.wait()
        return None
