"""Structure: how many grains lie within a distance of a grain (Kataoka et al. 2013, K13, Fig. 11), gyration radius (Sirono & Ueno 2017, S17)."""

from itertools import product
from math import ceil

import numpy as np
from scipy.spatial import cKDTree


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
        reach = [range(-ceil(distance.max() / edge), ceil(distance.max() / edge) + 1) for edge in cell_size]
        shifts = [cell_size * image for image in product(*reach)]
    chosen = position
    if origins is not None and origins < len(position):
        chosen = position[np.linspace(0, len(position) - 1, origins).round().astype(int)]
    tree, counts = cKDTree(position), np.zeros(distance.shape)
    for shift in shifts:
        counts += cKDTree(chosen + shift).count_neighbors(tree, distance)
    return counts / len(chosen)


def fractal_dimension(distance, counts):
    """D (K-1,) of N ~ r^D between neighbouring distances (K,), from counts (K,)."""
    return np.diff(np.log(counts)) / np.diff(np.log(distance))


def gyration_radius(position):
    """R_g of points (N,3) of equal mass, in their unit: S17 eq 13.

    >>> gyration_radius([[0.0, 0, 0], [2, 0, 0]])
    1.0
    """
    position = np.asarray(position, dtype=float)
    return float(np.sqrt(((position - position.mean(axis=0)) ** 2).sum(axis=1).mean()))
