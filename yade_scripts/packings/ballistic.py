"""Aggregates that grow by ballistic hits, at the equilibrium overlap: BPCA, BCCA and RBD. The hits are exact."""

from math import sqrt

import numpy as np
from scipy.spatial import cKDTree

from yade_scripts.packings.packing import Packing, centred, random_stream, randomly_turned, touching_distance

RAYS = 65536  # drawn at a time
FIRST_GRID, GROWTH = 16, 1.5  # half width of the first grid in cells, and the ratio of the next one's to it


def bpca(grains, grain_radius, overlap, seed, index=0, radii=None):
    """An aggregate by ballistic particle-cluster aggregation (A22 section 2.4, Mukai et al. 1992), as a Packing.

    Grains come one by one on straight lines, from directions that are uniform on the sphere and with impact parameters
    uniform over the cross-section of the sphere that holds the cluster, and stay where they first touch it. Grains that
    are then nearer to others than the sum of the radii pull from the first step on, but after brought_to_rest().

    Parameters
    ----------
    grains : int
    grain_radius, overlap : float
        Of a grain, and of two such grains at rest [m].
    seed, index : int
        Of the random numbers, and of the aggregate.
    radii : (grains,) array, optional
        [m], in the order in which the grains come; all grain_radius if left out."""
    radii = np.full(grains, float(grain_radius)) if radii is None else np.asarray(radii, dtype=float)
    position = _hit_by_grains(radii / grain_radius, overlap / grain_radius, random_stream(seed, index)) * grain_radius
    about = dict(packing="bpca", grains=grains, grainRadius=grain_radius, overlap=overlap, index=index)
    return Packing(centred(position, radii), radii, seed, about)


def _hit_by_grains(radii, overlap, stream):
    """Centres (N, 3), the first at the origin, in units of the grain radius."""
    from yade_scripts.packings import ballistic_hits  # numba takes a moment, and nothing else needs it

    def grid(half):
        """(cells, corner) of a grid of (2 half)^3 cells around the origin, with the grains that are there."""
        head, low = np.full((2 * half,) * 3, -1, dtype=np.int32), -half * width
        for number in range(count):
            ballistic_hits.add_grain(number, position, head, following, low, width)
        return head, low

    grains, largest = len(radii), radii.max()
    position, following = np.zeros((grains, 3)), np.full(grains, -1, dtype=np.int32)
    width, half, count, extent = 2.0 * largest, FIRST_GRID, 1, 0.0
    head, low = grid(half)
    directions = offsets = np.empty((0, 3))
    while count < grains:
        if not len(directions):  # uniform on the sphere, offsets (RAYS, 2) uniform in the unit circle
            directions = stream.normal(size=(RAYS, 3))
            directions /= np.linalg.norm(directions, axis=1)[:, None]
            distance, angle = np.sqrt(stream.uniform(size=RAYS)), stream.uniform(0.0, 2.0 * np.pi, RAYS)
            offsets = np.stack([distance * np.cos(angle), distance * np.sin(angle)], axis=1)
        count, used, extent = ballistic_hits.grow(
            position, radii, count, overlap, directions, offsets, extent, largest, head, following, low, width
        )
        directions, offsets = directions[used:], offsets[used:]
        if count < grains and len(directions):
            half = int(half * GROWTH)
            head, low = grid(half)
    return position


def bcca(grains, grain_radius, overlap, seed, index=0, planar=False, radii=None):
    """An aggregate by ballistic cluster-cluster aggregation (S17 section 4), as a Packing; parameters as of bpca().

    Two clusters of equal size (or of numbers of grains that differ by one) and random orientation fly at each other on
    a straight line, without turning, and stop where their first grains touch; from single grains to the aggregate. The
    paper doesn't give the impact parameter: here it is uniform over the cross-section in which clusters can meet."""
    stream = random_stream(seed, index)
    radii = np.full(grains, float(grain_radius)) if radii is None else np.asarray(radii, dtype=float)
    touching = lambda first, second: touching_distance(first, second, grain_radius, overlap)
    about = dict(packing="bcca", grains=grains, grainRadius=grain_radius, overlap=overlap, index=index)
    return Packing(_of_halves(radii, touching, stream, planar), radii, seed, {**about, "planar": int(planar)})


def _of_halves(radii, touching, stream, planar):
    grains = len(radii)
    if grains == 1:
        return np.zeros((1, 3))
    parts = np.split(radii, [grains - grains // 2])
    halves = [randomly_turned(_of_halves(part, touching, stream, planar), stream, planar) for part in parts]
    joined = np.concatenate([halves[0], _met(*halves, *parts, touching, stream, planar)])
    return centred(joined, radii)


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


def rbd(grains, grain_radius, overlap, overlap_with_plate, edge, seed):
    """A layer by random ballistic deposition on the plate z = 0 (Blum & Schraepler 2004).

    Grains come straight down at random places of a square around the z axis that is periodic in x and y, and stay where
    they first touch. overlap, overlap_with_plate: of one at rest on another, on the plate; edge: of the square [m]."""
    places = edge * (random_stream(seed, 0).random((grains, 2)) - 0.5)
    touching = 2 * grain_radius - overlap
    cells = max(3, int(edge / touching))
    held = {}  # (x, y, z) of grains, by cells at least as wide as two grains reach
    height = np.empty(grains)
    for number, (x, y) in enumerate(places.tolist()):
        i, j = int((x / edge + 0.5) * cells) % cells, int((y / edge + 0.5) * cells) % cells
        z = grain_radius - overlap_with_plate
        for di in (-1, 0, 1):
            for dj in (-1, 0, 1):
                for other_x, other_y, other_z in held.get(((i + di) % cells, (j + dj) % cells), ()):
                    across_x, across_y = x - other_x, y - other_y
                    across_x -= edge * round(across_x / edge)
                    across_y -= edge * round(across_y / edge)
                    below = touching**2 - across_x**2 - across_y**2
                    if below > 0:
                        z = max(z, other_z + sqrt(below))
        held.setdefault((i, j), []).append((x, y, z))
        height[number] = z
    about = dict(packing="rbd", grains=grains, grainRadius=grain_radius, overlap=overlap, edge=edge)
    return Packing(np.column_stack([places, height]), np.full(grains, float(grain_radius)), seed, about)
