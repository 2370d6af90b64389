"""The run folder: run.json, history.npz, states/NNNNNN.npz, ended. All SI; each file whole or not there."""

import fcntl
import json
import os
import platform
import re

import numpy as np

from yade_scripts import checkpoint
from yade_scripts.atomic_write import remove_unfinished, write_atomically

FORMAT = 1
CHANNELS = (
    "kinetic",
    "normal",
    "sliding",
    "rolling",
    "twisting",
    "slidingDissipation",
    "rollingDissipation",
    "twistingDissipation",
    "connection",
    "disconnection",
    "drag",
    "bondBreaking",
)
STATE = (
    "time",
    "position",
    "velocity",
    "angular_velocity",
    "radius",
    "aggregate",
    "contact_pairs",
    "contact_normal_force",
    "contact_bonded",
)
SERIES = ("time", *CHANNELS, "d", "v", "contacts", "contacts_between")


class RunFolderError(RuntimeError):
    """A run folder that can't be used; the message is one line: what, where, what is allowed."""


class RunFolder:
    """Writer of one run. Makes the folder, or empties that of an earlier run if it may.

    Raises RunFolderError when the folder can't be written, holds something else, is being written by another
    run, or holds a run that has ended and overwrite is false. With resume, a folder with a checkpoint is left as
    it is, and .checkpoint is that checkpoint, otherwise None; raises CheckpointError when it can't be read.
    """

    def __init__(self, path, overwrite=False, resume=False):
        self.path = path
        self.checkpoint = None
        self.states = os.path.join(path, "states")
        _require_usable(path, overwrite)
        try:
            os.makedirs(self.states, exist_ok=True)
            self._lock = _locked(path)
            for folder in (path, self.states):
                remove_unfinished(folder)
            if resume and checkpoint.exists(path):
                self.checkpoint = checkpoint.Checkpoint(path)
                return
            self._empty()
            write_atomically(self._file("run.json"), lambda file: file.write(b"{}\n"))
        except OSError as error:
            raise RunFolderError(f"out = {path}: {error.strerror}; " "allowed: a folder that can be written") from None

    def write_run(self, run):
        """run.json from a dictionary that JSON can hold."""
        write_json(self._file("run.json"), {"format": FORMAT, **run})

    def write_history(self, series):
        """history.npz from {name: (T,) array}, every name of SERIES."""
        write_atomically(self._file("history.npz"), lambda file: np.savez(file, **series))

    def write_state(self, number, state):
        """states/NNNNNN.npz from {name: array}."""
        write_atomically(os.path.join(self.states, f"{number:06d}.npz"), lambda file: np.savez(file, **state))

    def keep_states(self, number):
        """Take away all states but the first `number`."""
        for name in os.listdir(self.states):
            if name.endswith(".npz") and name >= f"{number:06d}.npz":
                os.unlink(os.path.join(self.states, name))

    def write_ended(self):
        """The mark that the run came to its planned end: written last."""
        write_atomically(self._file("ended"), lambda file: None)

    def _file(self, name):
        return os.path.join(self.path, name)

    def _empty(self):
        """Take away an earlier run's files, the mark of its end first, and nothing else."""
        checkpoint.remove(self.path)
        for name in ("ended", "history.npz", "run.json"):
            if os.path.exists(self._file(name)):
                os.unlink(self._file(name))
        self.keep_states(0)


def write_json(path, content):
    """A dictionary as a JSON file, whole or not there."""
    text = json.dumps(content, indent=2, allow_nan=False) + "\n"
    write_atomically(path, lambda file: file.write(text.encode()))


def closing_line(path, outcome, seconds):
    """What a script prints at its end; read_closing_line() finds it in a log."""
    return f"run folder: {path} ({outcome}, {seconds:.1f} s)"


def read_closing_line(log):
    """(path, outcome) from the text of a log, or None when the script didn't get to its end."""
    line = r"^run folder: (.*?) \((completed|interrupted|failed: .*), [0-9.]+ s\)$"
    found = re.findall(line, log, re.MULTILINE)
    return found[-1] if found else None


def being_written(path):
    """Whether a process of this machine holds the folder's lock (read from the kernel's list, without taking it)."""
    try:
        inode = str(os.stat(path).st_ino)
        with open("/proc/locks") as locks:
            return any(" FLOCK " in lock and lock.split()[5].rsplit(":", 1)[1] == inode for lock in locks)
    except OSError:
        return False


def hardware():
    """{'cpu': model, 'cores': number} of this machine."""
    model = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo") as lines:
            names = (line.split(":", 1)[1].strip() for line in lines if line.startswith("model name"))
            model = next(names, model)
    except OSError:
        pass
    return {"cpu": model, "cores": os.cpu_count()}


def _require_usable(path, overwrite):
    if not os.path.exists(path):
        return
    if not os.path.isdir(path):
        raise RunFolderError(f"out = {path}: is a file; allowed: a folder")
    if os.listdir(path) and not os.path.exists(os.path.join(path, "run.json")):
        raise RunFolderError(
            f"out = {path}: exists and is no run folder; " "allowed: a new folder, or one of an earlier run"
        )
    if os.path.exists(os.path.join(path, "ended")) and not overwrite:
        raise RunFolderError(f"out = {path}: holds a run that has ended; " "allowed: another folder, or overwrite=1")


def _locked(path):
    """The folder opened and locked for as long as this process lives (a killed run leaves no lock behind)."""
    handle = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise RunFolderError(f"out = {path}: another run is writing there; allowed: another folder") from None
    return handle
