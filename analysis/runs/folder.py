"""Reading a run folder of runs.format: run.json, history.npz, states/NNNNNN.npz and the mark `ended`, all in SI units.

Folders of every format in READABLE are read; what an older one lacks is filled in (runs.format says with what).
Whatever is missing, damaged or foreign raises RunFolderError: one line that names the file and says what is wrong."""

import json
import re
import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Mapping

import numpy as np

from ..arguments import Kind, PATH, WrongArgument, number, shown, takes
from .arrays import RunFolderError, array_names, read_arrays, read_quantities, require_values
from .format import (
    COLLISION,
    HISTORY_FILE,
    POSITIVE_CONSTANTS,
    READABLE,
    RUN_FILE,
    RUN_KINDS,
    STATE,
    STATES_FOLDER,
    Quantity,
    RunKind,
)
from .named import Named, protect, unknown
from .seal import NO_SUMS, Seal, read_seal, read_text, require_sealed

_STATE_NAME = re.compile(r"\d{6}\.npz")


class State:
    """The grains at one time: an attribute for each quantity of runs.format.STATE, and of the kind of run; `time` is a
    float [s], an optional one that the run does not have is None. The arrays are read-only.

    fragments() has a row for each piece."""

    def __init__(self, time, **arrays):
        optional = {quantity.name: None for quantity in STATE if quantity.optional}
        self.__dict__.update({**optional, "time": float(np.reshape(time, ())), **arrays})

    def __setattr__(self, name, value):
        raise AttributeError(f"a state cannot be changed ({name})")

    def __getattr__(self, name):
        if name.startswith("_"):  # what copying and notebooks ask every object for
            raise AttributeError(name)
        raise unknown("state", name, vars(self))

    def __setstate__(self, values):
        self.__dict__.update(values)
        protect(values)

    def __repr__(self):
        from .shown import state_text

        return state_text(self)

    def fragments(self):
        """DataFrame with a row for each piece (grains joined by contacts), the largest first: measures.fragments.fragments."""
        from ..measures.fragments import fragments

        return fragments(self.position, self.radius, self.contact_pairs, self.aggregate, self.cell_size)


class StateSequence(Sequence):
    """The states of a run, oldest first, each read from its file when it is asked for (RunFolderError if it is
    damaged, or not that of which the Seal has a sum)."""

    def __init__(self, files, kind=COLLISION, file_format=READABLE[-1], seal=None):
        self.files, self.kind, self.file_format, self.seal = tuple(files), kind, file_format, seal
        self._times = None

    def __len__(self):
        return len(self.files)

    def __getitem__(self, index):
        if isinstance(index, slice):
            return StateSequence(self.files[index], self.kind, self.file_format, self.seal)
        return read_state(self._checked(self._file(index)), self.kind, self.file_format)

    def __repr__(self):
        return f"{len(self)} states of a {self.kind.name}"

    @property
    def times(self):
        """Time [s] (number of states,) of every state, read without the grains."""
        if self._times is None:
            quantity = [q for q in STATE if q.name == "time"]
            files = map(self._checked, self.files)
            times = [float(read_quantities(f, quantity, self.file_format)["time"].reshape(())) for f in files]
            self._times = np.array(times)
            self._times.flags.writeable = False
        return self._times

    def nearest(self, time):
        """Index of the state whose time is nearest to `time` [s]."""
        number().require("time", time, {})
        return int(np.argmin(np.abs(self.times - time)))

    def arrays(self, index, names):
        """Some arrays of a state by name, without reading the others; their values are checked, not their shapes."""
        arrays = read_arrays(self._checked(self._file(index)), names)
        for quantity in (quantity for quantity in self.kind.states if quantity.name in arrays):
            require_values(self.files[index], quantity, arrays[quantity.name])
        return arrays

    def _file(self, index):
        if not isinstance(index, (int, np.integer)):
            raise WrongArgument(f"state {shown(index)}: must be a whole number, or a slice")
        if not -len(self) <= index < len(self):
            must = f"{-len(self)} to {len(self) - 1}" if self.files else "of a run that has left one"
            raise IndexError(f"no state {index}: must be {must}")
        return self.files[index]

    def _checked(self, file):
        if self.seal:
            self.seal.require(f"{STATES_FOLDER}/{file.name}")
        return file


@dataclass(frozen=True, eq=False, repr=False)
class RunFolder:
    """One run: path, kind (runs.format.RunKind), parameters (as in the run's table), derived (constants, SI), record
    (all of run.json), history (arrays (T,) by name, as listed in kind.history), states, ended (came to its planned
    end)."""

    path: Path
    kind: RunKind
    parameters: Mapping
    derived: Mapping
    record: Mapping
    history: Mapping
    states: StateSequence
    ended: bool

    def __repr__(self):
        from .shown import run_text

        return run_text(self)

    def _repr_html_(self):
        from .shown import run_html

        return run_html(self)

    @property
    def settled(self):
        """The parameters (dict); one that was left open and that the run derived has that value."""
        return {name: self.derived.get(name) if value is None else value for name, value in self.parameters.items()}

    @property
    def start(self):
        """The first state; RunFolderError when the run has left none."""
        return self._state(0)

    @property
    def last(self):
        """The last state: the end of a run that ended, how far it came otherwise; RunFolderError when there is
        none."""
        return self._state(-1)

    def _state(self, index):
        if not self.states:
            raise RunFolderError(f"{self.path / STATES_FOLDER}: holds no state (NNNNNN.npz)")
        return self.states[index]


@takes(path=Kind("the path of a run folder", PATH.is_right))
def open_run(path):
    """RunFolder at `path`; RunFolderError when it is no run folder, has no history yet, or is damaged.

    A run that has not ended can be read as far as it came (`ended` is False then).
    """
    path = Path(path)
    if not path.is_dir():
        raise RunFolderError(f"{path}: " + ("is not a folder" if path.exists() else "no such run folder"))
    record, seal = read_record(path)
    _require_record(path / RUN_FILE, record)
    file_format, history = record["format"], path / HISTORY_FILE
    if not history.exists():
        raise RunFolderError(f"{history}: missing: the run has recorded no history yet")
    if seal:
        seal.require(HISTORY_FILE)
        if not seal.files:
            warnings.warn(NO_SUMS, stacklevel=1)
    name = record.get("kind", COLLISION.name)
    kind = RUN_KINDS[name] if name in RUN_KINDS else _kind_of_its_own(name, history)
    return RunFolder(
        path=path,
        kind=kind,
        parameters=Named(f"parameters of {path}", record["parameters"]),
        derived=Named(f"derived constants of {path}", record["derived"]),
        record=Named(f"{path / RUN_FILE}", record),
        history=Named(f"history of {path}", _read_history(history, kind, file_format)),
        states=StateSequence(state_files(path, seal), kind, file_format, seal),
        ended=seal is not None,
    )


def read_record(path):
    """(what run.json of a folder holds, Seal or None where the run has not ended); RunFolderError when it is missing, damaged, or not that of
    which the Seal has a sum."""
    seal = read_seal(path)
    if seal:
        seal.require(RUN_FILE)
    record = read_json(Path(path) / RUN_FILE)
    if isinstance(record, dict) and record.get("format") in READABLE:
        require_sealed(seal, record["format"])
    return record, seal


def read_state(file, kind=COLLISION, file_format=READABLE[-1]):
    """State in one states/NNNNNN.npz; RunFolderError when it is missing, damaged or inconsistent."""
    arrays = read_quantities(Path(file), kind.states, file_format)
    grains, pairs, aggregate = len(arrays["radius"]), arrays["contact_pairs"], arrays["aggregate"]
    if grains == 0:
        raise RunFolderError(f"{file}: holds no grain")
    if pairs.size and (pairs.min() < 0 or pairs.max() >= grains):
        raise RunFolderError(
            f"{file}: 'contact_pairs' names grain {pairs.max() if pairs.min() >= 0 else pairs.min()}, "
            f"there are grains 0 to {grains - 1}"
        )
    _require_on_planes(file, arrays)
    if aggregate.min() < 0 or (kind.aggregates and aggregate.max() >= kind.aggregates):
        numbers = " or ".join(map(str, range(kind.aggregates))) if kind.aggregates else "0 or more"
        raise RunFolderError(f"{file}: 'aggregate' must be {numbers} for every grain")
    return State(**arrays)


def _require_on_planes(file, arrays):
    if "plane_contacts" not in arrays:
        return
    for column, (what, quantity) in enumerate((("grain", "radius"), ("plane", "plane_axis"))):
        rows, there = arrays["plane_contacts"][:, column], len(arrays.get(quantity, ()))
        if rows.size and (rows.min() < 0 or rows.max() >= there):
            raise RunFolderError(f"{file}: 'plane_contacts' names a {what} that is not there, of {there}")


def state_files(path, seal):
    """The files of a run's states: with sums those that it has left, and RunFolderError where there is another one."""
    folder = path / STATES_FOLDER
    found = sorted(f for f in folder.iterdir() if _STATE_NAME.fullmatch(f.name)) if folder.is_dir() else []
    if not (seal and seal.files):
        return found
    names = [f"{STATES_FOLDER}/{file.name}" for file in found]
    for name in names:
        if name not in seal.files:
            seal.require(name)
    return found if names == seal.states else [path / name for name in seal.states]


def _require_record(file, record):
    """Raise RunFolderError unless run.json is the record of a run that can be read."""
    if not isinstance(record, dict) or "format" not in record:
        raise RunFolderError(
            f"{file}: not the record of a run: no 'format' (another program's file, or a run that has only just begun)"
        )
    if record["format"] not in READABLE:
        known = ", ".join(map(str, READABLE[:-1])) + f" and {READABLE[-1]}"
        raise RunFolderError(f"{file}: format is {record['format']!r}, this analysis reads formats {known}")
    if not isinstance(record.get("kind", ""), str):
        raise RunFolderError(f"{file}: kind is {record['kind']!r}: must be a name, such as {COLLISION.name}")
    for key in ("parameters", "derived"):
        if not isinstance(record.get(key), dict):
            raise RunFolderError(f"{file}: '{key}' is missing or not an object")
    for key in POSITIVE_CONSTANTS:
        value = record["derived"].get(key)
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not value > 0:
            raise RunFolderError(f"{file}: derived '{key}' must be a positive number, it is {value!r}")


def _kind_of_its_own(name, history):
    """RunKind of a script of a user's: its series are whatever the history holds beside what every run has."""
    every = {quantity.name for quantity in RunKind(name, ()).history}
    own = sorted(set(array_names(history)) - every)
    return RunKind(name, tuple(Quantity(series, ("T",), "", "", gaps=True) for series in own))


def read_json(file):
    """What a JSON file holds; RunFolderError when it is missing, is no regular file, or no JSON (NaN and Infinity are
    none)."""
    text = read_text(file)
    if text is None:
        raise RunFolderError(f"{file}: missing, so this is not a run folder")
    try:
        return json.loads(text, parse_constant=_refuse_constant)
    except RecursionError:
        raise RunFolderError(f"{file}: not valid JSON: nested too deeply") from None
    except ValueError as error:
        raise RunFolderError(f"{file}: not valid JSON: {error}") from None


def _refuse_constant(text):
    raise ValueError(f"{text} is no number of JSON")


def _read_history(file, kind, file_format):
    time = read_arrays(file, ("time",))["time"]
    if time.ndim != 1 or time.size == 0:
        raise RunFolderError(f"{file}: 'time' must be a non-empty one-dimensional array, its shape is {time.shape}")
    history = read_quantities(file, kind.history, file_format)
    falls = np.diff(history["time"]) <= 0
    if falls.any():
        raise RunFolderError(f"{file}: 'time' does not increase everywhere, first at index {int(np.argmax(falls)) + 1}")
    return history
