"""When two packings that move on straight lines first touch."""

import numpy as np
from scipy.spatial import cKDTree

WINDOW = 2.0  # sums of radii that are looked ahead at once


def first_touch(first, second, velocity):
    """Time [s] until two grains touch when `second` moves by velocity (3,) [m/s] against `first`; None if never.

    Both keep their shapes; two grains touch when their distance falls to the sum of their radii. The packings must be
    apart at the start.
    """
    speed = np.linalg.norm(velocity)
    along = np.asarray(velocity) / speed
    reach = first.radius.max() + second.radius.max()
    window = WINDOW * reach
    travelled, end = _encounter(first.position, second.position, along, reach)
    target = cKDTree(first.position)
    while travelled < end:
        moved = second.position + travelled * along
        near = target.sparse_distance_matrix(cKDTree(moved), reach + window, output_type="coo_matrix")
        apart = first.position[near.row] - moved[near.col]
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
    """(begin, end): distances moved [m] between which the spheres around the two can touch; (0, 0) when they never do."""
    centres = [positions.mean(axis=0) for positions in (first, second)]
    extents = [np.linalg.norm(p - c, axis=1).max() for p, c in zip((first, second), centres)]
    apart = centres[0] - centres[1]
    ahead = apart @ along
    square = (sum(extents) + reach) ** 2 - (apart @ apart - ahead**2)
    if square < 0:
        return 0.0, 0.0
    return max(0.0, ahead - np.sqrt(square)), max(0.0, ahead + np.sqrt(square))
