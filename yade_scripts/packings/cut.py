"""Compressed packings: a sphere cut out of a state of a compression in a periodic cell (as in Oshiro et al. 2025).

The recipe: a sphere whose centre is random in the cell; grains whose centre lies outside dropped, and those that are
then no longer connected with the most; a random orientation. Contacts under pressure are brought to rest by the smallest
motion of the grains that gives every contact its equilibrium overlap, so that the start is free of normal forces; a run
starts from contacts that have neither slid, rolled nor twisted.
"""

import os
from dataclasses import dataclass, field

import numpy as np
from scipy.spatial.transform import Rotation

from analysis.runs.files import RunFolderError, array_names, read_bytes
from analysis.runs.folder import read_record, read_state, sum_in
from analysis.runs.format import COMPRESSION, FORMAT
from yade_scripts.packings.largest_piece import largest_cluster
from yade_scripts.packings.packing import Packing, PackingError, random_stream
from yade_scripts.packings.rest import at_rest
from yade_scripts.parameters import NOT_NEGATIVE, POSITIVE, ParameterError, Parameters, parameter

DEEPEST = 1.05  # equilibrium overlaps that a contact may keep where all cannot be at rest together
# What contacts at rest depend on, beside the radius: a packing says it, and a run compares it with its own (from_file.py).
OF_CONTACTS = ("young", "poisson", "surfaceEnergy")


@dataclass(frozen=True)
class CutParameters(Parameters):
    """The sphere that is cut out of a state (from=RUN/states/NNNNNN.npz)."""

    radius: float | None = parameter(None, POSITIVE, "radius of the sphere that holds all centres", "grain radii")
    seed: int = parameter(1, NOT_NEGATIVE, "of its place in the cell and its orientation")


@dataclass(frozen=True)
class PeriodicState:
    """A state of a compression: position (N,3), radius (N,), contact_pairs (M,2), cell_size (3,), overlap of grains at
    rest, all in m; material: {name: value} of OF_CONTACTS, SI, as far as they are known; between walls their axis and places
    (2,) [m]."""

    position: np.ndarray
    radius: np.ndarray
    contact_pairs: np.ndarray
    cell_size: np.ndarray
    overlap: float
    material: dict = field(default_factory=dict)
    axis: int | None = None
    walls: np.ndarray | None = None


def is_periodic_state(path):
    """Whether a file is an .npz with a periodic cell, as the states of a compression are."""
    return holds(path, "cell_size")


def holds(path, name):
    """Whether a file is an .npz with an array of that name."""
    try:
        return name in array_names(path)
    except RunFolderError:
        return False


def record_of_state(path):
    """run.json of the run that RUN/states/NNNNNN.npz is of, which is as the run left it; raises RunFolderError."""
    run = os.path.dirname(os.path.dirname(os.path.abspath(path)))
    record, sums = read_record(run)
    read_bytes(path, sum_in(sums, run, os.path.relpath(path, run)))
    return record


def read_periodic_state(path):
    """PeriodicState of RUN/states/NNNNNN.npz; raises PackingError when it is none."""
    try:
        record = record_of_state(path)
        state = read_state(path, COMPRESSION, record.get("format", FORMAT))
        derived = record["derived"]
        overlap = float(derived["equilibriumOverlap"])
        material = {name: float(derived[name]) for name in OF_CONTACTS if name in derived}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, RunFolderError) as error:
        reason = " ".join(str(error).split())
        raise PackingError(
            f"from = {path}: {reason}; must be a state of a compression, RUN/states/NNNNNN.npz"
        ) from None
    if state.cell_size is None:
        raise PackingError(f"from = {path}: not of a periodic cell; must be a state of a compression")
    walls = () if state.plane_axis is None else (int(state.plane_axis[0]), np.sort(state.plane_position))
    return PeriodicState(state.position, state.radius, state.contact_pairs, state.cell_size, overlap, material, *walls)


def cut(state, parameters, index=0):
    """Aggregate number index cut out of a PeriodicState, around the origin, with what has moved among its parameters.

    parameters: CutParameters. Raises ParameterError and PackingError.
    """
    grain_radius = float(state.radius.max())
    if parameters.radius is None:
        raise ParameterError("radius: not given; must be that of the sphere to cut [grain radii]")
    room, where = state.cell_size.copy(), "cell"
    if state.walls is not None:
        room[state.axis], where = np.ptp(state.walls), "space between the walls"
    largest = float(room.min()) / 2 / grain_radius
    if parameters.radius > largest:
        raise ParameterError(
            f"radius = {parameters.radius:g}: a larger sphere than the {where} holds; must be at most {largest:.4g} "
            "[grain radii]"
        )
    stream = random_stream(parameters.seed, index)
    place = stream.uniform(0, 1, 3)
    centre = place * state.cell_size
    if state.walls is not None:  # the sphere lies between them
        reach = parameters.radius * grain_radius
        centre[state.axis] = state.walls[0] + reach + place[state.axis] * (room[state.axis] - 2 * reach)
    position = state.position - centre
    position = position - state.cell_size * np.round(position / state.cell_size)
    inside = np.flatnonzero(np.linalg.norm(position, axis=1) <= parameters.radius * grain_radius)
    pairs = _pairs_within(position, state.contact_pairs, inside)
    kept, pairs = largest_cluster(len(inside), pairs)
    if len(kept) < 2:
        raise PackingError(f"radius = {parameters.radius:g}: leaves {len(kept)} grains; must leave 2 or more")
    position, radius = position[inside[kept]], state.radius[inside[kept]]
    moved = unpressed(position, radius, pairs, grain_radius, state.overlap)
    turned = Rotation.random(random_state=stream).apply(moved - moved.mean(axis=0))
    about = dict(
        packing="compressed",
        aggregateRadius=parameters.radius * grain_radius,
        grainRadius=grain_radius,
        filling=len(kept) / parameters.radius**3,
        overlap=state.overlap,
        **state.material,
        index=index,
        dropped=len(inside) - len(kept),
        largestMotion=float(np.linalg.norm(moved - position, axis=1).max()),
    )
    return Packing(turned, radius, parameters.seed, about)


def _pairs_within(position, pairs, inside):
    """Rows (M,2) among `inside` of the contacts between those grains that do not reach across the cell."""
    row = np.full(len(position), -1)
    row[inside] = np.arange(len(inside))
    chosen = row[pairs]
    apart = np.linalg.norm(position[pairs[:, 0]] - position[pairs[:, 1]], axis=1)
    near = apart < 3 * np.median(apart) if len(apart) else np.zeros(0, bool)
    return chosen[(chosen >= 0).all(axis=1) & near]


def unpressed(position, radius, pairs, grain_radius, overlap):
    """Positions (N,3) with the contacts, pairs (M,2), of grains under pressure at rest (rest.at_rest); where they cannot all
    be, none may be deeper than DEEPEST nor apart. overlap: of two grains of grain_radius at rest; all in m."""
    rest = at_rest(position, radius, pairs, grain_radius, overlap)
    if rest.deviation.min() > -1.0 and rest.deviation.max() < DEEPEST - 1:
        return rest.position
    raise PackingError(
        f"the contacts cannot be brought to rest together: one overlaps by {1 + rest.deviation[rest.worst]:.3g} of the "
        f"equilibrium; must be at most {DEEPEST:g}: a looser state"
    )
