"""Orientation and lattice phase are uniform: tests at 99.9 % confidence each, of fixed seeds."""

import numpy as np
from of_ice import OVERLAP, RADIUS, SPACING
from scipy.stats import ks_2samp, kstest

from yade_scripts import packings
from yade_scripts.packings import lattice

CONFIDENCE = 0.999


def test_orientation_is_uniform():
    """x^4 + y^4 + z^4 of each axis in the lattice's own frame is distributed as that of random directions.

    That is the lowest function that sees the orientation of a cubic lattice whichever of its 24 equal orientations is
    counted. From the six directions of contacts, u = (1, +/-1, 0)/sqrt 2 and so on: the sum of (u.e)^4 is (3 - that)/2.
    """
    found = 3 - 2 * np.array([(_bond_directions(seed) ** 4).sum(axis=0) for seed in range(1500)])
    random = np.random.default_rng(1).normal(size=(3, 100_000))
    expected = (random**4).sum(axis=0) / (random**2).sum(axis=0) ** 2
    p_values = [ks_2samp(of_axis, expected).pvalue for of_axis in found.T]
    assert min(p_values) > (1 - CONFIDENCE) / len(p_values)


def _bond_directions(seed):
    """The six directions (6,3) along which grains touch."""
    packing = packings.cpe(0.5, 5 * RADIUS, RADIUS, OVERLAP, seed, 0)
    pairs = packings.contacts(packing)
    directions = (packing.position[pairs[:, 1]] - packing.position[pairs[:, 0]]) / SPACING
    distinct = []
    for direction in directions:
        if all(abs(direction @ other) < 0.9 for other in distinct):
            distinct.append(direction)
    assert len(distinct) == 6
    return np.array(distinct)


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
