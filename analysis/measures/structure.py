"""Structure: how many grains lie within a distance of a grain (Kataoka et al. 2013, K13, Fig. 11), fractal dimension, gyration radius (Sirono &
Ueno 2017, S17), filling factor."""

from itertools import product
from math import ceil

import numpy as np
from scipy.spatial import cKDTree

from ..arguments import COUNT, NOT_NEGATIVE, POSITIVE, number, numbers, takes

SCALES, MOST_ORIGINS = 12, 500  # of correlation_dimension
POINTS, RADII = numbers("N,3"), numbers("N", POSITIVE)


@takes(position=POINTS, distance=numbers(right=NOT_NEGATIVE), cell_size=numbers("3", POSITIVE), origins=number(COUNT))
def grains_within(position, distance, cell_size=None, origins=None):
    """N(r < r_in): mean number of grains, itself and images included, whose centre is nearer than `distance` (K,) to that
    of a grain (K13 section 3.6).

    position (N,3), anywhere; cell_size (3,): edges of the periodic cell, None in open space; origins: at most so many
    grains, evenly chosen among them, are taken as centres (None: all). One unit for all lengths.

    >>> grains_within([[0.0, 0, 0], [1, 0, 0]], [0.5, 1.5]).tolist(), grains_within([[0.0, 0, 0]], [1.5], [1.0] * 3).tolist()
    ([1.0, 2.0], [19.0])
    """
    position, distance = np.asarray(position, dtype=float), np.asarray(distance, dtype=float)
    shifts = [np.zeros(3)]
    if cell_size is not None:
        cell_size = np.asarray(cell_size, dtype=float)
        position = position - cell_size * np.floor(position / cell_size)
        farthest = distance.max(initial=0.0)
        reach = [range(-ceil(farthest / edge), ceil(farthest / edge) + 1) for edge in cell_size]
        shifts = [cell_size * image for image in product(*reach)]
    chosen = position
    if origins is not None and origins < len(position):
        chosen = position[np.linspace(0, len(position) - 1, origins).round().astype(int)]
    tree, counts = cKDTree(position), np.zeros(distance.shape)
    for shift in shifts:
        counts += cKDTree(chosen + shift).count_neighbors(tree, distance.ravel()).reshape(distance.shape)
    return counts / len(chosen)


def fractal_dimension(distance, counts):
    """D (K-1,) of N ~ r^D between neighbouring distances (K,), from counts (K,)."""
    return np.diff(np.log(counts)) / np.diff(np.log(distance))


@takes(position=POINTS, radius=RADII)
def correlation_dimension(position, radius):
    """Fractal dimension of a piece: slope of ln N(< s) against ln s, fitted at SCALES distances s from 3 radii (the largest of
    radius (N,)) to 0.7 R_g, N(< s) as in grains_within; position (N,3), one unit. NaN where that is less than a factor of 1.5.

    The surface lowers it. Of 256 to 4096 grains BCCA aggregates have 1.87 (scatter 0.05; infinite ones 1.9), BPCA aggregates
    2.4 to 2.6 (3), close-packed spheres thinned to 0.4 some 2.85 (3). Grassberger & Procaccia (1983); K13 section 3.6.

    >>> line = np.arange(100.0)[:, None] * [2, 0, 0]
    >>> round(correlation_dimension(line, np.ones(100)), 1)
    1.0
    """
    position = np.asarray(position, dtype=float)
    low, high = 3.0 * float(np.max(radius)), 0.7 * gyration_radius(position)
    if not high >= 1.5 * low:
        return float("nan")
    distance = np.geomspace(low, high, SCALES)
    counts = grains_within(position, distance, origins=MOST_ORIGINS)
    return float(np.polyfit(np.log(distance), np.log(counts), 1)[0])


@takes(position=POINTS, radius=RADII)
def gyration_radius(position, radius=None):
    """R_g of points (N,3) of equal mass, in their unit: S17 eq 13; with the grains' radius (N,): of spheres of one density,
    R_g^2 = sum m_i (|x_i - x_c|^2 + 3/5 r_i^2)/sum m_i.

    >>> gyration_radius([[0.0, 0, 0], [2, 0, 0]]), round(gyration_radius([[0.0, 0, 0]], [1.0]) ** 2, 3)
    (1.0, 0.6)
    """
    position = np.asarray(position, dtype=float)
    own = np.zeros(len(position)) if radius is None else np.asarray(radius, dtype=float)
    mass = None if radius is None else (own / own.max()) ** 3
    square = ((position - np.average(position, axis=0, weights=mass)) ** 2).sum(axis=1)
    return float(np.sqrt(np.average(square + 0.6 * own**2, weights=mass)))


@takes(position=POINTS, radius=RADII)
def filling_factor(position, radius):
    """Volume of spheres at position (N,3) with radius (N,), over that of a homogeneous sphere of their gyration radius, whose radius
    is r_c = (5/3)^(1/2) R_g (Mukai et al. 1992; A22 section 2.4); overlaps counted twice. One unit. Of one grain 1.

    >>> round(filling_factor([[0.0, 0, 0]], [1.0]), 9), round(filling_factor([[-1.0, 0, 0], [1, 0, 0]], [1.0, 1.0]), 3)
    (1.0, 0.459)
    """
    whole = np.sqrt(5.0 / 3.0) * gyration_radius(position, radius)
    return float(((np.asarray(radius, dtype=float) / whole) ** 3).sum())
