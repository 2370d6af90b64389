"""Packings of spheres: their contacts, sizes and pieces. Lengths in m; files.py saves and loads them."""

from dataclasses import dataclass, field, replace
from math import sqrt

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from analysis.measures.fragments import belongs_to_an_aggregate, fragment_labels
from analysis.measures.structure import fractal_dimension, grains_within, mean_coordination
from yade_scripts.parameters.errors import InputError

NEAREST = 3.0  # grain radii: nearer than that numbers of grains depend on contacts
ORIGINS = 2000  # grains from which the fractal dimension is taken
AT_REST = 1e-3  # of the equilibrium overlap: contacts closer to it are at rest


class PackingError(InputError, ValueError):
    """A packing that can't be made or read; the message is one line: what, where, what it must be."""


@dataclass(frozen=True)
class Packing:
    """Spheres."""

    position: np.ndarray  # (N, 3), centres [m]
    radius: np.ndarray  # (N,) [m]
    seed: int
    parameters: dict = field(default_factory=dict)  # what the packing was made from

    @property
    def grains(self):
        return len(self.radius)


def random_stream(seed, index, *more):
    """numpy Generator of aggregate number index of a seed; more: numbers of independent streams of the aggregate."""
    return np.random.default_rng(np.random.SeedSequence(seed, spawn_key=(index, *more)))


def centred(position, radius):
    """Positions (N, 3) relative to the centre of mass of grains of one density and these radii (N,)."""
    return position - np.average(position, axis=0, weights=(radius / radius.max()) ** 3)


def randomly_turned(position, stream, planar):
    """Positions (N, 3) in a random orientation; planar: those in the plane z = 0, which stay there."""
    if planar:
        return Rotation.from_rotvec([0, 0, stream.uniform(0, 2 * np.pi)]).apply(position) * (1, 1, 0)
    return Rotation.random(random_state=stream).apply(position)


def moved(packing, shift):
    """The same packing, every grain moved by shift (3,) [m]."""
    return replace(packing, position=packing.position + np.asarray(shift))


def extent(packing):
    """Largest distance [m] of a grain's centre from the origin."""
    return np.linalg.norm(packing.position, axis=1).max()


def gyration_radius(packing):
    """r_gyr [m]: root of the mean square distance of the mass from its centre; grains of one density, as points."""
    mass = (packing.radius / packing.radius.max()) ** 3
    return float(np.sqrt(np.average((centred(packing.position, packing.radius) ** 2).sum(axis=1), weights=mass)))


def characteristic_radius(packing):
    """r_c = (5/3)^(1/2) r_gyr [m] (Mukai et al. 1992; A22 section 2.4): of a homogeneous sphere its radius."""
    return sqrt(5.0 / 3.0) * gyration_radius(packing)


def surface_gaps(position, radius, pairs):
    """Distances (M,) of the surfaces of pairs (M, 2), negative where they overlap, in the unit of position and
    radius."""
    distance = np.linalg.norm(position[pairs[:, 0]] - position[pairs[:, 1]], axis=1)
    return distance - radius[pairs].sum(axis=1)


def touching(position, radius, gap=0.0):
    """Pairs (M, 2) of grains whose surfaces are at most `gap` apart, in the unit of position (N, 3) and radius (N,)."""
    pairs = cKDTree(position).query_pairs(2 * radius.max() + gap, output_type="ndarray")
    return pairs[surface_gaps(position, radius, pairs) <= gap]


def contacts(packing):
    """Pairs (M, 2) of touching grains, sorted, first < second."""
    pairs = touching(packing.position, packing.radius)
    return pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))]


def touching_distance(first, second, grain_radius, overlap):
    """Distance [m] of the centres of grains of radii first, second [m] (any shape) at rest against each other.

    overlap: of two grains of grain_radius at rest [m]. It goes with the reduced radius R as R^(1/3), since
    delta_0 = a_0^2/(3 R) and a_0^3 ~ R^2 (A22 eq 1 and after eq 2).
    """
    return first + second - overlap * np.cbrt(2 * first * second / ((first + second) * grain_radius))


def equilibrium_overlaps(radius, pairs, grain_radius, overlap):
    """Overlaps (M,) [m] at rest of pairs (M, 2), where that of two grains of grain_radius is `overlap`."""
    first, second = radius[pairs].T
    return first + second - touching_distance(first, second, grain_radius, overlap)


def largest_cluster(grains, pairs):
    """(grains of the largest cluster that pairs (M, 2) connect, its pairs in their rows)."""
    kept = np.flatnonzero(fragment_labels(grains, pairs) == 0)
    row = np.full(grains, -1)
    row[kept] = np.arange(len(kept))
    rows = row[pairs]
    return kept, rows[(rows >= 0).all(axis=1)]


def largest_piece(packing):
    """The largest connected piece of a packing, where it was; its parameters count the grains that are `dropped`."""
    kept, _ = largest_cluster(packing.grains, contacts(packing))
    about = {**packing.parameters, "dropped": packing.grains - len(kept)}
    return Packing(packing.position[kept], packing.radius[kept], packing.seed, about)


def require_connected(packing):
    """Raise PackingError when a packing is in crumbs, so that a collision of it has no outcome."""
    try:
        belongs_to_an_aggregate(np.zeros(packing.grains, dtype=int), contacts(packing), packing.radius**3)
    except ValueError as error:
        raise PackingError(str(error)) from None


def description(packing):
    """A line about a packing; lengths in mean radii. The filling factor is that of the sphere of the characteristic
    radius, the fractal dimension the mean slope of the number of grains about one from NEAREST to r_gyr."""
    pairs, radius = contacts(packing), packing.radius.mean()
    pieces = int(fragment_labels(packing.grains, pairs).max()) + 1
    characteristic, gyration = characteristic_radius(packing), gyration_radius(packing)
    words = [
        f"{packing.grains} grains in {pieces} piece{'s' * (pieces > 1)}, {len(pairs)} contacts",
        f"mean coordination number {mean_coordination(packing.grains, pairs):.3f}",
        f"filling factor {(packing.radius**3).sum() / characteristic**3:.3g}",
        f"radius of gyration {gyration / radius:.4g}, characteristic radius {characteristic / radius:.4g} grain radii",
    ]
    if gyration > 2 * NEAREST * radius:
        distance = np.array([NEAREST * radius, gyration])
        dimension = fractal_dimension(distance, grains_within(packing.position, distance, origins=ORIGINS))
        words.append(f"fractal dimension {dimension[0]:.2f}")
    return ", ".join(words)
