"""Close packing and extraction (CPE), as in A24 section 3.

The recipe: a face-centred cubic lattice whose neighbours overlap by the equilibrium overlap (so that the start is
force-free), a sphere whose centre is random within the lattice's unit cell, every grain whose centre lies outside
dropped, grains removed at random until N = filling (R/r)^3 are left, a random orientation. Planar ones likewise: a
hexagonal lattice, a circle, N = filling (R/r)^2.
"""

from math import ceil, pi, sqrt

import numpy as np

from analysis.theory.aggregates import fcc_filling
from yade_scripts.packings.packing import Packing, PackingError, random_stream, randomly_turned

FCC_BASIS = np.array([[0, 0, 0], [0, 0.5, 0.5], [0.5, 0, 0.5], [0.5, 0.5, 0]])  # in edges of the cubic cell


def maximum_filling(grain_radius, overlap, planar=False):
    """Filling factor of the whole lattice (A24 eq 40), or fraction of the area of a planar one; lengths in m."""
    if planar:
        return pi / (2 * sqrt(3)) * (2 * grain_radius / (2 * grain_radius - overlap)) ** 2
    return fcc_filling(grain_radius, overlap)


def grain_number(filling, relative_radius, planar=False):
    """N = filling (R/r)^3, rounded (A24 section 3), or filling (R/r)^2 in a plane; relative_radius = R/r."""
    return round(filling * relative_radius ** (2 if planar else 3))


def cpe(filling, aggregate_radius, grain_radius, overlap, seed, index=0, planar=False):
    """A close-packed and extracted aggregate around the origin (A24 section 3); raises PackingError.

    Parameters
    ----------
    filling : float
        N = filling (aggregate_radius/grain_radius)^3, squared when planar.
    aggregate_radius, grain_radius, overlap : float
        Of the sphere (circle) that holds all centres, of a grain, and of neighbours in the lattice [m].
    seed, index : int
        Of the random numbers, and of the aggregate.
    planar : bool
        Whether all grains lie in the plane z = 0."""
    limit = maximum_filling(grain_radius, overlap, planar)
    if filling > limit:
        raise PackingError(f"filling = {filling:g}: more than the lattice holds; must be at most {limit:.4f}")
    wanted = grain_number(filling, aggregate_radius / grain_radius, planar)
    stream = random_stream(seed, index)
    lattice = _lattice_in_circle if planar else _lattice_in_sphere
    sites = lattice(2 * grain_radius - overlap, aggregate_radius, stream)
    if wanted > len(sites):
        at_most = len(sites) * (grain_radius / aggregate_radius) ** (2 if planar else 3)
        has = f"takes {wanted} grains, but the lattice has {len(sites)} in this sphere (seed {seed}, aggregate {index})"
        raise PackingError(f"filling = {filling:g}: {has}; must be at most {at_most:.4f} here (A24 eq 40)")
    kept = np.sort(stream.choice(len(sites), wanted, replace=False, shuffle=False))
    position = randomly_turned(sites[kept], stream, planar)
    about = dict(packing="cpe", filling=filling, aggregateRadius=aggregate_radius, grainRadius=grain_radius)
    about |= dict(overlap=overlap, index=index, **({"planar": 1} if planar else {}))
    return Packing(position, np.full(wanted, float(grain_radius)), seed, about)


def _lattice_in_circle(spacing, circle_radius, stream):
    """Sites (N, 3), z = 0, of a hexagonal lattice in a circle, relative to its centre, which is random."""
    steps = spacing * np.array([[1, 0, 0], [0.5, sqrt(3) / 2, 0]])
    reach = ceil(2 / sqrt(3) * circle_radius / spacing) + 2
    cells = np.stack(np.meshgrid(*2 * [np.arange(-reach, reach + 1)], indexing="ij"), axis=-1).reshape(-1, 2)
    sites = (cells - stream.uniform(0, 1, 2)) @ steps
    return sites[np.einsum("ij,ij->i", sites, sites) <= circle_radius**2]


def _lattice_in_sphere(spacing, sphere_radius, stream):
    """Sites (N, 3) of a face-centred cubic lattice in a sphere, relative to its centre, which is random."""
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
