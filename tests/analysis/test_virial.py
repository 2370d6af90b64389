"""Virial pressure and stress against closed forms: crystals of springs, and what does not depend on the choice of images."""

import numpy as np
import pytest

from analysis.measures.virial import *

A = 2e-7
CUBIC = [(2, 0, 0), (0, 2, 0), (0, 0, 2)]
FCC = [(0, 1, 1), (0, 1, -1), (1, 0, 1), (1, 0, -1), (1, 1, 0), (1, -1, 0)]


def crystal(basis, neighbours, cells, edge):
    """(position, pairs, cell_size): `cells` cubic cells an axis, bonds to half of the neighbours (in half edges)."""
    corner = np.stack(np.meshgrid(*3 * [np.arange(cells)], indexing="ij"), axis=-1).reshape(-1, 1, 3)
    half = (2 * corner + np.array(basis)).reshape(-1, 3)
    row = {tuple(site): k for k, site in enumerate(half)}
    pairs = [(row[tuple(s)], row[tuple((s + np.array(n)) % (2 * cells))]) for s in half for n in neighbours]
    return half * edge / 2, np.array(pairs), np.full(3, cells * edge)


CRYSTALS = [([(0, 0, 0)], CUBIC, 6), ([(0, 0, 0), (0, 1, 1), (1, 0, 1), (1, 1, 0)], FCC, 12)]


@pytest.mark.parametrize("basis, neighbours, contacts", CRYSTALS)
def test_crystal_under_pressure(basis, neighbours, contacts):
    """P = Z n d F/6 of n grains a volume with Z contacts of force F and length d (A24 eq 37 without its prefactor)."""
    position, pairs, cell = crystal(basis, neighbours, 4, A)
    force = np.full(len(pairs), 3e-9)
    length = np.linalg.norm(np.array(neighbours[0])) * A / 2
    density = len(position) / np.prod(cell)
    assert len(pairs) == contacts / 2 * len(position)
    expected = contacts * density * length * 3e-9 / 6
    assert contact_pressure(position, pairs, force, cell) == pytest.approx(expected, rel=1e-12)
    normal = nearest_image(position[pairs[:, 0]] - position[pairs[:, 1]], cell) / length
    stress = contact_stress(position, pairs, force[:, None] * normal, cell)
    assert stress == pytest.approx(expected * np.eye(3), rel=1e-12, abs=1e-12 * expected)


def test_stress_of_one_axis_is_the_force_on_a_face_and_sliding_does_not_press():
    """Springs along x only: the stress is the force through a plane across x over its area."""
    position, pairs, cell = crystal([(0, 0, 0)], [(2, 0, 0)], 3, A)
    force = np.tile([-2e-9, 0, 0], (len(pairs), 1))  # on the first: pulled back from its neighbour ahead
    stress = contact_stress(position, pairs, force, cell)
    assert stress[0, 0] == pytest.approx(9 * 2e-9 / (3 * A) ** 2, rel=1e-12)
    assert np.abs(stress).sum() == pytest.approx(stress[0, 0], rel=1e-12)
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
