"""Packings of equal spheres by close packing and extraction (CPE), as in A24 section 3.

Needs numpy and scipy only. The recipe: a face-centred cubic lattice whose neighbours overlap by the
equilibrium overlap (so that the start is force-free), a sphere whose centre is random within the lattice's
unit cell, every grain whose centre lies outside dropped, grains removed at random until N = filling (R/r)^3
are left, a random orientation. Planar ones likewise: a hexagonal lattice, a circle, N = filling (R/r)^2.
"""

import json
import zipfile
from dataclasses import dataclass, field
from math import ceil, pi, sqrt

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from yade_scripts.atomic_write import write_atomically

FCC_BASIS = np.array([[0, 0, 0], [0, 0.5, 0.5], [0.5, 0, 0.5], [0.5, 0.5, 0]])  # in edges of the cubic cell


class PackingError(ValueError):
    """A packing that can't be made or read; the message is one line: what, where, what is allowed."""


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


def maximum_filling(grain_radius, overlap, planar=False):
    """Filling factor of the whole lattice, pi/(3 sqrt 2) [2r/(2r-overlap)]^3 (A24 eq 40); lengths in m.

    planar: share of the area, pi/(2 sqrt 3) [2r/(2r-overlap)]^2.
    """
    if planar:
        return pi / (2 * sqrt(3)) * (2 * grain_radius / (2 * grain_radius - overlap)) ** 2
    return pi / (3 * sqrt(2)) * (2 * grain_radius / (2 * grain_radius - overlap)) ** 3


def grain_number(filling, relative_radius, planar=False):
    """N = filling (R/r)^3, rounded (A24 section 3), or filling (R/r)^2 in a plane; relative_radius = R/r."""
    return round(filling * relative_radius ** (2 if planar else 3))


def random_stream(seed, index):
    """numpy Generator of one aggregate of a seed, number index of what SeedSequence(seed).spawn() gives."""
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(index,)))


def cpe(filling, aggregate_radius, grain_radius, overlap, seed, index=0, planar=False):
    """A close-packed and extracted aggregate around the origin (A24 section 3); planar: in the plane z = 0.

    filling: N = filling (aggregate_radius/grain_radius)^3, squared when planar; aggregate_radius: of the sphere
    (circle) that holds all centres [m]; grain_radius, overlap (of neighbours in the lattice) in m. The packing is
    a function of these and (seed, index). Raises PackingError when the lattice doesn't hold that many grains.
    """
    limit = maximum_filling(grain_radius, overlap, planar)
    if filling > limit:
        raise PackingError(
            f"filling = {filling:g}: more than the lattice holds; " f"allowed: at most {limit:.4f} (A24 eq 40)"
        )
    wanted = grain_number(filling, aggregate_radius / grain_radius, planar)
    stream = random_stream(seed, index)
    lattice = _lattice_in_circle if planar else _lattice_in_sphere
    sites = lattice(2 * grain_radius - overlap, aggregate_radius, stream)
    if wanted > len(sites):
        at_most = len(sites) * (grain_radius / aggregate_radius) ** (2 if planar else 3)
        raise PackingError(
            f"filling = {filling:g}: asks for {wanted} grains, but the lattice has "
            f"{len(sites)} in this sphere (seed {seed}, aggregate {index}); allowed here: "
            f"at most {at_most:.4f}, for large spheres {limit:.4f} (A24 eq 40)"
        )
    kept = np.sort(stream.choice(len(sites), wanted, replace=False, shuffle=False))
    turn = Rotation.from_rotvec([0, 0, stream.uniform(0, 2 * pi)]) if planar else Rotation.random(random_state=stream)
    position = turn.apply(sites[kept]) * (1, 1, 0 if planar else 1)
    return Packing(
        position,
        np.full(wanted, float(grain_radius)),
        seed,
        dict(
            packing="cpe",
            filling=filling,
            aggregateRadius=aggregate_radius,
            grainRadius=grain_radius,
            overlap=overlap,
            index=index,
            **({"planar": 1} if planar else {}),
        ),
    )


def _lattice_in_circle(spacing, circle_radius, stream):
    """Sites (N,3), z = 0, of a hexagonal lattice in a circle, relative to its centre, which is random."""
    steps = spacing * np.array([[1, 0, 0], [0.5, sqrt(3) / 2, 0]])
    reach = ceil(2 / sqrt(3) * circle_radius / spacing) + 2
    cells = np.stack(np.meshgrid(*2 * [np.arange(-reach, reach + 1)], indexing="ij"), axis=-1).reshape(-1, 2)
    sites = (cells - stream.uniform(0, 1, 2)) @ steps
    return sites[np.einsum("ij,ij->i", sites, sites) <= circle_radius**2]


def _lattice_in_sphere(spacing, sphere_radius, stream):
    """Sites (N,3) of a face-centred cubic lattice in a sphere, relative to its centre, which is random."""
    edge = sqrt(2) * spacing
    centre = stream.uniform(0, edge, 3)
    reach = ceil(sphere_radius / edge) + 1
    edges = np.arange(-reach, reach + 1)
    layer = np.stack(np.meshgrid([0], edges, edges, indexing="ij"), axis=-1).reshape(-1, 1, 3) + FCC_BASIS
    layer = layer.reshape(-1, 3) * edge - centre
    inside = []
    for shift in edges * edge:  # by layers, for the memory: the box has twice the sphere's sites
        sites = layer + (shift, 0, 0)
        inside.append(sites[np.einsum("ij,ij->i", sites, sites) <= sphere_radius**2])
    return np.concatenate(inside)


def contacts(packing):
    """Pairs (M,2) of touching grains, sorted, first < second: as far apart as the sum of radii, or less."""
    tree = cKDTree(packing.position)
    pairs = tree.query_pairs(2 * packing.radius.max(), output_type="ndarray")
    distance = np.linalg.norm(packing.position[pairs[:, 0]] - packing.position[pairs[:, 1]], axis=1)
    touching = pairs[distance <= packing.radius[pairs].sum(axis=1)]
    return touching[np.lexsort((touching[:, 1], touching[:, 0]))]


def require_apart(first, second):
    """Raise PackingError when a grain of one packing touches one of the other."""
    reach = first.radius.max() + second.radius.max()
    near = cKDTree(first.position).sparse_distance_matrix(cKDTree(second.position), reach, output_type="coo_matrix")
    overlap = first.radius[near.row] + second.radius[near.col] - near.data
    if np.any(overlap > 0):
        raise PackingError(
            f"the packings overlap: {np.count_nonzero(overlap > 0)} pairs of grains, by up to "
            f"{overlap.max():.3g} m; allowed: none, so put their centres further apart"
        )


def moved(packing, shift):
    """The same packing, every grain moved by shift (3,) [m]."""
    return Packing(packing.position + np.asarray(shift), packing.radius, packing.seed, packing.parameters)


def save(path, packing):
    """Write a packing as .npz: position (N,3), radius (N,) in m, seed, parameters (a JSON text)."""
    write_atomically(
        path,
        lambda file: np.savez(
            file,
            position=packing.position,
            radius=packing.radius,
            seed=packing.seed,
            parameters=json.dumps(packing.parameters),
        ),
    )


def load(path):
    """Read a packing that save() wrote; raises PackingError when the file is missing or isn't one."""
    try:
        with np.load(path) as file:
            return Packing(file["position"], file["radius"], int(file["seed"]), json.loads(str(file["parameters"])))
    except (OSError, KeyError, ValueError, zipfile.BadZipFile) as error:
        reason = " ".join(str(error).split())
        raise PackingError(
            f"{path}: not a packing ({reason}); expected an .npz with position, radius, seed, " "parameters"
        ) from None
