"""Packings of spheres: what they are, their contacts, how far they are from touching, saving and loading."""

import json
import os
import zipfile
from dataclasses import dataclass, field
from math import sqrt

import numpy as np
from scipy.spatial import cKDTree

from analysis.measures.fragments import belongs_to_an_aggregate
from analysis.runs.files import RunFolderError, npz, read_arrays, write_file
from analysis.runs.folder import read_quantities
from analysis.runs.format import FORMAT, STATE
from yade_scripts.parameters.errors import InputError

SPHERES = [quantity for quantity in STATE if quantity.name in ("position", "radius")]


class PackingError(InputError, ValueError):
    """A packing that can't be made or read; the message is one line: what, where, what it must be."""


@dataclass(frozen=True)
class Packing:
    """position (N,3) and radius (N,) in m; the seed and parameters that the packing was made from."""

    position: np.ndarray
    radius: np.ndarray
    seed: int
    parameters: dict = field(default_factory=dict)

    @property
    def grains(self):
        return len(self.radius)


def random_stream(seed, index, *more):
    """numpy Generator of one aggregate of a seed, number index of what SeedSequence(seed).spawn() gives; more: numbers
    of independent streams of the same aggregate."""
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(index, *more)))


def centred(position, radius):
    """Positions (N,3) relative to the centre of mass of grains of one density; radius (N,)."""
    return position - np.average(position, axis=0, weights=(radius / radius.max()) ** 3)


def gyration_radius(packing):
    """r_gyr [m]: root of the mean square distance of the mass from its centre; grains of one density, as points."""
    mass = (packing.radius / packing.radius.max()) ** 3
    return float(np.sqrt(np.average((centred(packing.position, packing.radius) ** 2).sum(axis=1), weights=mass)))


def characteristic_radius(packing):
    """r_c = (5/3)^(1/2) r_gyr [m] (Mukai et al. 1992; A22 section 2.4): of a homogeneous sphere its radius."""
    return sqrt(5.0 / 3.0) * gyration_radius(packing)


def touching(position, radius, gap=0.0):
    """Pairs (M,2) of grains whose surfaces are at most `gap` [m] apart; position (N,3), radius (N,) in m."""
    pairs = cKDTree(position).query_pairs(2 * radius.max() + gap, output_type="ndarray")
    return pairs[surface_gaps(position, radius, pairs) <= gap]


def surface_gaps(position, radius, pairs):
    """Distances (M,) of the surfaces of pairs (M,2), negative where they overlap, in the unit of position and radius."""
    distance = np.linalg.norm(position[pairs[:, 0]] - position[pairs[:, 1]], axis=1)
    return distance - radius[pairs].sum(axis=1)


def contacts(packing):
    """Pairs (M,2) of touching grains, sorted, first < second: as far apart as the sum of radii, or less."""
    pairs = touching(packing.position, packing.radius)
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]


def require_apart(first, second):
    """Raise PackingError when a grain of one packing touches one of the other."""
    reach = first.radius.max() + second.radius.max()
    near = cKDTree(first.position).sparse_distance_matrix(cKDTree(second.position), reach, output_type="coo_matrix")
    overlap = first.radius[near.row] + second.radius[near.col] - near.data
    if np.any(overlap > 0):
        raise PackingError(
            f"the packings overlap: {np.count_nonzero(overlap > 0)} pairs of grains, by up to "
            f"{overlap.max():.3g} m; must be none, so put their centres further apart"
        )


def require_connected(packing):
    """Raise PackingError when it is in crumbs (fragments.belongs_to_an_aggregate), so that a collision of it has no outcome."""
    try:
        belongs_to_an_aggregate(np.zeros(packing.grains, dtype=int), contacts(packing), packing.radius**3)
    except ValueError as error:
        raise PackingError(str(error)) from None


def extent(packing):
    """Largest distance [m] of a grain's centre from the origin."""
    return np.linalg.norm(packing.position, axis=1).max()


def moved(packing, shift):
    """The same packing, every grain moved by shift (3,) [m]."""
    return Packing(packing.position + np.asarray(shift), packing.radius, packing.seed, packing.parameters)


def save(path, packing):
    """Write a packing as .npz: position (N,3), radius (N,) in m, seed, parameters (a JSON text); gyration_radius and
    characteristic_radius [m] beside them, for whoever reads the file."""
    content = npz(
        position=packing.position,
        radius=packing.radius,
        seed=packing.seed,
        parameters=json.dumps(packing.parameters),
        gyration_radius=gyration_radius(packing),
        characteristic_radius=characteristic_radius(packing),
    )
    write_file(path, content)


def is_packing(path):
    """Whether a file is one that save() wrote, be its grains right or not."""
    try:
        return zipfile.is_zipfile(path) and bool(read_arrays(path, ("seed",), texts=("parameters",)))
    except (RunFolderError, OSError):
        return False


def load(path):
    """Read a packing that save() wrote.

    Raises PackingError when the file is missing or isn't one, its arrays are not those of SPHERES, or a grain reaches the centre
    of another one.
    """
    if os.path.exists(path) and not os.path.isfile(path):
        raise PackingError(f"{path}: is no regular file; must be an .npz")
    if os.path.exists(path) and not zipfile.is_zipfile(path):
        raise PackingError(
            f"{path}: not a packing; must be an .npz that make_packing.py wrote, as from another program's file by "
            "make_packing.py a.npz from=FILE unit=um"
        )
    try:
        spheres, about = read_quantities(path, SPHERES, FORMAT), read_arrays(path, ("seed",), texts=("parameters",))
        parameters = json.loads(about["parameters"])
        if not isinstance(parameters, dict):
            raise ValueError("parameters is no JSON object")
        if not len(spheres["radius"]):
            raise ValueError("holds no grain")
        packing = Packing(**spheres, seed=int(about["seed"]), parameters=parameters)
    except (RunFolderError, ValueError, TypeError, OverflowError, RecursionError) as error:
        reason = " ".join(str(error).removeprefix(f"{path}: ").split())
        raise PackingError(
            f"{path}: not a packing ({reason}); must be an .npz with position, radius, seed, parameters"
        ) from None
    _require_apart(path, packing)
    return packing


def _require_apart(path, packing):
    """Raise PackingError when a grain reaches another one's centre; how deep contacts may be depends on the material
    (from_file.py)."""
    pairs = touching(packing.position, packing.radius, -packing.radius.min())
    overlap = -surface_gaps(packing.position, packing.radius, pairs)
    deep = np.flatnonzero(overlap >= packing.radius[pairs].min(axis=1, initial=np.inf))
    if len(deep):
        first, second = pairs[deep[0]]
        raise PackingError(
            f"{path}: grains {first} and {second} overlap by {overlap[deep[0]]:.3g} m; must be less than the smaller "
            "radius"
        )
