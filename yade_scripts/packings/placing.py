"""Where packings start: when two first touch, a pair with an impact parameter, and the smallest periodic cell."""

import numpy as np
from scipy.spatial import cKDTree

from yade_scripts.packings.packing import PackingError, characteristic_radius, contacts, extent, moved

WINDOW = 2.0  # sums of radii that first_touch() looks ahead at once
START_GAP = 2.0  # radii of the largest grain that aggregates move against each other until they first touch
IMAGE_GAP = 0.1  # grain radii between a packing and its images in the smallest cell that holds it whole


def first_touch(first, second, velocity):
    """Time [s] until two packings, apart, touch when `second` moves by velocity (3,) [m/s]; None if never."""
    speed = np.linalg.norm(velocity)
    along = np.asarray(velocity) / speed
    reach = first.radius.max() + second.radius.max()
    window = WINDOW * reach
    travelled, end = _encounter(first.position, second.position, along, reach)
    target = cKDTree(first.position)
    while travelled < end:
        there = second.position + travelled * along
        near = target.sparse_distance_matrix(cKDTree(there), reach + window, output_type="coo_matrix")
        apart = first.position[near.row] - there[near.col]
        distances = _distances(apart, first.radius[near.row] + second.radius[near.col], along)
        if distances.size and distances.min() <= window:
            return float((travelled + distances.min()) / speed)
        travelled += window
    return None


def _distances(apart, radii, along):
    """How far grains must move until they touch [m], for those of the pairs that will."""
    ahead = apart @ along
    square = radii**2 - (np.einsum("ij,ij->i", apart, apart) - ahead**2)
    meets = (square >= 0) & (ahead > 0)
    distance = ahead[meets] - np.sqrt(square[meets])
    return np.maximum(distance[distance > -1e-9 * radii[meets]], 0.0)  # touching already, to rounding


def _encounter(first, second, along, reach):
    """Distances moved [m] between which the spheres around the two can touch; (0, 0): they never do."""
    centres = [positions.mean(axis=0) for positions in (first, second)]
    extents = [np.linalg.norm(p - c, axis=1).max() for p, c in zip((first, second), centres)]
    apart = centres[0] - centres[1]
    ahead = apart @ along
    square = (sum(extents) + reach) ** 2 - (apart @ apart - ahead**2)
    if square < 0:
        return 0.0, 0.0
    return max(0.0, ahead - np.sqrt(square)), max(0.0, ahead + np.sqrt(square))


def offset_pair(target, projectile, velocity, impact):
    """(packings, velocities (3,) [m/s]) of two aggregates on their way to each other, in the frame of their common
    centre of mass (A22 section 2.4): so far apart that they first touch after START_GAP, or, where they pass each
    other, that the spheres around them touch in x.

    target, projectile: around their centres of mass; velocity: of the projectile relative to the target, along -x
    [m/s]; impact: offset of the centres in y over r_c,tar + r_c,pro (A22 eq 27)."""
    largest = max(target.radius.max(), projectile.radius.max())
    offset = impact * (characteristic_radius(target) + characteristic_radius(projectile))
    ahead = extent(target) + extent(projectile) + 2 * largest
    far = moved(projectile, (ahead, offset, 0.0))
    until_touch = first_touch(target, far, np.array([-1.0, 0.0, 0.0]))
    if until_touch is not None:
        ahead += START_GAP * largest - until_touch
    shifts = velocities_of([target, projectile], np.array([ahead, offset, 0.0]))
    pair = [moved(packing, shift) for packing, shift in zip((target, projectile), shifts)]
    return pair, velocities_of(pair, np.array([-velocity, 0.0, 0.0]))


def velocities_of(pair, relative):
    """Velocities (3,) of target and projectile in the frame of their common centre of mass, of the projectile's
    relative (3,) to the target; likewise of places."""
    mass = np.array([(packing.radius**3 * packing.density).sum() for packing in pair])
    return [-mass[1] / mass.sum() * relative, mass[0] / mass.sum() * relative]


def smallest_edge(packing):
    """Edge [m] of the cubic cell as large as the packing in x, y or z (K13 section 2.3), with a small gap."""
    radius = packing.radius.max()
    return float(np.ptp(packing.position, axis=0).max() + (2 + IMAGE_GAP) * radius)


def require_apart_from_images(packing, edge):
    """Raise PackingError when grains touch images of others in a cubic cell of that edge [m]."""
    inside = packing.position % edge
    inside[inside >= edge] = 0.0  # of -1e-20 % edge
    pairs = cKDTree(inside, boxsize=edge).query_pairs(2 * packing.radius.max(), output_type="ndarray")
    separation = inside[pairs[:, 0]] - inside[pairs[:, 1]]
    separation -= edge * np.round(separation / edge)
    touching = np.linalg.norm(separation, axis=1) <= packing.radius[pairs].sum(axis=1)
    across = int(np.count_nonzero(touching)) - len(contacts(packing))
    if across > 0:
        raise PackingError(f"{across} pairs of grains touch across the boundaries of the cell; must be none")
