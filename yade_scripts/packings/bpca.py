"""Aggregates by ballistic particle-cluster aggregation (BPCA) in space, as in A22 section 2.4 (Mukai et al. 1992).

The recipe: grains come one by one on straight lines, from directions that are uniform on the sphere and with impact
parameters uniform over the cross-section of the sphere that holds the cluster, and stay where they first touch it, at
the equilibrium overlap. Rays that miss are drawn again. The hits are exact: no step is taken along a ray.

Grains that touch no other than the one that they hit may still be nearer to others than the sum of the radii: these
are contacts from the first step on, and pull (docs/aggregates.md: how many, and with how much energy).
"""

import numpy as np

from yade_scripts.packings.packing import Packing, centred, random_stream

RAYS = 65536  # drawn at a time
FIRST_GRID, GROWTH = 16, 1.5  # half width of the first grid in cells, and the ratio of the next one's to it


def bpca(grains, grain_radius, overlap, seed, index=0, radii=None):
    """A BPCA aggregate of `grains` grains, its centre of mass at the origin.

    grain_radius, overlap (of two such grains at rest) in m; radii (grains,) [m] in the order in which the grains come,
    all of grain_radius when left out. The packing is a function of the arguments.
    """
    radii = np.full(grains, float(grain_radius)) if radii is None else np.asarray(radii, dtype=float)
    position = _cluster(radii / grain_radius, overlap / grain_radius, random_stream(seed, index)) * grain_radius
    about = dict(packing="bpca", grains=grains, grainRadius=grain_radius, overlap=overlap, index=index)
    return Packing(centred(position, radii), radii, seed, about)


def _cluster(radii, overlap, stream):
    """Centres (N,3), the first at the origin, in units of the grain radius."""
    from yade_scripts.packings import ballistic_hits  # numba takes a moment, and nothing else needs it

    grains, largest = len(radii), radii.max()
    position, following = np.zeros((grains, 3)), np.full(grains, -1, dtype=np.int32)
    width = 2.0 * largest
    half, count, extent = FIRST_GRID, 1, 0.0
    head, low = _grid(ballistic_hits.add_grain, half, width, position, following, count)
    directions = offsets = np.empty((0, 3))
    while count < grains:
        if not len(directions):
            directions, offsets = _rays(stream)
        count, used, extent = ballistic_hits.grow(
            position, radii, count, overlap, directions, offsets, extent, largest, head, following, low, width
        )
        directions, offsets = directions[used:], offsets[used:]
        if count < grains and len(directions):
            half = int(half * GROWTH)
            head, low = _grid(ballistic_hits.add_grain, half, width, position, following, count)
    return position


def _grid(add_grain, half, width, position, following, count):
    """(head, low) of a grid of (2 half)^3 cells around the origin, with the grains that are there."""
    head, low = np.full((2 * half,) * 3, -1, dtype=np.int32), -half * width
    for number in range(count):
        add_grain(number, position, head, following, low, width)
    return head, low


def _rays(stream):
    """RAYS directions (B,3), uniform on the sphere, and offsets (B,2), uniform in the unit circle."""
    directions = stream.normal(size=(RAYS, 3))
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    distance, angle = np.sqrt(stream.uniform(size=RAYS)), stream.uniform(0.0, 2.0 * np.pi, RAYS)
    return directions, np.stack([distance * np.cos(angle), distance * np.sin(angle)], axis=1)
