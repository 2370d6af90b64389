"""Virial pressure against closed forms: springs along one axis, and what does not depend on the choice of images."""

import numpy as np
import pytest
from written_runs import cubic_lattice

from analysis.measures.periodic_cell import *

A = 2e-7


def test_pressure_of_springs_along_one_axis():
    """A third of the force through a plane across x over its area."""
    site, pairs = cubic_lattice(3)
    pressure = contact_pressure(A * site, pairs[::3], np.full(27, 2e-9), np.full(3, 3 * A))
    assert pressure == pytest.approx(9 * 2e-9 / (3 * A) ** 2 / 3, rel=1e-12)


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
