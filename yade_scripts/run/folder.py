"""Writing a run folder, whose format is that of analysis.runs.format; each file is whole or not there."""

import fcntl
import json
import os
import re

import numpy as np

from analysis.runs.format import ENDED_FILE, FORMAT, HISTORY_FILE, RUN_FILE, STATES_FOLDER, state_file
from yade_scripts.parameters.errors import InputError
from yade_scripts.run import checkpoint
from yade_scripts.run.atomic_write import remove_unfinished, write_atomically


class RunFolderError(InputError):
    """A run folder that can't be used; the message is one line: what, where, what it must be."""


class RunFolder:
    """Writer of one run. Makes the folder, or empties that of an earlier run if it may.

    Raises RunFolderError when the folder can't be written, holds something else, is being written by another
    run, or holds a run that has ended and overwrite is false. With resume, a folder with a checkpoint is left as
    it is, and .checkpoint is that checkpoint, otherwise None; raises CheckpointError when it can't be read.
    """

    def __init__(self, path, overwrite=False, resume=False):
        self.path = path
        self.checkpoint = None
        self.states = os.path.join(path, STATES_FOLDER)
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
            write_atomically(self._file(RUN_FILE), lambda file: file.write(b"{}\n"))
        except OSError as error:
            raise RunFolderError(f"out = {path}: {error.strerror}; must be a folder that can be written") from None

    def write_run(self, run):
        """run.json from a dictionary that JSON can hold."""
        write_json(self._file(RUN_FILE), {"format": FORMAT, **run})

    def write_history(self, series):
        """history.npz from {name: (T,) array}, every name of the kind's history."""
        write_atomically(self._file(HISTORY_FILE), lambda file: np.savez(file, **series))

    def write_state(self, number, state):
        """states/NNNNNN.npz from {name: array}."""
        write_atomically(os.path.join(self.states, state_file(number)), lambda file: np.savez(file, **state))

    def keep_states(self, number):
        """Remove all states but the first `number`."""
        for name in os.listdir(self.states):
            if name.endswith(".npz") and name >= state_file(number):
                os.unlink(os.path.join(self.states, name))

    def write_ended(self):
        """The mark that the run came to its planned end: written last."""
        write_atomically(self._file(ENDED_FILE), lambda file: None)

    def _file(self, name):
        return os.path.join(self.path, name)

    def _empty(self):
        """Remove an earlier run's files, the mark of its end first, and nothing else."""
        checkpoint.remove(self.path)
        for name in (ENDED_FILE, HISTORY_FILE, RUN_FILE):
            if os.path.exists(self._file(name)):
                os.unlink(self._file(name))
        self.keep_states(0)


def write_json(path, content):
    """A dictionary as a JSON file, whole or not there."""
    text = json.dumps(content, indent=2, allow_nan=False) + "\n"
    write_atomically(path, lambda file: file.write(text.encode()))


def being_written(path):
    """Whether a process of this machine holds the folder's lock (read from the kernel's list, without taking it)."""
    try:
        inode = os.stat(path).st_ino
        with open("/proc/locks") as locks:
            return inode in locked_inodes(locks)
    except OSError:
        return False


def locked_inodes(lines):
    """Inodes on which the lines of /proc/locks say that a process holds a flock; one that waits for it has '->'."""
    held = r"\d+: FLOCK +\S+ +\S+ +-?\d+ +[0-9a-f]+:[0-9a-f]+:(\d+) "
    return {int(found.group(1)) for found in (re.match(held, line) for line in lines) if found}


def _require_usable(path, overwrite):
    if not os.path.exists(path):
        return
    if not os.path.isdir(path):
        raise RunFolderError(f"out = {path}: is a file; must be a folder")
    if os.listdir(path) and not os.path.exists(os.path.join(path, RUN_FILE)):
        raise RunFolderError(
            f"out = {path}: exists and is no run folder; must be a new folder, or one of an earlier run"
        )
    if os.path.exists(os.path.join(path, ENDED_FILE)) and not overwrite:
        raise RunFolderError(f"out = {path}: holds a run that has ended; must be another folder, or overwrite=1")


def _locked(path):
    """The folder opened and locked for as long as this process lives (a killed run leaves no lock behind)."""
    handle = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        raise RunFolderError(f"out = {path}: another run is writing there; must be another folder") from None
    return handle
