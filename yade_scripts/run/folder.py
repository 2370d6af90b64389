"""Writing a run folder, whose format is that of analysis.runs.format; each file is whole or not there."""

import fcntl
import json
import os
from contextlib import suppress

import numpy as np

from analysis.runs.format import ENDED_FILE, FORMAT, HISTORY_FILE, RUN_FILE, STATES_FOLDER, state_file
from yade_scripts.parameters.errors import InputError
from yade_scripts.run import checkpoint
from yade_scripts.run.atomic_write import is_unfinished, remove_unfinished, sync, write_atomically
from yade_scripts.run.heartbeat import Beating, RunsElsewhere, is_heartbeat


class RunFolderError(InputError):
    """A run folder that can't be used; the message is one line: what, where, what it must be."""


class RunFolder:
    """Writer of one run. Makes the folder, or empties that of an earlier run if it may.

    Raises RunFolderError when the folder can't be written, holds something else, is being written by another
    run, or holds a run that has ended and overwrite is false. With resume, a folder with a checkpoint is left as
    it is, and .checkpoint is that checkpoint, otherwise None; raises CheckpointError when it can't be read.
    heartbeat: whether it has one from now on, or, when it is left as it is, from begin_heartbeat() on, until close().
    What write_...() raises is OSError, also when a run of another machine has taken over the folder.
    """

    def __init__(self, path, overwrite=False, resume=False, heartbeat=False):
        self.path = path
        self.checkpoint = self._heartbeat = None
        self.states = os.path.join(path, STATES_FOLDER)
        self._unsynced = set()  # paths that a power loss may still take
        try:
            self._lock = _made_and_locked(path)
            try:
                # Only now: until the lock was taken, another run may have come to its end there.
                _require_usable(path, overwrite)
                if resume and not self._has_ended() and checkpoint.exists(path):
                    self.checkpoint = checkpoint.Checkpoint(path)
                else:
                    if heartbeat:
                        self.begin_heartbeat()
                    self._begin()
            except BaseException:
                self.close()
                os.close(self._lock)
                raise
        except OSError as error:
            raise _unwritable(path, error) from None

    def begin_heartbeat(self):
        """Take the folder before other machines, too. Raises RunFolderError."""
        try:
            self._heartbeat = Beating(self.path)
        except RunsElsewhere as where:
            raise RunFolderError(
                f"out = {self.path}: another run is writing there, {where}; must be another folder"
            ) from None
        except OSError as error:
            raise _unwritable(self.path, error) from None

    def close(self):
        """End the heartbeat; the lock stays until the process ends."""
        if self._heartbeat:
            self._heartbeat.stop()
            self._heartbeat = None

    def write_run(self, run):
        """run.json from a dictionary that JSON can hold."""
        self._write(RUN_FILE, json_text({"format": FORMAT, **run}))

    def write_history(self, series):
        """history.npz from {name: (T,) array}, every name of the kind's history."""
        self._write(HISTORY_FILE, lambda file: np.savez(file, **series))

    def write_state(self, number, state):
        """states/NNNNNN.npz from {name: array}."""
        self._write(os.path.join(STATES_FOLDER, state_file(number)), lambda file: np.savez(file, **state))

    def keep_states(self, number):
        """Remove all states but the first `number`, and what a killed writer has left."""
        for folder in (self.path, self.states):
            remove_unfinished(folder)
        for name in os.listdir(self.states):
            if name.endswith(".npz") and name >= state_file(number):
                os.unlink(os.path.join(self.states, name))

    def sync(self):
        """Have all that was written so far on the disk, so that it outlives a power loss."""
        self._require_kept()
        for path in sorted(self._unsynced):
            sync(path)
        if self._unsynced:
            for folder in (self.states, self.path, os.path.dirname(os.path.abspath(self.path))):
                sync(folder)
        self._unsynced.clear()

    def write_ended(self):
        """The mark that the run came to its planned end: written last, when all the rest is on the disk."""
        try:
            self.sync()
            write_atomically(self._file(ENDED_FILE), lambda file: None, lasting=True)
        except OSError:
            with suppress(OSError):
                os.unlink(self._file(ENDED_FILE))
            raise

    def _file(self, name):
        return os.path.join(self.path, name)

    def _require_kept(self):
        if self._heartbeat:
            self._heartbeat.require_kept()

    def _write(self, name, write):
        self._require_kept()
        write_atomically(self._file(name), write)
        self._unsynced.add(self._file(name))

    def _has_ended(self):
        return os.path.exists(self._file(ENDED_FILE))

    def _begin(self):
        """Remove an earlier run's files, and nothing else: the mark of its end first; run.json stays in all moments."""
        if self._has_ended():
            os.unlink(self._file(ENDED_FILE))
            sync(self.path)  # before what it vouches for is gone
        checkpoint.remove(self.path)
        self._write(RUN_FILE, json_text({}))
        if os.path.exists(self._file(HISTORY_FILE)):
            os.unlink(self._file(HISTORY_FILE))
        os.makedirs(self.states, exist_ok=True)
        self.keep_states(0)


def write_json(path, content):
    """A dictionary as a JSON file, whole or not there."""
    write_atomically(path, json_text(content))


def json_text(content):
    """write(file) of a dictionary as JSON; raises ValueError for what JSON can't hold."""
    text = json.dumps(content, indent=2, allow_nan=False) + "\n"
    return lambda file: file.write(text.encode())


def _unwritable(path, error):
    return RunFolderError(f"out = {path}: {error.strerror}; must be a folder that can be written")


def _require_usable(path, overwrite):
    if not os.path.exists(os.path.join(path, RUN_FILE)) and not _is_empty(path):
        raise RunFolderError(
            f"out = {path}: exists and is no run folder; must be a new folder, or one of an earlier run"
        )
    if os.path.exists(os.path.join(path, ENDED_FILE)) and not overwrite:
        raise RunFolderError(f"out = {path}: holds a run that has ended; must be another folder, or overwrite=1")


def _is_empty(path):
    """Whether a folder holds nothing but what a run that was killed at its beginning may leave."""
    names = [name for name in os.listdir(path) if not is_unfinished(name) and not is_heartbeat(name)]
    states = os.path.join(path, STATES_FOLDER)
    return not names or (names == [STATES_FOLDER] and os.path.isdir(states) and _is_empty(states))


def _made_and_locked(path):
    """The folder opened and locked for as long as this process lives (a killed run leaves no lock behind)."""
    if os.path.exists(path) and not os.path.isdir(path):
        raise RunFolderError(f"out = {path}: is a file; must be a folder")
    os.makedirs(path, exist_ok=True)
    handle = os.open(path, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        os.close(handle)
        raise RunFolderError(f"out = {path}: another run is writing there; must be another folder") from None
    return handle
