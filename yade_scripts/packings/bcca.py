"""Aggregates by ballistic cluster-cluster aggregation (BCCA), in space or in a plane, as in Sirono & Ueno (2017, S17) section 4.

The recipe: two clusters of equal size and random orientation fly at each other on a
straight line, without turning, and stop where their first grains touch; from single grains to the aggregate.
S17 doesn't give the impact parameter: here it is uniform over the cross-section in which clusters can meet.
"""

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from yade_scripts.packings.packing import Packing, random_stream


def bcca(grains, grain_radius, overlap, seed, index=0, planar=False):
    """A BCCA aggregate of `grains` grains, its centre of mass at the origin; planar: all in the plane z = 0.

    grain_radius, overlap (of touching grains) in m. Every cluster is of two of half its size (a power of two, or
    sizes that differ by one grain). The packing is a function of the arguments.
    """
    stream = random_stream(seed, index)
    position = _cluster(grains, 2 * grain_radius - overlap, stream, planar)
    return Packing(
        position,
        np.full(grains, float(grain_radius)),
        seed,
        dict(packing="bcca", grains=grains, grainRadius=grain_radius, overlap=overlap, index=index, planar=int(planar)),
    )


def _cluster(grains, reach, stream, planar):
    if grains == 1:
        return np.zeros((1, 3))
    halves = [
        _turned(_cluster(size, reach, stream, planar), stream, planar) for size in (grains - grains // 2, grains // 2)
    ]
    joined = np.concatenate([halves[0], _met(*halves, reach, stream, planar)])
    return joined - joined.mean(axis=0)


def _turned(position, stream, planar):
    if planar:
        return Rotation.from_rotvec([0, 0, stream.uniform(0, 2 * np.pi)]).apply(position) * (1, 1, 0)
    return Rotation.random(random_state=stream).apply(position)


def _met(target, projectile, reach, stream, planar):
    """The projectile where it first touches the target, having come along -x; offsets that miss are drawn again."""
    across = slice(1, 2) if planar else slice(1, 3)
    limit = reach + sum(np.linalg.norm(p[:, across], axis=1).max() for p in (target, projectile))
    tree = cKDTree(target[:, across])
    while True:
        offset = np.zeros(3)
        offset[across] = stream.uniform(-limit, limit, across.stop - 1)
        if np.linalg.norm(offset) > limit:
            continue
        moved = projectile + offset
        near = tree.sparse_distance_matrix(cKDTree(moved[:, across]), reach, output_type="coo_matrix")
        if near.nnz:
            stops = target[near.row, 0] - moved[near.col, 0] + np.sqrt(reach**2 - near.data**2)
            return moved + (stops.max(), 0, 0)
