"""Collisions of a table on a GPU, or by the same code on a processor: a run folder of each as YADE's runs leave it. No
YADE is needed.

Many collisions are on the device together, each with its own step and length. Those that have come to a sample that
becomes a state, or at which it is looked whether they are at rest, are judged and written by other processes, which
also prepare the next scenes, while the device goes on with the others. A run on a device has no checkpoints: one that
was stopped starts again."""

import multiprocessing
import queue
import subprocess
import sys
import threading
import time
from concurrent.futures import Future, ThreadPoolExecutor, wait
from contextlib import suppress
from functools import partial
from pathlib import Path

import numpy as np

from analysis.runs.files import RunFolderError
from analysis.version import commit, version
from yade_scripts.experiments import collision
from yade_scripts.parameters import InputError, one_line
from yade_scripts.run.device_run import Seen, mechanisms_of
from yade_scripts.run.ensemble import DEVICE, PROCESSOR, WHOLE_DEVICE, WHOLE_PROCESSOR, Collision, DeviceError, Library
from yade_scripts.run.parameters import CORES

LIBRARIES = {"gpu": (DEVICE, WHOLE_DEVICE), "processor": (PROCESSOR, WHOLE_PROCESSOR)}
LARGE = 10_000  # grains of both aggregates, from which on the whole device works on one collision: not measured yet
TOP = Path(__file__).resolve().parents[2]
ENOUGH = 3  # times as many collisions under way as the device computes at once: each holds a file of its process
LAUNCHES = 2  # under way: when one has come to an end the next must be there
PART = 1000  # steps of a launch, at most
PATIENCE = 0.1  # s, between looks at signals, and for memory of the device


def library_of(device):
    """The Library of a device, a name of LIBRARIES. Raises InputError."""
    library, library.large = (_loaded(device, file) for file in LIBRARIES[device])
    return library


def _loaded(device, file):
    if not file.exists():
        raise InputError(f"--device {device}: {file} is not built; must be made first (make gpu; make for a processor)")
    try:
        library = Library(file)
    except OSError as error:
        raise InputError(f"--device {device}: {one_line(error)}; must be a machine with that device") from None
    if not library.device:
        raise InputError(f"--device {device}: none found; must be a machine with that device")
    return library


def why_not(parameters, library):
    """Why a run of these collision.CollisionParameters can't run on a device, or None."""
    reasons = {
        "engine = functors": parameters.engine != "fused",
        "a plate": parameters.target == collision.WALL,
        "planar = 1": bool(parameters.planar),
        "springDamping": bool(parameters.springDamping),
        "these springs": not library.runs(mechanisms_of(parameters)),
    }
    return next((reason for reason, given in reasons.items() if given), None)


def run(parameters, library, stop=None, progress=lambda ended: None):
    """Run collisions and write their folders; {number in `parameters`: why it failed, in a line}.

    parameters: list of collision.CollisionParameters; stop: script.StopSignals, after a signal the runs that are under
    way are left as they are; progress(ended): called with the number of runs that have come to their end since."""
    under_way = max(1, min(ENOUGH * library.at_once, len(parameters)))
    host, rows, ended, shown = _Host(library, min(CORES, under_way)), enumerate(parameters), {}, 0

    def work():
        for number, given in rows:
            if host.stopped:
                return
            ended[number] = host.run(number, given)

    with ThreadPoolExecutor(under_way) as threads:
        working = left = [threads.submit(work) for _ in range(under_way)]
        try:
            while left and not (stop and stop.received):
                _, left = wait(left, PATIENCE)
                progress(len(ended) - shown)
                shown = len(ended)
        finally:
            host.stopped = True
            threads.shutdown()
            host.close()
        for one in working:
            one.result()  # raises what it may have ended by
    return {number: problem for number, problem in ended.items() if problem}


class _Host:
    """What runs share: the device with the threads that launch, and the processes beside it."""

    def __init__(self, library, processes):
        self.stopped = False
        self._library, self._processes = library, [_Process() for _ in range(processes)]
        self._placing, self._placed = threading.Lock(), set()  # numbers of the runs that are on the device
        self._waiting = queue.SimpleQueue()  # (Collision, steps, Future) that are to be launched
        self._launches = [threading.Thread(target=self._launch) for _ in range(LAUNCHES)]
        for thread in self._launches:
            thread.start()
        versions = {"contact_law": version(), "python": sys.version.split()[0], "numpy": np.__version__}
        self._made = {"versions": versions, "commit": commit(), "device": library.device}

    def close(self):
        for _ in self._launches:
            self._waiting.put(None)
        for thread in self._launches:
            thread.join()
        for process in self._processes:
            process.close()

    def run(self, number, given):
        """Bring a run to its end; why it failed, or None."""
        call = partial(self._processes[number % len(self._processes)].call, number)
        try:
            start = call("begin", given, self._made)
            one, steps = self._place(number, start), start.steps
            while steps is not None and not self.stopped:
                try:
                    self._waiting.put((one, steps, done := Future()))
                    done.result()
                    what = "look", _seen(one)
                except DeviceError as error:
                    what = "fail", one_line(error)
                steps = call(*what)
        except (InputError, RunFolderError, OSError, ValueError, DeviceError) as error:
            return one_line(error)
        finally:
            self._placed.discard(number)

    def _place(self, number, start):
        """Have a Collision on the device; where its memory is full, when others have come to their end."""
        library = self._library
        if library.large and len(start.grains.position) >= LARGE:
            library = library.large
        with self._placing:
            while True:
                try:
                    one = Collision(library, start.grains, **start.options)
                    self._placed.add(number)
                    return one
                except DeviceError:
                    if not self._placed or self.stopped:
                        raise
                    time.sleep(PATIENCE)

    def _launch(self):
        """Bring on whatever waits for it, all together, until close()."""
        while task := self._waiting.get():
            tasks = [task]
            with suppress(queue.Empty):
                while True:
                    tasks.append(self._waiting.get_nowait())
            try:
                for library in {one.library for one, _, _ in tasks}:
                    own = [(one, min(steps, PART)) for one, steps, _ in tasks if one.library is library]
                    library.run(*zip(*own))
            except DeviceError as error:  # the device is lost, and all that was on it
                for _, _, done in tasks:
                    done.set_exception(error)
                continue
            for one, steps, done in tasks:
                if steps > PART and not self.stopped:
                    self._waiting.put((one, steps - PART, done))
                else:
                    done.set_result(None)


def _seen(one):
    """Seen of a Collision; DeviceError if it has failed."""
    if one.read().failure:
        raise DeviceError(one.failure)
    return Seen(one.motion(), one.contacts(), one.samples())


class _Process:
    """A process that prepares, judges and writes runs (device_run.serve), in a session of its own: Ctrl-C reaches this
    one alone."""

    def __init__(self):
        self._connection, theirs = multiprocessing.Pipe()
        self._calls = threading.Lock()
        with theirs:
            code = f"import sys; sys.path.insert(0, {str(TOP)!r}); from yade_scripts.run.device_run import serve; "
            self._process = subprocess.Popen(
                [sys.executable, "-c", code + f"serve({theirs.fileno()})"],
                pass_fds=[theirs.fileno()],
                stdin=subprocess.DEVNULL,
                start_new_session=True,
            )

    def call(self, *task):
        """The answer of serve(); raises what it sends as an exception."""
        try:
            with self._calls:
                self._connection.send(task)
                answer = self._connection.recv()
        except (EOFError, OSError):
            raise DeviceError("the process that prepares and writes it has died") from None
        if isinstance(answer, Exception):
            raise answer
        return answer

    def close(self):
        self._connection.close()
        self._process.wait()
