"""Which files of a run folder its runs have written: the list `files` of its run.json, by which a folder is known as a run's.

A name comes on the list before its file is made, and only when nothing has that name. So what is on the list is a run's, and
nothing else is ever removed; links are not followed.
"""

import errno
import os
import re
from contextlib import suppress

from analysis.runs.files import RunFolderError, read_json, require_output
from analysis.runs.format import (
    CHECKPOINT_FOLDER,
    ENDED_FILE,
    HISTORY_FILE,
    READABLE,
    RUN_FILE,
    STATES_FOLDER,
    state_file,
)
from yade_scripts.run import checkpoint

RECORDER = f"{CHECKPOINT_FOLDER}/{checkpoint.RECORDER}"
_SCENES = f"{CHECKPOINT_FOLDER}/scene-*.yade"  # one entry for those of all steps
_SCENE = re.compile(rf"{CHECKPOINT_FOLDER}/scene-\d+\.yade")
_STATE = re.compile(rf"{STATES_FOLDER}/\d{{6,}}\.npz")


def state_name(number):
    """Name of the file of state `number`, seen from the run folder."""
    return f"{STATES_FOLDER}/{state_file(number)}"


class Written:
    """The list of a folder (path); .names as in run.json."""

    def __init__(self, folder, names=()):
        self.folder, self.names = folder, set(names)

    @classmethod
    def of_run(cls, folder, states):
        """That of a run with so many states."""
        return cls(folder, [HISTORY_FILE, ENDED_FILE, RECORDER, _SCENES, *map(state_name, range(states))])

    @classmethod
    def read(cls, folder):
        """(run.json as a dictionary, its Written); ({}, None) for a run.json that no run has written."""
        try:
            run = read_json(os.path.join(folder, RUN_FILE))
        except RunFolderError:
            return {}, None
        names = run.get("files") if isinstance(run, dict) and run.get("format") in READABLE else None
        if not isinstance(names, list) or not all(isinstance(name, str) and _may_be_listed(name) for name in names):
            return {}, None
        return run, cls(folder, names)

    def claim(self, names):
        """Put names on the list; whether one is new. OSError where such a file is there, which no run has written then."""
        new = {_SCENES if _SCENE.fullmatch(name) else name for name in names} - self.names
        for name in self._there(new):
            raise self._error(name, errno.EEXIST, "no run has written it; must be moved away")
        self.names |= new
        return bool(new)

    def results(self):
        """The files that are there of what a run leaves: run.json, history and states."""
        return [RUN_FILE, *(name for name in self._there(self.names) if name == HISTORY_FILE or _STATE.fullmatch(name))]

    def require_files(self):
        """Raise OSError where a link, or something else than a file, has taken the place of a file or folder of the list."""
        for name in (STATES_FOLDER, CHECKPOINT_FOLDER):
            if os.path.islink(self._path(name)):
                raise self._error(name, errno.EINVAL, "is a link; must be a folder")
        for name in self._there(self.names):
            require_output(self._path(name))

    def remove(self, wanted=lambda name: True):
        """Remove the files of the list whose name is wanted; recorder.npz first, without which a checkpoint is none. OSError,
        as require_files(), before one is removed."""
        self.require_files()
        for name in sorted(filter(wanted, self._there(self.names)), key=lambda name: name != RECORDER):
            os.unlink(self._path(name))

    def _there(self, names):
        """The files of these names that are there, sorted."""
        found = {name for name in names if os.path.lexists(self._path(name))}
        if _SCENES in names:
            with suppress(OSError):
                inside = os.listdir(self._path(CHECKPOINT_FOLDER))
                found |= set(filter(_SCENE.fullmatch, (f"{CHECKPOINT_FOLDER}/{name}" for name in inside)))
        return sorted(found)

    def _path(self, name):
        return os.path.join(self.folder, name)

    def _error(self, name, number, reason):
        return OSError(number, reason, self._path(name))


def _may_be_listed(name):
    return name in (HISTORY_FILE, ENDED_FILE, RECORDER, _SCENES) or bool(_STATE.fullmatch(name))
