"""Compressed packings: a sphere cut out of a state of a compression in a periodic cell (as in Oshiro et al. 2025).

The recipe: a sphere whose centre is random in the cell; grains whose centre lies outside dropped, and those that are
then no longer connected with the most; a random orientation. Contacts under pressure are brought to rest by the smallest
motion of the grains that gives every contact its equilibrium overlap, so that the start is free of normal forces; a run
starts from contacts that have neither slid, rolled nor twisted.
"""

import json
import os
from dataclasses import dataclass, field

import numpy as np
from scipy.sparse import csr_matrix
from scipy.sparse.linalg import lsqr
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from analysis.runs.arrays import RunFolderError
from analysis.runs.folder import read_state
from analysis.runs.format import COMPRESSION, FORMAT, RUN_FILE
from yade_scripts.packings.largest_piece import largest_cluster
from yade_scripts.packings.packing import Packing, PackingError, random_stream
from yade_scripts.parameters import NOT_NEGATIVE, POSITIVE, ParameterError, Parameters, parameter

AT_REST = 1e-3  # of the equilibrium overlap: contacts closer to it are at rest
DEEPEST = 1.05  # equilibrium overlaps that a contact may keep where all cannot be at rest together
MOST_MOVES = 20
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
    rest, all in m; material: {name: value} of OF_CONTACTS, SI, as far as they are known."""

    position: np.ndarray
    radius: np.ndarray
    contact_pairs: np.ndarray
    cell_size: np.ndarray
    overlap: float
    material: dict = field(default_factory=dict)


def read_periodic_state(path):
    """PeriodicState of RUN/states/NNNNNN.npz; raises PackingError when it is none."""
    run = os.path.join(os.path.dirname(os.path.dirname(os.path.abspath(path))), RUN_FILE)
    try:
        with open(run) as file:
            record = json.load(file)
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
    return PeriodicState(state.position, state.radius, state.contact_pairs, state.cell_size, overlap, material)


def cut(state, parameters, index=0):
    """Aggregate number index cut out of a PeriodicState, around the origin, with what has moved among its parameters.

    parameters: CutParameters. Raises ParameterError and PackingError.
    """
    grain_radius = float(state.radius.max())
    if parameters.radius is None:
        raise ParameterError("radius: not given; must be that of the sphere to cut [grain radii]")
    largest = float(state.cell_size.min()) / 2 / grain_radius
    if parameters.radius > largest:
        raise ParameterError(
            f"radius = {parameters.radius:g}: a larger sphere than the cell holds; must be at most {largest:.4g} "
            "[grain radii]"
        )
    stream = random_stream(parameters.seed, index)
    centre = stream.uniform(0, 1, 3) * state.cell_size
    position = state.position - centre
    position = position - state.cell_size * np.round(position / state.cell_size)
    inside = np.flatnonzero(np.linalg.norm(position, axis=1) <= parameters.radius * grain_radius)
    pairs = _pairs_within(position, state.contact_pairs, inside)
    kept, pairs = largest_cluster(len(inside), pairs)
    if len(kept) < 2:
        raise PackingError(f"radius = {parameters.radius:g}: leaves {len(kept)} grains; must leave 2 or more")
    position, radius = position[inside[kept]], state.radius[inside[kept]]
    moved = at_rest(position, radius, pairs, state.overlap)
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


def at_rest(position, radius, pairs, overlap):
    """Positions with every contact at its equilibrium overlap, by the smallest motion (Newton's method on the distances);
    grains that come to overlap on the way are contacts too."""
    moved = position.copy()
    for _ in range(MOST_MOVES):
        overlapping = cKDTree(moved).query_pairs(2 * radius.max(), output_type="ndarray")
        deep = np.linalg.norm(moved[overlapping[:, 0]] - moved[overlapping[:, 1]], axis=1)
        overlapping = overlapping[deep < radius[overlapping].sum(axis=1)]
        pairs = np.unique(np.sort(np.concatenate([pairs, overlapping]), axis=1), axis=0)
        separation = moved[pairs[:, 0]] - moved[pairs[:, 1]]
        distance = np.linalg.norm(separation, axis=1)
        error = radius[pairs].sum(axis=1) - overlap - distance
        if np.abs(error).max() < AT_REST * overlap:
            return moved
        moved = moved + _smallest_motion(separation / distance[:, None], pairs, error, len(radius))
    if error.max() > -overlap and -error.min() < (DEEPEST - 1) * overlap and error.max() < overlap:
        return moved
    raise PackingError(
        f"the contacts cannot be brought to rest together: one overlaps by {1 - error.min() / overlap:.3g} of the "
        f"equilibrium; must be at most {DEEPEST:g}: a looser state"
    )


def _smallest_motion(normal, pairs, change, grains):
    """Motion (N,3) of least length that changes the distances of pairs (M,2) by change (M,), to first order."""
    contacts = np.repeat(np.arange(len(pairs)), 3)
    axes = np.tile(np.arange(3), len(pairs))
    columns = [3 * np.repeat(pairs[:, side], 3) + axes for side in (0, 1)]
    data = np.concatenate([normal.ravel(), -normal.ravel()])
    rows = np.concatenate([contacts, contacts])
    matrix = csr_matrix((data, (rows, np.concatenate(columns))), shape=(len(pairs), 3 * grains))
    return lsqr(matrix, change, atol=1e-9, btol=1e-9, iter_lim=20 * grains)[0].reshape(-1, 3)
