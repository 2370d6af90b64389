"""Orientation and lattice phase are uniform: tests at 99.9 % confidence each, of fixed seeds."""

import numpy as np
from of_ice import OVERLAP, RADIUS, SPACING
from scipy.stats import kstest

from yade_scripts import packings
from yade_scripts.packings import lattice

CONFIDENCE = 0.999


def test_orientation_is_uniform():
    """Two orthogonal directions fixed in the lattice are each uniform on the sphere, and so is the angle
    between planes.

    A direction is uniform on the sphere when each component is uniform in [-1, 1] (Archimedes). The first is
    that of a contact; the second, perpendicular, lies at a uniform angle around the first when all rotations
    are equally likely.
    """
    frames = np.array([_frame(seed) for seed in range(2000)])
    p_values = [kstest(component, "uniform", args=(-1, 2)).pvalue for component in frames.reshape(-1, 6).T]
    angles = [_angle_around(u, n) for u, n in frames]
    p_values.append(kstest(angles, "uniform", args=(-np.pi, 2 * np.pi)).pvalue)
    assert min(p_values) > (1 - CONFIDENCE) / len(p_values)


def _frame(seed):
    """Direction of the first contact, and the normal of the plane of the first two that aren't parallel."""
    packing = packings.cpe(0.4, 4 * RADIUS, RADIUS, OVERLAP, seed, seed % 2)
    pairs = packings.contacts(packing)
    directions = (packing.position[pairs[:, 1]] - packing.position[pairs[:, 0]]) / SPACING
    normals = np.cross(directions[0], directions)
    lengths = np.linalg.norm(normals, axis=1)
    other = np.argmax(lengths > 0.5)
    return directions[0], normals[other] / lengths[other]


def _angle_around(axis, direction):
    """Angle of a direction around an axis, from the plane of the axis and z."""
    east = np.cross((0, 0, 1), axis)
    east /= np.linalg.norm(east)
    return np.arctan2(direction @ np.cross(axis, east), direction @ east)


def test_centre_is_uniform_in_the_unit_cell():
    """The lattice's primitive coordinates of a site, modulo one, are uniform."""
    primitive = SPACING / np.sqrt(2) * np.array([[0, 1, 1], [1, 0, 1], [1, 1, 0]])
    site = np.array(
        [lattice._lattice_in_sphere(SPACING, 3 * RADIUS, packings.random_stream(seed, 0))[0] for seed in range(1000)]
    )
    phase = np.linalg.solve(primitive.T, site.T) % 1
    p_values = [kstest(component, "uniform").pvalue for component in phase]
    p_values += [kstest((phase[i] + phase[j]) % 1, "uniform").pvalue for i, j in ((0, 1), (0, 2), (1, 2))]
    assert min(p_values) > (1 - CONFIDENCE) / len(p_values)
