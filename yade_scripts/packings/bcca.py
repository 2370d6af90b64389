"""Aggregates by ballistic cluster-cluster aggregation (BCCA), in space or in a plane, as in Sirono & Ueno (2017, S17) section 4.

The recipe: two clusters of equal size and random orientation fly at each other on a
straight line, without turning, and stop where their first grains touch; from single grains to the aggregate.
S17 doesn't give the impact parameter: here it is uniform over the cross-section in which clusters can meet.
"""

import numpy as np
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation

from yade_scripts.packings.grain_sizes import touching_distance
from yade_scripts.packings.packing import Packing, centred, random_stream


def bcca(grains, grain_radius, overlap, seed, index=0, planar=False, radii=None):
    """A BCCA aggregate of `grains` grains, its centre of mass at the origin; planar: all in the plane z = 0.

    grain_radius, overlap (of two such grains at rest) in m; radii (grains,) [m], all of grain_radius when left out.
    Every cluster is of two of half its number of grains (a power of two, or numbers that differ by one). The packing is
    a function of the arguments.
    """
    stream = random_stream(seed, index)
    radii = np.full(grains, float(grain_radius)) if radii is None else np.asarray(radii, dtype=float)

    def touching(first, second):
        return touching_distance(first, second, grain_radius, overlap)

    return Packing(
        _cluster(radii, touching, stream, planar),
        radii,
        seed,
        dict(packing="bcca", grains=grains, grainRadius=grain_radius, overlap=overlap, index=index, planar=int(planar)),
    )


def _cluster(radii, touching, stream, planar):
    grains = len(radii)
    if grains == 1:
        return np.zeros((1, 3))
    parts = np.split(radii, [grains - grains // 2])
    halves = [_turned(_cluster(part, touching, stream, planar), stream, planar) for part in parts]
    joined = np.concatenate([halves[0], _met(*halves, *parts, touching, stream, planar)])
    return centred(joined, radii)


def _turned(position, stream, planar):
    if planar:
        return Rotation.from_rotvec([0, 0, stream.uniform(0, 2 * np.pi)]).apply(position) * (1, 1, 0)
    return Rotation.random(random_state=stream).apply(position)


def _met(target, projectile, target_radii, projectile_radii, touching, stream, planar):
    """The projectile where it first touches the target, having come along -x; offsets that miss are drawn again."""
    across = slice(1, 2) if planar else slice(1, 3)
    reach = touching(target_radii.max(), projectile_radii.max())
    limit = reach + sum(np.linalg.norm(p[:, across], axis=1).max() for p in (target, projectile))
    tree = cKDTree(target[:, across])
    while True:
        offset = np.zeros(3)
        offset[across] = stream.uniform(-limit, limit, across.stop - 1)
        if np.linalg.norm(offset) > limit:
            continue
        moved = projectile + offset
        near = tree.sparse_distance_matrix(cKDTree(moved[:, across]), reach, output_type="ndarray")
        first, second = near["i"], near["j"]
        square = touching(target_radii[first], projectile_radii[second]) ** 2 - near["v"] ** 2
        meets = square >= 0
        if meets.any():
            stops = target[first, 0] - moved[second, 0] + np.sqrt(np.maximum(square, 0.0))
            return moved + (stops[meets].max(), 0, 0)
