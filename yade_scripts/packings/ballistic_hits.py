"""Rays against a growing cluster of spheres, compiled by numba at the first use (a few seconds) and cached on disk.

Lengths are in units of the grain radius. A grid of cubic cells, as wide as the largest distance at which two grains
touch, holds the cluster's grains in linked lists: head (cells along x, y, z) has a cell's last grain, following (N,)
the one before it, -1 none.
"""

import numpy as np
from numba import njit


@njit(cache=True)
def add_grain(number, position, head, following, low, width):
    """Enter a grain into the grid whose corner is `low` and whose cells have that width."""
    i = int((position[number, 0] - low) / width)
    j = int((position[number, 1] - low) / width)
    k = int((position[number, 2] - low) / width)
    following[number] = head[i, j, k]
    head[i, j, k] = number


@njit(cache=True)
def _touching(first, second, overlap):
    # packing.touching_distance in units of the grain radius
    return first + second - overlap * np.cbrt(2.0 * first * second / (first + second))


@njit(cache=True)
def _across(direction):
    """Two unit vectors perpendicular to a direction and to each other."""
    first = np.empty(3)
    if abs(direction[0]) < 0.9:
        first[0], first[1], first[2] = 0.0, direction[2], -direction[1]
    else:
        first[0], first[1], first[2] = -direction[2], 0.0, direction[0]
    first /= np.sqrt((first * first).sum())
    return first, np.cross(direction, first)


@njit(cache=True)
def _through_box(start, direction, low, high):
    """(t of entry, t of exit) of the ray start + t direction, t >= 0, and a cube; entry > exit: misses."""
    enter, leave = 0.0, np.inf
    for axis in range(3):
        if direction[axis] == 0.0:
            if start[axis] < low or start[axis] >= high:
                return 1.0, 0.0
        else:
            one, other = (low - start[axis]) / direction[axis], (high - start[axis]) / direction[axis]
            enter, leave = max(enter, min(one, other)), min(leave, max(one, other))
    return enter, leave


@njit(cache=True)
def _nearest_hit(cell, start, direction, radius, position, radii, overlap, head, following, best):
    """t of the first hit with the grains in the 27 cells around a cell, if it is before `best`; else best."""
    for i in range(max(cell[0] - 1, 0), min(cell[0] + 2, head.shape[0])):
        for j in range(max(cell[1] - 1, 0), min(cell[1] + 2, head.shape[1])):
            for k in range(max(cell[2] - 1, 0), min(cell[2] + 2, head.shape[2])):
                grain = head[i, j, k]
                while grain >= 0:
                    x = position[grain, 0] - start[0]
                    y = position[grain, 1] - start[1]
                    z = position[grain, 2] - start[2]
                    along = x * direction[0] + y * direction[1] + z * direction[2]
                    # the distance across, not a difference of squares: exact for far starts too
                    x -= along * direction[0]
                    y -= along * direction[1]
                    z -= along * direction[2]
                    across = x * x + y * y + z * z
                    if across < (radii[grain] + radius) ** 2:
                        square = _touching(radii[grain], radius, overlap) ** 2 - across
                        if square > 0.0:
                            best = min(best, along - np.sqrt(square))
                    grain = following[grain]
    return best


@njit(cache=True)
def _first_hit(start, direction, radius, position, radii, overlap, head, following, low, width):
    """t at which a grain of that radius on the ray start + t direction first touches one of the cluster; inf: never."""
    cells = head.shape[0]
    enter, leave = _through_box(start, direction, low, low + cells * width)
    best = np.inf
    if enter >= leave:
        return best
    cell, step = np.empty(3, np.int64), np.empty(3, np.int64)
    following_wall, per_cell = np.empty(3), np.empty(3)
    for axis in range(3):
        place = int((start[axis] + enter * direction[axis] - low) / width)
        cell[axis] = min(max(place, 0), cells - 1)
        step[axis] = 1 if direction[axis] > 0 else -1
        following_wall[axis] = per_cell[axis] = np.inf
        if direction[axis] != 0.0:
            wall = low + (cell[axis] + (direction[axis] > 0)) * width
            following_wall[axis] = (wall - start[axis]) / direction[axis]
            per_cell[axis] = width / abs(direction[axis])
    while True:
        best = _nearest_hit(cell, start, direction, radius, position, radii, overlap, head, following, best)
        axis = np.argmin(following_wall)
        # The cells around hold every grain that the ray can touch before this wall.
        if best <= following_wall[axis]:
            return best
        cell[axis] += step[axis]
        if cell[axis] < 0 or cell[axis] >= cells:
            return best
        following_wall[axis] += per_cell[axis]


@njit(cache=True)
def grow(position, radii, count, overlap, directions, offsets, extent, largest, head, following, low, width):
    """Add grains where rays first touch the cluster, until all are there, the rays used up or the grid too small.

    position (N,3), radii (N,): the first `count` are there; overlap: of equal grains at rest; directions (B,3) unit
    vectors and offsets (B,2) in the unit circle of the rays, which start outside a sphere that holds the cluster and
    the grain to come; extent: largest distance from the first grain. Returns (count, rays used, extent)."""
    start = np.empty(3)
    for ray in range(len(directions)):
        reach = extent + 2.0 * largest
        if count == len(position) or -reach < low + 2.0 * width:
            return count, ray, extent
        direction = directions[ray]
        first, second = _across(direction)
        for axis in range(3):
            across = offsets[ray, 0] * first[axis] + offsets[ray, 1] * second[axis]
            start[axis] = reach * (across - 2.0 * direction[axis])
        t = _first_hit(start, direction, radii[count], position, radii, overlap, head, following, low, width)
        if t == np.inf:
            continue
        square = 0.0
        for axis in range(3):
            position[count, axis] = start[axis] + t * direction[axis]
            square += position[count, axis] ** 2
        add_grain(count, position, head, following, low, width)
        extent = max(extent, np.sqrt(square))
        count += 1
    return count, len(directions), extent
