"""Reading a run folder of runs.format: run.json, history.npz, states/NNNNNN.npz and the mark `ended`, all in SI units.

Folders of every format in READABLE are read; what an older one lacks is filled in (runs.format says with what).
Whatever is missing, damaged or foreign raises RunFolderError: one line that names the file and says what is wrong."""

import json
import re
import textwrap
from collections.abc import Sequence
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path
from types import SimpleNamespace

import numpy as np

from .files import RunFolderError, array_names, read_arrays, read_json, read_sums
from .format import (
    COLLISION,
    ENDED_FILE,
    HISTORY_FILE,
    PARAMETER_UNITS,
    READABLE,
    RUN_FILE,
    RUN_KINDS,
    SEALED,
    STATE,
    STATES_FOLDER,
    Quantity,
    RunKind,
)

LARGEST = 1e100  # of a value in SI units: squares and sums of what a run can hold are finite
WIDTH = 100  # characters of a line that a prompt shows
# The parameters that a prompt shows, as far as a run has them; those of UNLESS where they have another value than
# the scripts' default.
SHOWN = (
    *("packing", "sizes", "filling", "radius", "grains", "projectileGrains", "target", "velocity", "impact"),
    *("impactAngle", "spin", "projectileSpin", "material", "layout", "materialFraction", "surfaceEnergy"),
    *("grainRadius", "viscoelasticTime", "springDamping", "sliding", "rolling", "twisting", "neck", "finalFilling"),
    *("strainRate", "seed"),
)
UNLESS = {"sizes": "equal", "target": "aggregate", **dict.fromkeys(("sliding", "rolling", "twisting"), 1)}
UNLESS |= dict.fromkeys(("impact", "spin", "projectileSpin", "springDamping"), 0)
_STATE_NAME = re.compile(r"\d{6}\.npz")
# numpy's letters of the types that may stand for a quantity's kind, and what to call them.
_TYPES = {"f": ("fiu", "numbers"), "i": ("iu", "integers"), "b": ("biu", "true or false")}


class State(SimpleNamespace):
    """The grains at one time: an attribute for each quantity of runs.format.STATE, and of the kind of run.

    `time` is a float [s]; an optional quantity that the run does not have is None. The arrays are read-only."""

    def __init__(self, time=0.0, **arrays):  # without arguments when it is unpickled
        optional = {quantity.name: None for quantity in STATE if quantity.optional}
        super().__init__(**{**optional, "time": float(np.reshape(time, ())), **arrays})

    def __repr__(self):
        names = ", ".join(name for name, value in vars(self).items() if value is not None)
        head = f"state at {1e9 * self.time:.4g} ns: {len(self.radius)} grains, {len(self.contact_pairs)} contacts\n"
        return head + textwrap.fill(names, WIDTH, initial_indent="  ", subsequent_indent="  ")

    def fragments(self):
        """DataFrame with a row for each piece (grains joined by contacts), the largest first (runs.pieces)."""
        from .pieces import fragments  # loads pandas

        return fragments(self.position, self.radius, self.contact_pairs, self.aggregate, self.cell_size, self.mass)


class StateSequence(Sequence):
    """The states of a run, oldest first, each read from its file when it is looked up (RunFolderError if it is
    damaged).

    files: their paths; sums: as read_ended() gives them."""

    def __init__(self, files, kind=COLLISION, file_format=READABLE[-1], sums=None):
        self.files, self.kind, self.file_format, self.sums = tuple(files), kind, file_format, sums
        self._times = None

    def __len__(self):
        return len(self.files)

    def __getitem__(self, index):
        if isinstance(index, slice):
            return StateSequence(self.files[index], self.kind, self.file_format, self.sums)
        file = self.files[index]
        return read_state(file, self.kind, self.file_format, self._sum(file))

    def __repr__(self):
        return f"{len(self)} states of a {self.kind.name}"

    @property
    def times(self):
        """Time [s] (number of states,) of every state, read without the grains."""
        if self._times is None:
            quantity = [q for q in STATE if q.name == "time"]
            read = (read_quantities(f, quantity, self.file_format, self._sum(f)) for f in self.files)
            self._times = np.array([float(arrays["time"].reshape(())) for arrays in read])
            self._times.flags.writeable = False
        return self._times

    def nearest(self, time):
        """Index of the state whose time is nearest to `time` [s]."""
        return int(np.argmin(np.abs(self.times - time)))

    def _sum(self, file):
        return sum_in(self.sums, file.parent.parent, f"{STATES_FOLDER}/{file.name}")


@dataclass(frozen=True, eq=False, repr=False)
class RunFolder:
    """One run."""

    path: Path
    kind: RunKind
    parameters: dict  # as in the run's table
    derived: dict  # constants, in SI units
    record: dict  # all of run.json
    history: dict  # {name: read-only array (T,)}, as kind.history lists them
    states: StateSequence
    ended: bool  # whether it came to its planned end

    def __repr__(self):
        lines = (f"{name}: {text}" for name, text in self._facts())
        folded = (textwrap.fill(line, WIDTH, initial_indent="  ", subsequent_indent="    ") for line in lines)
        return "\n".join([f"run {self.path}", *folded])

    def _facts(self):
        """(name, text) of what a prompt shows."""
        time = self.history["time"]
        yield "kind", f"{self.kind.name}, {'ended' if self.ended else 'NOT ENDED'} at {1e9 * time[-1]:.4g} ns"
        yield "parameters", settings(self.parameters, self.derived)
        yield "history", f"{len(time)} samples of " + ", ".join(self.history)
        yield "states", f"{len(self.states)}; first and last: .start, .last"

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
        """The last state: the end of a run that ended, how far it came otherwise; RunFolderError when there is none."""
        return self._state(-1)

    def _state(self, index):
        if not self.states:
            raise RunFolderError(f"{self.path / STATES_FOLDER}: holds no state (NNNNNN.npz)")
        return self.states[index]


def settings(parameters, derived):
    """'packing cpe, velocity 10 m/s, ...': the parameters SHOWN of a run's."""
    given = ((name, shown(parameters, derived, name)) for name in SHOWN)
    return ", ".join(_setting(name, value) for name, value in given if value not in (None, "", UNLESS.get(name)))


def shown(parameters, derived, name):
    """A run's parameter, None where it has none; as surface energy of several materials a text of theirs, '0.1,0.02'
    for ice,silicate."""
    if name == "surfaceEnergy" and "," in str(parameters.get("material")):
        return ",".join(f"{own[name]:.4g}" for own in derived.get("materials", [])) or None
    return parameters.get(name)


def _setting(name, value):
    text, unit = f"{value:.6g}" if isinstance(value, float) else str(value), PARAMETER_UNITS.get(name, "")
    return f"{name} {text}" + (f" {unit}" if unit not in ("", "1") else "")


def open_run(path):
    """RunFolder of a path; a run that has not ended is read as far as it came. RunFolderError where there is no run
    folder, or it has no history yet, or is damaged."""
    path = Path(path)
    if not path.is_dir():
        raise RunFolderError(f"{path}: " + ("is not a folder" if path.exists() else "no such run folder"))
    record, sums = read_record(path)
    _require_record(path / RUN_FILE, record)
    file_format, history = record["format"], path / HISTORY_FILE
    if not history.exists():
        raise RunFolderError(f"{history}: missing: the run has recorded no history yet")
    name = str(record.get("kind", COLLISION.name))
    kind = RUN_KINDS[name] if name in RUN_KINDS else _kind_of_its_own(name, history)
    return RunFolder(
        path=path,
        kind=kind,
        parameters=record["parameters"],
        derived=record["derived"],
        record=record,
        history=_read_history(history, kind, file_format, sum_in(sums, path, HISTORY_FILE)),
        states=StateSequence(state_files(path, sums), kind, file_format, sums),
        ended=sums is not None,
    )


ALONE = RunKind("grains", ())  # without a run


def open_alone(file):
    """A RunFolder of one state, without a history: a saved state, with the parameters of the run that it is in, or a
    packing that make_packing.py wrote (at rest, in contact where grains overlap). RunFolderError for other files."""
    file, about = Path(file), {"parameters": {}, "derived": {}}
    if "contact_pairs" in array_names(file):
        state = read_state(file, ALONE)
        with suppress(RunFolderError):
            about = read_record(file.absolute().parent.parent)[0]
    else:
        state, about["parameters"] = _packing(file)
    return RunFolder(file, ALONE, about["parameters"], about["derived"], about, {}, (state,), ended=True)


def _packing(file):
    """(State, parameters) of a packing's file."""
    from scipy.spatial import cKDTree

    names = "position", "radius", "material"
    found = read_quantities(file, [quantity for quantity in STATE if quantity.name in names], READABLE[-1])
    position, radius, grains = found["position"], found["radius"], len(found["radius"])
    pairs = cKDTree(position).query_pairs(2 * radius.max(initial=0.0), output_type="ndarray")
    gaps = np.linalg.norm(np.diff(position[pairs], axis=1)[:, 0], axis=1) - radius[pairs].sum(axis=1)
    found["contact_pairs"] = pairs[gaps <= 0]
    moving, numbers = np.zeros((grains, 3)), len(found["contact_pairs"])
    state = State(
        **{"velocity": moving, "angular_velocity": moving, "aggregate": np.zeros(grains, dtype=int), **found},
        contact_normal_force=np.zeros(numbers),
        contact_bonded=np.zeros(numbers, dtype=bool),
    )
    parameters = {"grains": grains}
    with suppress(RunFolderError, ValueError):
        parameters |= json.loads(read_arrays(file, (), texts=("parameters",))["parameters"])
    if state.material is not None:
        materials = parameters.get("materials", [])
        parameters["material"] = ",".join(str(material["name"]) for material in materials)
        if len(materials) > state.material.max():
            density = np.array([float(material["density"]) for material in materials])[state.material]
            state.mass = 4 / 3 * np.pi * density * radius**3
    return state, parameters


def read_ended(path):
    """{file name: SHA-256} of what a run that has ended left in its folder (path), as its `ended` lists them; empty
    where an old format has none, None where the run has not ended; RunFolderError where `ended` is damaged."""
    file = Path(path) / ENDED_FILE
    return read_sums(file) if file.exists() else None


def sum_in(sums, path, name):
    """The SHA-256 that a file of a run folder (path) must have, None where the run has no sums; RunFolderError for a
    file that the run has not left. sums: of read_ended()."""
    if not sums:
        return None
    if name not in sums:
        raise RunFolderError(f"{Path(path) / name}: not of this run, which has left no such file; must be moved away")
    return sums[name]


def read_record(path):
    """(what run.json of a folder holds, read_ended() of it); RunFolderError when it is missing or damaged."""
    sums = read_ended(path)
    record = read_json(Path(path) / RUN_FILE, sum_in(sums, path, RUN_FILE))
    file_format = record.get("format") if isinstance(record, dict) else None
    if sums == {} and file_format in READABLE and file_format >= SEALED:
        raise RunFolderError(f"{Path(path) / ENDED_FILE}: empty; must hold the sums of the run's files")
    return record, sums


def read_state(file, kind=COLLISION, file_format=READABLE[-1], sha256=None):
    """State in one states/NNNNNN.npz; RunFolderError when it is missing, damaged or inconsistent."""
    arrays = read_quantities(Path(file), STATE, file_format, sha256)
    grains, pairs, aggregate = len(arrays["radius"]), arrays["contact_pairs"], arrays["aggregate"]
    if grains == 0:
        raise RunFolderError(f"{file}: holds no grain")
    if pairs.size and (pairs.min() < 0 or pairs.max() >= grains):
        raise RunFolderError(f"{file}: 'contact_pairs' must be of grains 0 to {grains - 1}")
    if aggregate.min() < 0 or (kind.aggregates and aggregate.max() >= kind.aggregates):
        numbers = " or ".join(map(str, range(kind.aggregates))) if kind.aggregates else "0 or more"
        raise RunFolderError(f"{file}: 'aggregate' must be {numbers} for every grain")
    return State(**arrays)


def state_files(path, sums):
    """The files of a run's states: those that the run has left, and RunFolderError where there is another one."""
    folder = path / STATES_FOLDER
    found = sorted(f for f in folder.iterdir() if _STATE_NAME.fullmatch(f.name)) if folder.is_dir() else []
    for file in found:
        sum_in(sums, path, f"{STATES_FOLDER}/{file.name}")
    if not sums:
        return found
    return [path / name for name in sorted(sums) if name.startswith(f"{STATES_FOLDER}/")]


def _require_record(file, record):
    """Raise RunFolderError unless run.json is the record of a run that can be read."""
    if not isinstance(record, dict) or "format" not in record:
        raise RunFolderError(
            f"{file}: not the record of a run: no 'format' (another program's file, or a run that has only just begun)"
        )
    if record["format"] not in READABLE:
        known = ", ".join(map(str, READABLE[:-1])) + f" and {READABLE[-1]}"
        raise RunFolderError(f"{file}: format is {record['format']!r}, this analysis reads formats {known}")
    for key in ("parameters", "derived"):
        if not isinstance(record.get(key), dict):
            raise RunFolderError(f"{file}: '{key}' is missing or not an object")


def _kind_of_its_own(name, history):
    """RunKind of a script of a user's: its series are whatever the history holds beside what every run has."""
    every = {quantity.name for quantity in RunKind(name, ()).history}
    own = sorted(set(array_names(history)) - every)
    return RunKind(name, tuple(Quantity(series, ("T",), "", "", gaps=True) for series in own))


def read_quantities(file, quantities, file_format, sha256=None):
    """The arrays of the quantities (runs.format.Quantity) by name, checked: shape, type, finite unless it may have
    gaps. Zeros stand for those that the folder's format did not have yet; optional ones may be left out."""
    expected, sizes = [q for q in quantities if q.since <= file_format], {}
    names, optional = ([q.name for q in expected if q.optional == optional] for optional in (False, True))
    arrays = read_arrays(file, names, optional, sha256=sha256)
    there = [quantity for quantity in expected if quantity.name in arrays]
    for quantity in there:  # the size of each axis, from the first array that has no other
        if len(quantity.shape) == 1 and isinstance(quantity.shape[0], str):
            sizes.setdefault(quantity.shape[0], arrays[quantity.name].size)
    for quantity in there:
        _require(file, quantity, arrays[quantity.name], sizes)
    for quantity in quantities:
        if quantity.since > file_format and not quantity.optional:
            arrays[quantity.name] = np.zeros([sizes.get(n, n) for n in quantity.shape])
            arrays[quantity.name].flags.writeable = False
    return arrays


def _require(file, quantity, array, sizes):
    """RunFolderError unless an array has a quantity's shape and type, and values that it may have; sizes: of axes."""
    name, shape, (kinds, words) = quantity.name, tuple(sizes.get(n, n) for n in quantity.shape), _TYPES[quantity.kind]
    if array.shape != shape and not (shape == () and array.size == 1):
        raise RunFolderError(f"{file}: '{name}' has the shape {array.shape}, expected {shape}")
    if array.dtype.kind not in kinds:
        raise RunFolderError(f"{file}: '{name}' must be {words}, it is {array.dtype}")
    sound = np.abs(array) < LARGEST
    if quantity.gaps:
        sound |= np.isnan(array)
    if not np.all(sound):
        where = f", first at index {int(np.argmin(sound))}" if array.ndim == 1 else ""
        what = f"beyond {LARGEST:g}" if np.isfinite(array[~sound]).all() else "not finite"
        raise RunFolderError(f"{file}: '{name}' holds a value that is {what}{where}")
    if quantity.positive and not np.all(array > 0):
        at = int(np.argmin(array > 0))
        raise RunFolderError(f"{file}: '{name}' is {array[at]:g} at index {at}; must be > 0")


def _read_history(file, kind, file_format, sha256):
    history = read_quantities(file, kind.history, file_format, sha256)
    if not history["time"].size:
        raise RunFolderError(f"{file}: 'time' is empty; must have one value or more")
    falls = np.diff(history["time"]) <= 0
    if falls.any():
        raise RunFolderError(f"{file}: 'time' does not increase everywhere, first at index {int(np.argmax(falls)) + 1}")
    return history
