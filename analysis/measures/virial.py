"""Pressure and stress of a periodic cell by the virial theorem (Kataoka et al. 2013, K13, eqs 13-21), from plain arrays in SI units.

N grains at position (N,3), anywhere: the cell with edges cell_size (3,) is around the origin, and two grains meet as
their nearest images. M contacts: pairs (M,2) of rows. Pressures are positive where the grains push outwards."""

import numpy as np


def nearest_image(separation, cell_size):
    """separation (..., 3) between grains as that between their nearest images.

    >>> nearest_image([0.9, -0.2, 2.1], [1.0, 1.0, 1.0]).round(6).tolist()
    [-0.1, -0.2, 0.1]
    """
    separation = np.asarray(separation, dtype=float)
    return separation - cell_size * np.round(separation / cell_size)


def contact_separation(position, pairs, cell_size):
    """x1 - x2 (M,3) [m] of the grains in contact."""
    first, second = np.asarray(pairs, dtype=np.intp).reshape(-1, 2).T
    return nearest_image(position[first] - position[second], cell_size)


def contact_pressure(position, pairs, normal_force, cell_size):
    """Sum of (r_i - r_j) f_ij over 3 V [Pa]: the second term of K13 eq 21.

    normal_force (M,) [N], positive when repulsive, is all that is needed: sliding pulls at right angles to r_i - r_j
    (A24 eq A8), rolling and twisting exert torques only."""
    distance = np.linalg.norm(contact_separation(position, pairs, cell_size), axis=1)
    return float(distance @ np.asarray(normal_force)) / (3.0 * float(np.prod(cell_size)))


def cell_velocity(position, velocity, cell_size, rate):
    """Velocity (N,3) [m/s] of each grain's image in the cell around the origin (K13 eqs 8-11).

    rate (3,) [1/s]: of the edges' logarithms, d(ln L)/dt; position and velocity of a grain that stays outside of the cell."""
    return velocity - rate * cell_size * np.round(position / cell_size)


def kinetic_pressure(mass, position, velocity, cell_size, rate):
    """2 K/(3 V) [Pa] with the translational kinetic energy K of the grains' images in the cell: the first term of K13
    eq 21. It counts the mean flow of the cell too, as K13 does. mass (N,) [kg]; rate as in cell_velocity()."""
    inside = cell_velocity(position, velocity, cell_size, rate)
    twice = float(np.asarray(mass) @ np.einsum("ij,ij->i", inside, inside))
    return twice / (3.0 * float(np.prod(cell_size)))


def filling_factor(radius, cell_size):
    """Volume of the spheres, radius (N,), over that of the cell (K13 eq 22; overlaps counted twice)."""
    return float(4.0 / 3.0 * np.pi * np.sum(np.asarray(radius, dtype=float) ** 3) / np.prod(cell_size))
