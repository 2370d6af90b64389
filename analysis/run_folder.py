"""Reading a run folder: run.json, history.npz, states/NNNNNN.npz and the mark `ended`, all in SI units.

Whatever is missing, damaged or foreign raises RunFolderError: one line that names the file and says what is
wrong with it."""

import json
import re
import zipfile
import zlib
from collections.abc import Sequence
from dataclasses import dataclass, fields
from pathlib import Path
from types import MappingProxyType
from typing import Mapping

import numpy as np

from .channels import CHANNELS

FORMAT = 1
HISTORY_ARRAYS = ("time",) + CHANNELS + ("d", "v", "contacts", "contacts_between")
# Derived constants that the analysis divides by, or that a figure's units rest on.
POSITIVE_CONSTANTS = ("grainRadius", "pullOffForce")
_STATE_NAME = re.compile(r"\d{6}\.npz")


class RunFolderError(Exception):
    """A run folder that cannot be analysed; the message is one line: which file, and what is wrong."""


@dataclass(frozen=True, eq=False)
class State:
    """The grains at one time [s]: position (N,3) [m], velocity (N,3) [m/s], angular_velocity (N,3) [rad/s],
    radius (N,) [m], aggregate (N,) int (0 or 1), contact_pairs (M,2) int (rows of the grains),
    contact_normal_force (M,) [N] (positive = repulsive), contact_bonded (M,) bool. The arrays are
    read-only."""

    time: float
    position: np.ndarray
    velocity: np.ndarray
    angular_velocity: np.ndarray
    radius: np.ndarray
    aggregate: np.ndarray
    contact_pairs: np.ndarray
    contact_normal_force: np.ndarray
    contact_bonded: np.ndarray


class StateSequence(Sequence):
    """The states of a run, oldest first, each read from its file when it is asked for (RunFolderError if it
    is damaged)."""

    def __init__(self, files):
        self.files = tuple(files)
        self._times = None

    def __len__(self):
        return len(self.files)

    def __getitem__(self, index):
        if isinstance(index, slice):
            return StateSequence(self.files[index])
        return read_state(self.files[index])

    @property
    def times(self):
        """Time [s] (number of states,) of every state, read without the grains."""
        if self._times is None:
            times = [float(_scalar(read_arrays(f, ("time",))["time"], "time", f)) for f in self.files]
            self._times = np.array(times)
            self._times.flags.writeable = False
        return self._times

    def nearest(self, time):
        """Index of the state whose time is nearest to `time` [s]."""
        return int(np.argmin(np.abs(self.times - time)))


@dataclass(frozen=True, eq=False)
class RunFolder:
    """One run: path, parameters (as in the run's table), derived (constants, SI), record (all of run.json),
    history (arrays (T,) by name: time [s], the channels [J], d [m], v [m/s], contacts, contacts_between; d
    and v are NaN while all grains are on one side), states, ended (came to its end)."""

    path: Path
    parameters: Mapping
    derived: Mapping
    record: Mapping
    history: Mapping
    states: StateSequence
    ended: bool

    @property
    def start(self):
        """The first state; RunFolderError when the run has left none."""
        return self._state(0)

    @property
    def last(self):
        """The last state: the end of a run that ended, how far it came otherwise; RunFolderError when there
        is none."""
        return self._state(-1)

    def _state(self, index):
        if not self.states:
            raise RunFolderError(f"{self.path / 'states'}: holds no state (NNNNNN.npz)")
        return self.states[index]


def open_run(path):
    """RunFolder at `path`; RunFolderError when it is no run folder, has no history yet, or is damaged.

    A run that has not ended can be read as far as it came (`ended` is False then).
    """
    path = Path(path)
    if not path.is_dir():
        raise RunFolderError(f"{path}: " + ("is not a folder" if path.exists() else "no such run folder"))
    record = _read_record(path / "run.json")
    return RunFolder(
        path=path,
        parameters=MappingProxyType(record["parameters"]),
        derived=MappingProxyType(record["derived"]),
        record=MappingProxyType(record),
        history=MappingProxyType(_read_history(path / "history.npz")),
        states=StateSequence(_state_files(path / "states")),
        ended=(path / "ended").is_file(),
    )


def _read_record(file):
    try:
        record = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise RunFolderError(f"{file}: missing, so this is not a run folder") from None
    except OSError as error:
        raise RunFolderError(f"{file}: cannot be read: {error.strerror}") from None
    except ValueError as error:
        raise RunFolderError(f"{file}: not valid JSON: {error}") from None
    if not isinstance(record, dict) or "format" not in record:
        raise RunFolderError(
            f"{file}: not the record of a run: no 'format' (another program's file, or "
            "a run that has only just begun)"
        )
    if record["format"] != FORMAT:
        raise RunFolderError(f"{file}: format is {record['format']!r}, this analysis reads format {FORMAT}")
    for key in ("parameters", "derived"):
        if not isinstance(record.get(key), dict):
            raise RunFolderError(f"{file}: '{key}' is missing or not an object")
    for key in POSITIVE_CONSTANTS:
        value = record["derived"].get(key)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not value > 0:
            raise RunFolderError(f"{file}: derived '{key}' must be a positive number, it is {value!r}")
    return record


def _read_history(file):
    if not file.exists():
        raise RunFolderError(f"{file}: missing: the run has recorded no history yet")
    history = read_arrays(file, HISTORY_ARRAYS)
    shape = history["time"].shape
    if len(shape) != 1 or shape[0] == 0:
        raise RunFolderError(f"{file}: 'time' must be a non-empty one-dimensional array, its shape is {shape}")
    for name, array in history.items():
        _require_shape(file, name, array, shape)
        # d and v (A24 eqs 10-13) have no value while all grains are on one side of x = 0.
        if name not in ("d", "v") and not np.all(np.isfinite(array)):
            raise RunFolderError(
                f"{file}: '{name}' holds a value that is not finite, first at index "
                f"{int(np.argmin(np.isfinite(array)))}"
            )
    if np.any(np.diff(history["time"]) <= 0):
        raise RunFolderError(
            f"{file}: 'time' does not increase everywhere, first at index "
            f"{int(np.argmax(np.diff(history['time']) <= 0)) + 1}"
        )
    return history


def _state_files(folder):
    if not folder.is_dir():
        return []
    return sorted(f for f in folder.iterdir() if _STATE_NAME.fullmatch(f.name))


def read_state(file):
    """State in one states/NNNNNN.npz; RunFolderError when it is missing, damaged or inconsistent."""
    file = Path(file)
    if not file.exists():
        raise RunFolderError(f"{file}: missing")
    arrays = read_arrays(file, [field.name for field in fields(State)])
    grains, contacts = arrays["radius"].size, arrays["contact_normal_force"].size
    for name in ("position", "velocity", "angular_velocity"):
        _require_shape(file, name, arrays[name], (grains, 3))
    for name, size in (
        ("radius", grains),
        ("aggregate", grains),
        ("contact_normal_force", contacts),
        ("contact_bonded", contacts),
    ):
        _require_shape(file, name, arrays[name], (size,))
    _require_shape(file, "contact_pairs", arrays["contact_pairs"], (contacts, 2))
    _require_contents(file, arrays, grains)
    return State(float(_scalar(arrays.pop("time"), "time", file)), **arrays)


def _require_contents(file, arrays, grains):
    if grains == 0:
        raise RunFolderError(f"{file}: holds no grain")
    for name in ("position", "velocity", "radius"):
        if not np.all(np.isfinite(arrays[name])):
            raise RunFolderError(f"{file}: '{name}' holds a value that is not finite")
    pairs = arrays["contact_pairs"]
    if not np.issubdtype(pairs.dtype, np.integer):
        raise RunFolderError(f"{file}: 'contact_pairs' must be integers, it is {pairs.dtype}")
    if pairs.size and (pairs.min() < 0 or pairs.max() >= grains):
        raise RunFolderError(
            f"{file}: 'contact_pairs' names grain {pairs.max() if pairs.min() >= 0 else pairs.min()}, "
            f"there are grains 0 to {grains - 1}"
        )
    if not np.all(np.isin(arrays["aggregate"], (0, 1))):
        raise RunFolderError(f"{file}: 'aggregate' must be 0 or 1 for every grain")


def read_arrays(file, names):
    """The named arrays of an .npz file (a history's or a state's), read-only; RunFolderError when the file or an
    array is missing or damaged."""
    try:
        archive = np.load(file, allow_pickle=False)
        if isinstance(archive, np.ndarray):
            raise RunFolderError(f"{file}: damaged, or not an .npz file: it holds a single array")
        with archive:
            absent = [name for name in names if name not in archive.files]
            if absent:
                raise RunFolderError(f"{file}: lacks the array " + ", ".join(f"'{name}'" for name in absent))
            arrays = {name: archive[name] for name in names}
    except (OSError, ValueError, EOFError, AttributeError, zipfile.BadZipFile, zlib.error) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise RunFolderError(f"{file}: damaged, or not an .npz file: {reason}") from None
    for name, array in arrays.items():
        if array.dtype.kind not in "biuf":
            raise RunFolderError(f"{file}: '{name}' must hold numbers, it holds {array.dtype}")
        array.flags.writeable = False
    return arrays


def _require_shape(file, name, array, shape):
    if array.shape != shape:
        raise RunFolderError(f"{file}: '{name}' has the shape {array.shape}, expected {shape}")


def _scalar(array, name, file):
    if array.size != 1:
        raise RunFolderError(f"{file}: '{name}' must be one number, its shape is {array.shape}")
    return array.reshape(())
