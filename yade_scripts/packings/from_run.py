"""Packings out of runs: a sphere cut out of a compression (Oshiro et al. 2025), the largest piece of a collision (S17).

Grains of a run's state are under pressure, or still vibrate: their contacts are brought to rest, and have
neither slid, rolled nor twisted."""

import os
from dataclasses import dataclass, field, replace
from types import SimpleNamespace

import numpy as np

from analysis.runs.files import RunFolderError, array_names, read_bytes
from analysis.runs.folder import open_run, read_record, read_state, sum_in
from analysis.runs.format import COMPRESSION, FORMAT
from yade_scripts.materials import MIXED_FACTOR, overlaps
from yade_scripts.packings import Packing, PackingError, centred, random_stream
from yade_scripts.packings.packing import OF_CONTACTS, brought_to_rest, largest_cluster, randomly_turned
from yade_scripts.parameters import NOT_NEGATIVE, POSITIVE, ParameterError, Parameters, one_line, parameter

NO_RUN = (OSError, ValueError, KeyError, TypeError, RunFolderError)  # what reading one may raise


@dataclass(frozen=True)
class CutParameters(Parameters):
    """The sphere that is cut out of a state (from=RUN/states/NNNNNN.npz)."""

    radius: float | None = parameter(None, POSITIVE, "radius of the sphere that holds all centres", "grain radii")
    seed: int = parameter(1, NOT_NEGATIVE, "of its place in the cell and its orientation")


@dataclass(frozen=True)
class PeriodicState:
    """A state of a compression; SI."""

    position: np.ndarray  # (N, 3)
    radius: np.ndarray  # (N,)
    contact_pairs: np.ndarray  # (M, 2)
    cell_size: np.ndarray  # (3,)
    overlap: float | np.ndarray  # of two grains at rest; of several materials (K, K)
    material: dict = field(default_factory=dict)  # values of OF_CONTACTS, as far as they are known, or "materials"
    axis: int | None = None  # between walls: across them
    walls: np.ndarray | None = None  # (2,), their places
    kind: np.ndarray | None = None  # (N,) which of several materials


def holds(path, name):
    """Whether a file is an .npz with an array of that name; states of a compression hold cell_size."""
    try:
        return name in array_names(path)
    except RunFolderError:
        return False


def record_of_state(path):
    """run.json of the run that RUN/states/NNNNNN.npz belongs to, if the state is as the run left it; RunFolderError."""
    run = os.path.dirname(os.path.dirname(os.path.abspath(path)))
    record, sums = read_record(run)
    read_bytes(path, sum_in(sums, run, os.path.relpath(path, run)))
    return record


def _materials_in(derived):
    """(what a packing says of its materials, overlap [m] at rest) of the constants in a run's record."""
    if not derived.get("materials"):
        known = {name: float(derived[name]) for name in OF_CONTACTS if name in derived}
        return known, float(derived["equilibriumOverlap"])
    every = {"grainRadius": derived["grainRadius"], MIXED_FACTOR: derived.get(MIXED_FACTOR, 1.0)}
    each = [SimpleNamespace(**every, **own) for own in derived["materials"]]
    return {"materials": derived["materials"]}, overlaps(each)


def read_periodic_state(path):
    """PeriodicState of RUN/states/NNNNNN.npz; raises PackingError when it is none."""
    try:
        record = record_of_state(path)
        state, derived = read_state(path, COMPRESSION, record.get("format", FORMAT)), record["derived"]
        material, overlap = _materials_in(derived)
        if state.cell_size is None:
            raise ValueError("not of a periodic cell")
    except NO_RUN as error:
        must = "must be a state of a compression, RUN/states/NNNNNN.npz"
        raise PackingError(f"from = {path}: {one_line(error)}; {must}") from None
    walls = (None, None) if state.plane_axis is None else (int(state.plane_axis[0]), np.sort(state.plane_position))
    about = overlap, material, *walls, state.material
    return PeriodicState(state.position, state.radius, state.contact_pairs, state.cell_size, *about)


def cut(state, parameters, index=0):
    """A sphere cut out of a PeriodicState, around the origin; index: of the aggregate. Its place in the cell and
    orientation are random; grains outside are dropped, and those that are then no longer connected with the most.
    Raises ParameterError and PackingError."""
    grain_radius = float(state.radius.max())
    if parameters.radius is None:
        raise ParameterError("radius: not given; must be that of the sphere to cut [grain radii]")
    reach = parameters.radius * grain_radius
    room, where = state.cell_size.copy(), "cell"
    if state.walls is not None:
        room[state.axis], where = np.ptp(state.walls), "space between the walls"
    largest = float(room.min()) / 2 / grain_radius
    if parameters.radius > largest:
        must = f"must be at most {largest:.4g} [grain radii]"
        raise ParameterError(f"radius = {parameters.radius:g}: a larger sphere than the {where} holds; {must}")
    stream = random_stream(parameters.seed, index)
    place = stream.uniform(0, 1, 3)
    centre = place * state.cell_size
    if state.walls is not None:  # the sphere lies between them
        centre[state.axis] = state.walls[0] + reach + place[state.axis] * (room[state.axis] - 2 * reach)
    position = state.position - centre
    position = position - state.cell_size * np.round(position / state.cell_size)
    inside = np.flatnonzero(np.linalg.norm(position, axis=1) <= reach)
    row = np.full(len(position), -1)
    row[inside] = np.arange(len(inside))
    pairs = state.contact_pairs
    apart = np.linalg.norm(position[pairs[:, 0]] - position[pairs[:, 1]], axis=1)
    near = apart < 3 * np.median(apart) if len(apart) else np.zeros(0, bool)  # not across the cell
    kept, pairs = largest_cluster(len(inside), row[pairs][(row[pairs] >= 0).all(axis=1) & near])
    if len(kept) < 2:
        raise PackingError(f"radius = {parameters.radius:g}: leaves {len(kept)} grains; must leave 2 or more")
    about = dict(packing="compressed", aggregateRadius=reach, filling=len(kept) / parameters.radius**3)
    about |= dict(index=index, dropped=len(inside) - len(kept))
    packing = Packing(position, state.radius, parameters.seed, state.material, state.kind).of(inside[kept], **about)
    rested = brought_to_rest(packing, grain_radius, state.overlap, pairs)
    centre = rested.position.mean(axis=0)
    return replace(rested, position=randomly_turned(rested.position - centre, stream, False))


def largest_piece_of_run(path):
    """The largest piece in the last state of a collision's run folder, at rest. Raises PackingError."""
    try:
        run = open_run(path)
        state = run.last
        (material, overlap), grain_radius = _materials_in(run.derived), float(run.derived["grainRadius"])
        if state.cell_size is not None or state.contact_bonded.any():
            raise ValueError("periodic, or with sintered bonds")
    except NO_RUN as error:
        must = "must be a run folder of a collision without bonds"
        raise PackingError(f"after = {path}: {one_line(error)}; {must}") from None
    kept, pairs = largest_cluster(len(state.radius), state.contact_pairs)
    seed, about = int(run.parameters.get("seed", 0)), {"packing": "collided", "of": len(state.radius)}
    packing = Packing(state.position, state.radius, seed, material, state.material).of(kept, **about)
    rested = brought_to_rest(packing, grain_radius, overlap, pairs)
    return replace(rested, position=centred(rested.position, rested.radius, rested.density))


def turned(packing, seed, index=0):
    """The packing in a random orientation; one in the plane z = 0 stays in it."""
    planar = not np.any(packing.position[:, 2])
    position = randomly_turned(packing.position, random_stream(seed, index), planar)
    return replace(packing, position=position, seed=seed, parameters={**packing.parameters, "index": index})
