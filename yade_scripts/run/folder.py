"""Writing a run folder, whose format is that of analysis.runs.format; each file is whole or not there."""

import fcntl
import os
from contextlib import suppress

from analysis.runs.files import (
    is_unfinished,
    json_text,
    npz,
    remove_unfinished,
    require_output,
    sums_text,
    sync,
    write_file,
)
from analysis.runs.format import CHECKPOINT_FOLDER, ENDED_FILE, FORMAT, HISTORY_FILE, RUN_FILE, STATES_FOLDER
from yade_scripts.parameters.errors import InputError
from yade_scripts.run import checkpoint
from yade_scripts.run.heartbeat import Beating, RunsElsewhere, is_heartbeat, require_stopped
from yade_scripts.run.written import RECORDER, Written, state_name


class RunFolderError(InputError):
    """A run folder that can't be used; the message is one line: what, where, what it must be."""


class RunFolder:
    """Writer of one run. Makes the folder, or empties that of an earlier run if it may: of the files that runs have written
    into it (run.written), and no others.

    Raises RunFolderError when the folder can't be written, holds something else, is being written by another
    run, or holds a run that has ended and overwrite is false. With resume, a folder with a checkpoint is left as
    it is, and .checkpoint is that checkpoint, otherwise None; raises CheckpointError when it can't be read.
    heartbeat: whether it has one from now on, or, when it is left as it is, from begin_heartbeat() on, until close().
    states: how many will be written; each of more than that is put on the list when it comes.
    What write_...() raises is OSError, also when a run of another machine has taken over the folder.
    """

    def __init__(self, path, overwrite=False, resume=False, heartbeat=False, states=0):
        self.path = path
        self.checkpoint = self._heartbeat = None
        self.states = os.path.join(path, STATES_FOLDER)
        try:
            self._lock = _made_and_locked(path)
            try:
                # Only now: until the lock was taken, another run may have come to its end there.
                if heartbeat:
                    self._not_elsewhere(require_stopped)
                self._run, self._written = _usable(path, overwrite, resume)
                stopped = checkpoint.exists(path) and not (overwrite and self.has_ended())
                if stopped and not (resume or overwrite) and RECORDER in self._written.names:
                    raise RunFolderError(
                        f"out = {path}: holds a run that was stopped, with a checkpoint; must be another folder, or resume=1 "
                        "(to continue it) or overwrite=1 (to start again)"
                    )
                if stopped and resume:
                    self.checkpoint = checkpoint.Checkpoint(path)
                else:
                    if heartbeat:
                        self.begin_heartbeat()
                    self._begin(states)
            except BaseException:
                self.close()
                os.close(self._lock)
                raise
        except OSError as error:
            raise _unwritable(path, error) from None

    def begin_heartbeat(self):
        """Take the folder before other machines, too. Raises RunFolderError."""
        try:
            self._heartbeat = self._not_elsewhere(Beating)
        except OSError as error:
            raise _unwritable(self.path, error) from None

    def begin_again(self):
        """begin_heartbeat() for a run that goes on from its checkpoint; one that had ended has not any more."""
        self.begin_heartbeat()
        if self.has_ended():
            self._written.remove(lambda name: name == ENDED_FILE)
            sync(self.path)

    def close(self):
        """End the heartbeat; the lock stays until the process ends."""
        if self._heartbeat:
            self._heartbeat.stop()
            self._heartbeat = None

    def write_run(self, run):
        """run.json from a dictionary that JSON can hold."""
        self._run = run
        self._write_run()

    def write_history(self, series):
        """history.npz from {name: (T,) array}, every name of the kind's history."""
        self.write(HISTORY_FILE, npz(**series))

    def write_state(self, number, state):
        """states/NNNNNN.npz from {name: array}."""
        self.write(state_name(number), npz(**state))

    def write(self, name, content):
        """Write a file of bytes, which comes on the folder's list before. name: seen from the folder."""
        if self._written.claim([name]):
            self._write_run()
        self._write(name, content)

    def keep_states(self, number):
        """Remove all states but the first `number`, and what a killed writer has left."""
        for folder in (self.path, self.states, os.path.join(self.path, CHECKPOINT_FOLDER)):
            remove_unfinished(folder)
        self._written.remove(lambda name: os.path.dirname(name) == STATES_FOLDER and name >= state_name(number))

    def remove_checkpoint(self, but=()):
        """Remove the files of checkpoints, but those of these names (seen from the folder)."""
        self._written.remove(lambda name: os.path.dirname(name) == CHECKPOINT_FOLDER and name not in but)
        with suppress(OSError):  # there is none, or it holds what no run has written
            os.rmdir(self._file(CHECKPOINT_FOLDER))

    def write_ended(self):
        """The mark that the run came to its planned end, with the sums of its files: written last, when all the rest is on the disk."""
        try:
            self.write(ENDED_FILE, sums_text(self.path, self._written.results()))
        except OSError:
            with suppress(OSError):
                os.unlink(self._file(ENDED_FILE))
            raise

    def has_ended(self):
        """Whether the mark is there that the run came to its planned end."""
        return os.path.exists(self._file(ENDED_FILE))

    def _file(self, name):
        return os.path.join(self.path, name)

    def _require_kept(self):
        if self._heartbeat:
            self._heartbeat.require_kept()

    def _write(self, name, content):
        self._require_kept()
        write_file(self._file(name), content)

    def _write_run(self):
        run = {"format": FORMAT, **self._run, "files": sorted(self._written.names)}
        self._write(RUN_FILE, json_text(run))

    def _begin(self, states):
        """Remove an earlier run's files, and nothing else: the mark of its end first; run.json, with all on its list, stays in all
        moments."""
        own = Written.of_run(self.path, states)
        self._written.claim(own.names)
        if self.has_ended():
            self._written.remove(lambda name: name == ENDED_FILE)
            sync(self.path)  # before what it vouches for is gone
        self._run = {}
        self._write_run()
        self.remove_checkpoint()
        self._written.remove()
        self._written = own
        os.makedirs(self.states, exist_ok=True)
        self.keep_states(0)

    def _not_elsewhere(self, take):
        """take(path of the folder), where no run of another machine writes there; RunFolderError where one does."""
        try:
            return take(self.path)
        except RunsElsewhere as where:
            raise RunFolderError(
                f"out = {self.path}: another run is writing there, {where}; must be another folder"
            ) from None


def write_json(path, content):
    """A dictionary as a JSON file, whole or not there."""
    write_file(path, json_text(content))


def _unwritable(path, error):
    inside = error.filename and os.path.abspath(error.filename) != os.path.abspath(path)
    where = f"{os.path.relpath(error.filename, path)}: " if inside else ""
    wanted = "" if "; must be " in error.strerror else "; must be a folder that can be written"
    return RunFolderError(f"out = {path}: {where}{error.strerror}{wanted}")


def _usable(path, overwrite, resume):
    """(run.json, Written) of the run in a folder, {} and an empty one for a new folder; RunFolderError where it holds something
    else, or a run that has ended and may not be replaced."""
    if _is_empty(path):
        return {}, Written(path)
    if not os.path.lexists(os.path.join(path, RUN_FILE)):
        raise RunFolderError(
            f"out = {path}: exists and is no run folder; must be a new folder, or one of an earlier run"
        )
    require_output(os.path.join(path, RUN_FILE))
    run, written = Written.read(path)
    if written is None:
        raise RunFolderError(
            f"out = {path}: its {RUN_FILE} has no list of the files that a run wrote (as of another program, or before version "
            "0.5.0); must be another folder, or that one moved away"
        )
    if os.path.exists(os.path.join(path, ENDED_FILE)) and not (overwrite or resume and checkpoint.exists(path)):
        raise RunFolderError(f"out = {path}: holds a run that has ended; must be another folder, or overwrite=1")
    written.require_files()
    return run, written


def _is_empty(path):
    """Whether a folder holds nothing but what a run that was killed at its beginning may leave."""
    names = [name for name in os.listdir(path) if not is_unfinished(name) and not is_heartbeat(path, name)]
    states = os.path.join(path, STATES_FOLDER)
    return not names or (
        names == [STATES_FOLDER] and os.path.isdir(states) and not os.path.islink(states) and _is_empty(states)
    )


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
