"""Writing a run folder, whose format is that of analysis.runs.format; each file is whole or not there."""

import errno
import hashlib
import os
import re
from contextlib import suppress

from analysis.runs import lock
from analysis.runs.files import RunFolderError as Unreadable
from analysis.runs.files import (
    is_unfinished,
    json_text,
    make_folder,
    npz,
    read_json,
    remove_unfinished,
    sync,
    write_file,
)
from analysis.runs.format import (
    CHECKPOINT_FOLDER,
    ENDED_FILE,
    FORMAT,
    HISTORY_FILE,
    LOCK_FILE,
    READABLE,
    RUN_FILE,
    STATES_FOLDER,
    state_file,
)
from yade_scripts.parameters.errors import InputError
from yade_scripts.run import checkpoint

# Names of files, relative to the folder, that runs write; nothing else is ever removed.
_OF_RUNS = re.compile(
    rf"{RUN_FILE}|{ENDED_FILE}|{HISTORY_FILE}|{STATES_FOLDER}/\d{{6,}}\.npz|"
    rf"{checkpoint.RECORDER}|{CHECKPOINT_FOLDER}/scene-\d+\.yade"
)


class RunFolderError(InputError):
    """A run folder that can't be used; the message is one line: what, where, what it must be."""


class RunFolder:
    """Writer of one run, which has the folder until close().

    Makes the folder, or removes the files of an earlier run from it if it may. With resume, a folder with a
    checkpoint is left as it is, and .checkpoint is that checkpoint, otherwise None.

    Raises RunFolderError when the folder can't be written, holds something else, is being written by another run,
    holds a run that has ended and overwrite is false, or one that was stopped and neither resume nor overwrite is
    true; CheckpointError when the checkpoint can't be read. What write...() raises is OSError."""

    def __init__(self, path, overwrite=False, resume=False):
        self.path, self.checkpoint = path, None
        self.sums = {}  # {file: SHA-256} of what was written, by this process and before its checkpoint
        self._lock = None
        try:
            make_folder(path)
            _require_ours(path)
            self._lock = lock.take(path)
            self._begin(overwrite, resume)
        except lock.InUse as problem:
            raise RunFolderError(f"out = {path}: {problem}") from None
        except OSError as error:
            self.close()
            raise _unwritable(path, error) from None
        except BaseException:
            self.close()
            raise

    def _begin(self, overwrite, resume):
        ended, stopped = self.has_ended(), checkpoint.exists(self.path)
        if ended and not (overwrite or resume and stopped):
            raise RunFolderError(
                f"out = {self.path}: holds a run that has ended; must be another folder, or overwrite=1"
            )
        if stopped and not (resume or overwrite):
            raise RunFolderError(
                f"out = {self.path}: holds a run that was stopped, with a checkpoint; must be another folder, "
                "or resume=1 (to continue it) or overwrite=1 (to start again)"
            )
        if stopped and resume and not (overwrite and ended):
            self.checkpoint = checkpoint.Checkpoint(self.path)
        else:
            self._remove(lambda name: True)

    def resume(self):
        """Go on from the checkpoint, after it was checked: a run that had ended has not any more."""
        self._remove(lambda name: name == ENDED_FILE)
        self.sums.update(self.checkpoint.sums)
        self.keep_states(self.checkpoint.states)

    def close(self):
        """Give the folder back."""
        if self._lock is not None:
            lock.release(self.path, self._lock)
            self._lock = None

    def write_run(self, run):
        """run.json from a dictionary that JSON can hold."""
        self.write(RUN_FILE, json_text({"format": FORMAT, **run}).encode())

    def write_history(self, series):
        """history.npz from {name: (T,) array}, every name of the kind's history."""
        self.write(HISTORY_FILE, npz(**series))

    def write_state(self, number, state):
        """states/NNNNNN.npz from {name: array}."""
        self.write(f"{STATES_FOLDER}/{state_file(number)}", npz(**state))

    def write(self, name, content):
        """Write a file of bytes; name: relative to the folder."""
        file = os.path.join(self.path, name)
        os.makedirs(os.path.dirname(file), exist_ok=True)
        write_file(file, content)
        self.sums[name] = hashlib.sha256(content).hexdigest()

    def keep_states(self, number):
        """Remove all states but the first `number`."""
        self._remove(lambda name: name.startswith(STATES_FOLDER) and name >= f"{STATES_FOLDER}/{state_file(number)}")

    def remove_checkpoint(self, but=()):
        """Remove the files of checkpoints, but those of these names (relative to the folder)."""
        self._remove(lambda name: name.startswith(CHECKPOINT_FOLDER) and name not in but)
        with suppress(OSError):  # it is not there, or holds something else
            os.rmdir(os.path.join(self.path, CHECKPOINT_FOLDER))

    def write_ended(self):
        """The mark that the run came to its planned end, with the sums of its files: written last."""
        names = sorted(name for name in self.sums if not name.startswith(CHECKPOINT_FOLDER))
        sync(os.path.dirname(os.path.abspath(self.path)))
        write_file(os.path.join(self.path, ENDED_FILE), "".join(f"{self.sums[name]}  {name}\n" for name in names))

    def has_ended(self):
        """Whether the mark is there that the run came to its planned end."""
        return os.path.exists(os.path.join(self.path, ENDED_FILE))

    def _remove(self, wanted):
        """Remove the files of runs whose name is wanted, and what killed writers have left.

        The mark of the end goes first, then recorder.npz, without which a checkpoint is none; run.json, by which a
        folder is known as a run's, goes last."""
        found = []
        for folder in ("", STATES_FOLDER, CHECKPOINT_FOLDER):
            place = os.path.join(self.path, folder)
            remove_unfinished(place)
            names = os.listdir(place) if os.path.isdir(place) else []
            found += [os.path.join(folder, name) for name in names]
        order = {ENDED_FILE: 0, checkpoint.RECORDER: 1, RUN_FILE: 3}
        chosen = [name for name in found if _OF_RUNS.fullmatch(name) and wanted(name)]
        for name in sorted(chosen, key=lambda name: order.get(name, 2)):
            os.unlink(os.path.join(self.path, name))
            self.sums.pop(name, None)
            if name == ENDED_FILE:
                sync(self.path)


def _unwritable(path, error):
    inside = error.filename and os.path.abspath(error.filename) != os.path.abspath(path)
    where = f"{os.path.relpath(error.filename, path)}: " if inside else ""
    wanted = "" if "; must be " in error.strerror else "; must be a folder that can be written"
    return RunFolderError(f"out = {path}: {where}{error.strerror}{wanted}")


def _require_ours(path):
    """Raise RunFolderError for a folder that holds something else than a run, or nothing."""
    if not [name for name in os.listdir(path) if name != LOCK_FILE and not is_unfinished(name)]:
        return
    for name in (STATES_FOLDER, CHECKPOINT_FOLDER):
        if os.path.islink(os.path.join(path, name)):
            raise OSError(errno.EINVAL, "is a link; must be a folder", os.path.join(path, name))
    try:
        run = read_json(os.path.join(path, RUN_FILE))
    except Unreadable:
        run = None
    ours = {"format", "parameters", "derived", "outcome"}
    if not (isinstance(run, dict) and ours <= set(run) and run["format"] in READABLE):
        raise RunFolderError(
            f"out = {path}: exists and is no run folder; must be a new folder, or one of an earlier run"
        )
