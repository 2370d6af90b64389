"""A run's heartbeat, and which of several starts, on machines of a shared disk, gets its folder.

A start takes the folder by making the file .heartbeat-N, N one more than the last start's, which only one of them can; it
may do so when the last start's heartbeat has stopped (analysis.runs.running). The folder is its own as long as that file is
there: a run that was paused until another one took over its folder finds the file gone, and writes nothing any more. Both
files are removed at any end of the run but a kill.
"""

import errno
import json
import os
import re
import threading
import time
from contextlib import suppress
from dataclasses import asdict, replace

from analysis.runs import running
from analysis.runs.files import RunFolderError, make_new, read_json, write_file
from analysis.runs.format import HEARTBEAT_FILE
from analysis.runs.running import INTERVAL, Heartbeat, Place

_START = re.compile(r"\.heartbeat-(\d+)")


class RunsElsewhere(Exception):
    """A folder that a run of another machine has; the message says where."""


class Beating:
    """Takes a run folder (path), whose lock this process holds, and writes heartbeat.json every `interval` seconds [s] until
    stop(), from a thread, which waits while a step is taken or a scene is saved or loaded: some 20 s with a million grains.

    Raises RunsElsewhere, and OSError when the folder can't be written.
    """

    def __init__(self, folder, interval=INTERVAL):
        self.folder, self.now = folder, _of_this_process(interval)
        self._take()
        self._written, self._writing = time.monotonic(), threading.Lock()
        self._ending = threading.Event()
        self._thread = threading.Thread(target=self._beat_on, name="heartbeat", daemon=True)
        self._thread.start()

    def require_kept(self):
        """Raise OSError when another run has taken the folder over; to be called before a file in it is written."""
        if time.monotonic() - self._written > 2 * self.now.interval:  # the thread, or all of the process, was paused
            self._beat()

    def stop(self):
        """The end: the files go, unless they are another run's by now."""
        self._ending.set()
        self._thread.join()
        with suppress(OSError):
            self._require_own()
            os.unlink(self._file(HEARTBEAT_FILE))
        _unlink(self._own())

    def _beat_on(self):
        while not self._ending.wait(self.now.interval):
            with suppress(OSError):  # a full disk, a network that is away: the run's own writes tell of them
                self._beat()

    def _beat(self):
        with self._writing:
            self._require_own()
            self._write(beat=self.now.beat + 1)
            self._written = time.monotonic()

    def _require_own(self):
        if not os.path.exists(self._own()):
            raise OSError(
                errno.EBUSY, "another run has taken over the folder, as this one's heartbeat had stopped", self.folder
            )

    def _take(self):
        starts = require_stopped(self.folder)
        if os.path.lexists(self._file(HEARTBEAT_FILE)) and not is_heartbeat(self.folder, HEARTBEAT_FILE):
            raise OSError(errno.EEXIST, "no run has written it; must be moved away", self._file(HEARTBEAT_FILE))
        last = running.read_heartbeat(self.folder)
        self.now = replace(self.now, start=max([*_numbers(starts), last.start if last else 0]) + 1)
        try:
            make_new(self._own(), _text(self.now))
        except FileExistsError:
            raise RunsElsewhere("which has just begun") from None
        try:
            # another one, while this process was paused
            if _numbers(_starts(self.folder) - starts) != {self.now.start}:
                raise RunsElsewhere("which has just begun")
            self._write()
        except BaseException:
            _unlink(self._own())
            raise
        for start in _numbers(starts):
            _unlink(self._file(_name(start)))

    def _write(self, **changed):
        now = replace(self.now, **changed)
        write_file(self._file(HEARTBEAT_FILE), _text(now))  # of a run that a power loss ends, too
        self.now = now

    def _own(self):
        return self._file(_name(self.now.start))

    def _file(self, name):
        return os.path.join(self.folder, name)


def is_heartbeat(folder, name):
    """Whether a file of this name in a folder (path) is one of those kept here: by its name and what it says."""
    if not (name == HEARTBEAT_FILE or _START.fullmatch(name)):
        return False
    file = os.path.join(folder, name)
    if os.path.islink(file) or not os.path.isfile(file):
        return False
    try:
        return not os.path.getsize(file) or set(read_json(file)) == set(asdict(Heartbeat()))
    except (RunFolderError, TypeError):
        return False


def require_stopped(folder):
    """The starts in a folder, as _starts() gives them; RunsElsewhere unless all have stopped.

    A start later than the one that heartbeat.json is of has left nothing but its own file: it was killed as it began, or is about
    to be refused, and then says nothing of the one before it."""
    starts = _starts(folder)
    last = running.read_heartbeat(folder)
    later = sorted(number for number in _numbers(starts) if last is None or number > last.start)
    for name in [HEARTBEAT_FILE, *map(_name, later)]:
        heartbeat = running.read_heartbeat(folder, name)
        if heartbeat and running.beats(os.path.join(folder, name), heartbeat):
            raise RunsElsewhere(str(Place(heartbeat.host, heartbeat.job, False)))
    return starts


def _starts(folder):
    """{(N, when it was made [ns])} of the files .heartbeat-N in a folder: one that a refused start has taken away, and the next
    one has made anew, is another."""
    starts = set()
    for found in filter(None, map(_START.fullmatch, os.listdir(folder))):
        with suppress(FileNotFoundError):
            starts.add((int(found.group(1)), os.stat(os.path.join(folder, found.string)).st_mtime_ns))
    return starts


def _numbers(starts):
    return {number for number, _ in starts}


def _name(start):
    return f".heartbeat-{start}"


def _of_this_process(interval):
    host, boot = running.this_machine()
    job, restarts = running.this_job()
    return Heartbeat(host, boot, os.getpid(), job, restarts, interval=interval)


def _text(heartbeat):
    return (json.dumps(asdict(heartbeat), indent=2) + "\n").encode()


def _unlink(path):
    with suppress(OSError):
        os.unlink(path)
