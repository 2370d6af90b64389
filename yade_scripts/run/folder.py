"""Writing a run folder, whose format is that of analysis.runs.format; each file is whole or not there."""

import hashlib
import os
import re
from contextlib import suppress

from analysis.runs import files, lock
from analysis.runs.files import npz, sync, write_file
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
from yade_scripts.parameters import InputError
from yade_scripts.run import checkpoint

# Names of files, relative to the folder, that runs write; nothing else is ever removed.
_OF_RUNS = re.compile(
    rf"{RUN_FILE}|{ENDED_FILE}|{HISTORY_FILE}|{STATES_FOLDER}/\d{{6,}}\.npz|"
    rf"{checkpoint.RECORDER}|{CHECKPOINT_FOLDER}/scene-\d+\.yade"
)


class RunFolder:
    """Writer of one run, which has the folder until close().

    Makes the folder, or removes the files of an earlier run from it if it may. With resume, a folder with a
    checkpoint is left as it is, and .checkpoint is that checkpoint, otherwise None. Raises InputError when the folder
    can't be used; what write...() raises is OSError."""

    def __init__(self, path, overwrite=False, resume=False):
        self.path, self.checkpoint = path, None
        self.sums = {}  # {file: SHA-256} of what was written, by this process and before its checkpoint
        self._lock = None
        try:
            files.make_folder(path)
            _require_ours(path)
            self._lock = lock.take(path)
            self._begin(overwrite, resume)
        except BaseException as error:
            self.close()
            if isinstance(error, lock.InUse):
                raise InputError(f"out = {path}: {error}") from None
            if isinstance(error, OSError):
                must = "" if "must be" in error.strerror else "; must be a folder that can be written"
                raise InputError(f"out = {path}: {error.strerror}{must}") from None
            raise

    def _begin(self, overwrite, resume):
        ended, stopped = self.has_ended(), checkpoint.exists(self.path)
        if ended and not (overwrite or resume and stopped):
            raise InputError(f"out = {self.path}: holds a run that has ended; must be another folder, or overwrite=1")
        if stopped and not (resume or overwrite):
            must = "must be another folder, or resume=1 (to continue it) or overwrite=1 (to start again)"
            raise InputError(f"out = {self.path}: holds a run that was stopped, with a checkpoint; {must}")
        if stopped and resume and not (overwrite and ended):
            self.checkpoint = checkpoint.Checkpoint.read(self.path)
        else:
            self._remove(lambda name: True)

    def resume(self):
        """Go on from the checkpoint, after it was checked: the mark of an end goes, and states that came later."""
        first_later = f"{STATES_FOLDER}/{state_file(self.checkpoint.states)}"
        self._remove(lambda name: name == ENDED_FILE or name.startswith(STATES_FOLDER) and name >= first_later)
        self.sums.update(self.checkpoint.sums)

    def close(self):
        """Give the folder back."""
        if self._lock is not None:
            lock.release(self.path, self._lock)
            self._lock = None

    def write_run(self, run):
        """run.json from a dictionary that JSON can hold."""
        self.write(RUN_FILE, files.json_text({"format": FORMAT, **run}).encode())

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
        """Remove the files of runs whose name is wanted, and what killed writers have left: the mark of the end first,
        then recorder.npz, without which a checkpoint is none; last run.json, by which a folder is known as a run's."""
        found = []
        for folder in ("", STATES_FOLDER, CHECKPOINT_FOLDER):
            place = os.path.join(self.path, folder)
            files.remove_unfinished(place)
            names = os.listdir(place) if os.path.isdir(place) else []
            found += [os.path.join(folder, name) for name in names]
        order = {ENDED_FILE: 0, checkpoint.RECORDER: 1, RUN_FILE: 3}
        chosen = [name for name in found if _OF_RUNS.fullmatch(name) and wanted(name)]
        for name in sorted(chosen, key=lambda name: order.get(name, 2)):
            os.unlink(os.path.join(self.path, name))
            self.sums.pop(name, None)
            if name == ENDED_FILE:
                sync(self.path)


def _require_ours(path):
    """Raise InputError for a folder that holds something else than a run, or nothing."""
    for name in (STATES_FOLDER, CHECKPOINT_FOLDER):
        if os.path.islink(os.path.join(path, name)):
            raise InputError(f"out = {path}: {name} is a link; must be a folder")
    if all(name == LOCK_FILE or files.is_unfinished(name) for name in os.listdir(path)):
        return
    try:
        run = files.read_json(os.path.join(path, RUN_FILE))
    except files.RunFolderError:
        run = None
    ours = {"format", "parameters", "derived", "outcome"}
    if not (isinstance(run, dict) and ours <= set(run) and run["format"] in READABLE):
        raise InputError(f"out = {path}: exists and is no run folder; must be a new folder, or one of an earlier run")
