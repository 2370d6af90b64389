"""Virial pressure and stress against closed forms: springs along one axis, and what does not depend on the choice of images."""

import numpy as np
import pytest
from written_runs import cubic_lattice

from analysis.measures.virial import *

A = 2e-7


def test_stress_of_one_axis_is_the_force_on_a_face_and_sliding_does_not_press():
    """Springs along x only: the stress is the force through a plane across x over its area (crystals of contacts: tests/physics)."""
    site, pairs = cubic_lattice(3)
    pairs = pairs[::3]
    force = np.tile([-2e-9, 0, 0], (27, 1))  # on the first: pushed back from its neighbour ahead
    stress = contact_stress(A * site, pairs, force, np.full(3, 3 * A))
    assert stress[0, 0] == pytest.approx(9 * 2e-9 / (3 * A) ** 2, rel=1e-12)
    assert np.abs(stress).sum() == pytest.approx(stress[0, 0], rel=1e-12)
    pressure = contact_pressure(A * site, pairs, np.full(27, 2e-9), np.full(3, 3 * A))
    assert pressure == pytest.approx(np.trace(stress) / 3, rel=1e-12)
    random = np.random.default_rng(4)
    position, cell = random.uniform(0, 1, (30, 3)), np.ones(3)
    pairs = random.integers(0, 30, (60, 2))
    pairs = pairs[pairs[:, 0] != pairs[:, 1]]
    separation = nearest_image(position[pairs[:, 0]] - position[pairs[:, 1]], cell)
    across = np.cross(separation, random.normal(size=separation.shape))
    stress = contact_stress(position, pairs, across, cell)
    assert np.abs(stress).max() > 1 and abs(np.trace(stress)) < 1e-12 * np.abs(stress).max()


def test_images_do_not_matter():
    """Grains moved by whole edges, with their velocities as K13 eqs 8-11 have them, give the same pressures."""
    random = np.random.default_rng(5)
    cell, rate = np.array([1.0, 1.2, 1.5]), np.array([-0.3, -0.2, 0.1])
    position, velocity, mass = random.uniform(-0.4, 0.4, (20, 3)), random.normal(size=(20, 3)), random.uniform(1, 2, 20)
    image = random.integers(-2, 3, (20, 3))
    elsewhere, faster = position + image * cell, velocity + image * rate * cell
    assert cell_velocity(elsewhere, faster, cell, rate) == pytest.approx(velocity, abs=1e-12)
    one, other = (kinetic_pressure(mass, x, v, cell, rate) for x, v in ((position, velocity), (elsewhere, faster)))
    assert one == pytest.approx((mass * (velocity**2).sum(axis=1)).sum() / 3 / 1.8, rel=1e-12)
    assert other == pytest.approx(one, rel=1e-12)
    pairs = random.integers(0, 20, (30, 2))
    forces = random.normal(size=30)
    first, second = (contact_pressure(x, pairs, forces, cell) for x in (position, elsewhere))
    assert second == pytest.approx(first, rel=1e-9)
    assert filling_factor([1.0, 1.0], [4.0, 4.0, 4.0]) == pytest.approx(2 * 4 / 3 * np.pi / 64)
