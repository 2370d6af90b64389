"""Processes that run the rows of a study, its folder for logs, and what is measured for the estimate."""

import fcntl
import json
import multiprocessing
import os
import signal
import subprocess
import time
from contextlib import suppress
from dataclasses import asdict
from multiprocessing.connection import wait

from analysis.runs.files import RunFolderError, json_text, read_json, write_file
from analysis.runs.format import ENDED_FILE
from analysis.runs.status import changed
from yade_scripts.runner.cost import Cost, Piece, setup_seconds, step_seconds
from yade_scripts.runner.rows import DONE, summary

LOGS = os.path.join("runs", "logs")
MEASURING, POLL = 300, 0.05  # s, at most; s between looks at it
HERE = os.path.dirname(os.path.abspath(__file__))
MEASURE, WORKER = os.path.join(HERE, "cost.py"), os.path.join(HERE, "worker.py")
NICE = 10  # as yade-batch runs its jobs


class StudyBusy(RuntimeError):
    """Another process runs the same study; the message is one line."""


class StudyFolder:
    """runs/logs/NAME: a log for each row, the measured speed."""

    def __init__(self, name):
        self.path = os.path.join(LOGS, name)
        self.held = None
        self._ends, self._cost, self._known = {}, None, None

    def file(self, name):
        return os.path.join(self.path, name)

    def log(self, row):
        return self.file(f"{row.name}.log")

    def remove_logs(self, rows):
        """An earlier failure would still be one to --status until the row's turn comes."""
        for row in rows:
            with suppress(FileNotFoundError):
                os.remove(self.log(row))

    def lock(self):
        """Take the study for this process and its jobs; raises StudyBusy when another has it."""
        os.makedirs(self.path, exist_ok=True)
        self.held = os.open(self.path, os.O_RDONLY)
        try:
            fcntl.flock(self.held, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise StudyBusy(
                f"{self.path}: this study is being run by another process, or its last jobs still "
                "are; must be one at a time (--status shows how far it is)"
            ) from None

    def cost(self, rows, states):
        """Cost from the rows that have ended, and from what was measured; the same one until there is more of
        either."""
        ended = [(row, s.seconds) for row, s in zip(rows, states) if row.kind and s.kind == DONE and s.seconds]
        try:
            piece = Piece(**{name: float(number) for name, number in read_json(self.file("speed.json")).items()})
        except (RunFolderError, ValueError, TypeError, AttributeError):
            piece = None
        known = piece, [(row.out, seconds) for row, seconds in ended]
        if known != self._known:
            self._known, self._cost = known, Cost(piece, sorted(ended, key=self._end))
        return self._cost

    def _end(self, ended):
        """When a row's run came to its end [s since 1970]: looked up once."""
        out = ended[0].out
        if out not in self._ends:
            self._ends[out] = changed(os.path.join(out, ENDED_FILE))
        return self._ends[out]

    def measure(self, row, rows, states, at_once, stop):
        """Time a piece of a row's run, at_once of them together, unless runs have ended to judge by."""
        if row.kind is None or any(state.kind == DONE and state.seconds for state in states):
            return
        scene = [f"{name}={text}" for name, text in row.own_cells.items()]
        command = ["yade", "-n", f"--nice={NICE}", "-x", MEASURE, row.script, *scene]
        environment = {name: value for name, value in os.environ.items() if name != "YADE_BATCH"}
        together, begun = max(1, at_once // row.threads), time.monotonic()
        # In sessions of their own, as the runs: Linux shares processors out by session.
        of_process = dict(stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, env=environment)
        pieces = [subprocess.Popen(command, start_new_session=True, **of_process) for _ in range(together)]
        try:
            while (
                None in [piece.poll() for piece in pieces]
                and time.monotonic() < begun + MEASURING
                and not stop.received
            ):
                time.sleep(POLL)
            found = [json.loads(piece.stdout.read().splitlines()[-1]) for piece in pieces if piece.poll() == 0]
        except (ValueError, IndexError):
            found = []
        finally:
            for piece in pieces:
                piece.kill()
                piece.wait()
        if len(found) < together:  # a row that fails says so when it is run
            return
        slowest = max(found, key=lambda piece: piece["step"])
        setup, step = slowest["setup"], slowest["step"]
        start = time.monotonic() - begun - setup - step * slowest["steps"]
        piece = Piece(step / step_seconds(row), setup / setup_seconds(row), start)
        write_file(self.file("speed.json"), json_text(asdict(piece)))

    def basis(self, rows, states):
        """What the estimate rests on, in words."""
        cost = self.cost(rows, states)
        if cost.ended:
            return f"from {len(cost.ended)} runs that have ended"
        return (
            "nothing could be measured"
            if cost.piece is None
            else "measured: a piece of the first run, at the machine's present pace"
        )


class Batch:
    """Rows at work, as many at once as `threads` allows, by workers in sessions of their own: Ctrl-C reaches this
    process alone."""

    def __init__(self, folder, rows, threads):
        self._folder, self._threads = folder, threads
        self._waiting, self._workers = list(rows), []
        folder.remove_logs(rows)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()
        for worker in self._workers:
            worker.close()

    def running(self):
        """Start what there is room for; the rows that have not come to their end."""
        for worker in self._busy():
            worker.poll()
        busy = sum(worker.row.threads for worker in self._busy())
        fits = lambda row: not busy or busy + row.threads <= self._threads
        while busy < self._threads and (row := next(filter(fits, self._waiting), None)):
            self._waiting.remove(row)
            log = self._folder.log(row)
            self._idle(log).begin(row, log)
            busy += row.threads
        return [worker.row for worker in self._busy()]

    def wait(self, seconds):
        """Return when something has happened to a row, or after so many seconds."""
        wait([worker.connection for worker in self._busy()], seconds)

    def stop(self):
        """Have the runs write their checkpoints; returns when they have. No other row is started."""
        self._waiting = []
        for worker in self._busy():
            worker.stop()
        while busy := self._busy():
            wait([worker.connection for worker in busy])
            for worker in busy:
                worker.poll()

    def _busy(self):
        return [worker for worker in self._workers if worker.row]

    def _idle(self, log):
        """A worker without a row: one that there is, or a new one, whose start is in the log."""
        free = [worker for worker in self._workers if not worker.row and worker.is_alive()]
        if not free:
            # Workers inherit the study's lock: it is free again when the last of them has ended, even if this process
            # is killed.
            of_process = dict(start_new_session=True, pass_fds=[self._folder.held])
            free.append(Worker(log, [f"--nice={NICE}"], **of_process))
            self._workers += free
        return free[0]


class Worker:
    """A process of YADE that runs rows one after another (worker.py), idle until it is given one.

    It is started without a shell: names are never anything else than names. log: the file to which YADE's own
    messages go as it starts; options: more of yade's; process: more of subprocess.Popen's."""

    def __init__(self, log, options=(), pass_fds=(), **process):
        self.row = self.run = None
        self.connection, theirs = multiprocessing.Pipe()
        with open(log, "a") as output, theirs:
            self.process = subprocess.Popen(
                ["yade", "-n", *options, "-x", WORKER, str(theirs.fileno())],
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
        with open(log, "a"), suppress(OSError):  # a worker that has died: poll() finds out
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
