"""Velocities at which neighbouring grains approach each other (Arakawa et al. 2022, A22, section 5.1)."""

import numpy as np
from scipy.spatial import cKDTree

NEAR = 2.2  # A22's threshold distance, in grain radii


def pair_velocities(position, velocity, distance):
    """Normal component v_rel (M,) [m/s] of the relative velocity of the pairs of grains nearer than `distance` [m],
    positive where they approach; position (N,3) [m], velocity (N,3) [m/s]. A22 section 5.1.

    >>> pair_velocities(np.array([[0.0, 0, 0], [1, 0, 0], [3, 0, 0]]), np.array([[2.0, 1, 0], [-1, 0, 0], [0, 0, 0]]), 1.5)
    array([3.])
    """
    pairs = cKDTree(position).query_pairs(distance, output_type="ndarray")
    apart = position[pairs[:, 1]] - position[pairs[:, 0]]
    relative = velocity[pairs[:, 1]] - velocity[pairs[:, 0]]
    length = np.linalg.norm(apart, axis=1)
    keep = length > 0
    return -np.einsum("ij,ij->i", apart, relative)[keep] / length[keep]


def root_mean_square(values):
    """(mean of the squares of values (M,))^(1/2); NaN without any."""
    return float(np.sqrt(np.mean(np.square(values)))) if len(values) else float("nan")
