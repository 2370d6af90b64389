"""Whether pieces can still meet or break, against cases that one solves by hand."""

import numpy as np
import pytest

from analysis.measures import motion
from analysis.measures.motion import *


def two_grains(separation, velocity, offset=0.0):
    position = np.array([[0.0, 0, 0], [separation, offset, 0]])
    return position, np.array([[0.0, 0, 0], [velocity, 0, 0]]), np.ones(2), np.array([0, 1])


@pytest.mark.parametrize(
    "separation, velocity, offset, time, meets",
    [
        (10, -1.0, 0, 100, True),
        (10, -1.0, 0, 7.9, False),  # touch after 8
        (10, -1.0, 0, 8.1, True),
        (10, 1.0, 0, 100, False),
        (10, -1.0, 1.99, 100, True),
        (10, -1.0, 2.01, 100, False),
        (10, 0.0, 0, 1e9, False),
        (1.9, 5.0, 0, 1, True),  # the spheres around them overlap now
    ],
)
def test_two_grains(separation, velocity, offset, time, meets):
    grains = two_grains(separation, velocity, offset)
    assert pieces_can_meet(*grains, time) is meets
    assert [pieces_that_can_meet(piece, *grains, time).tolist() for piece in (0, 1)] == [[False, meets], [meets, False]]


def test_one_pair_of_many_is_found_in_every_chunk(monkeypatch):
    random = np.random.default_rng(1)
    away = random.normal(size=(40, 3))
    away /= np.linalg.norm(away, axis=1)[:, None]
    position, velocity = 50 * away, 3 * away
    labels, radius = np.arange(40), np.full(40, 0.1)
    for chunk in (1, 100, 10**6):
        monkeypatch.setattr(motion, "_CHUNK", chunk)
        assert not pieces_can_meet(position, velocity, radius, labels, 100.0)
        crossing = velocity.copy()
        crossing[39] = position[38] + 20 * velocity[38] - position[39]
        crossing[39] /= 20
        assert pieces_can_meet(position, crossing, radius, labels, 100.0)


def test_rigid_motion_is_no_inner_motion_of_one_and_two_grains_either():
    random = np.random.default_rng(1)
    position, mass, labels = random.normal(size=(30, 3)), random.uniform(0.5, 2, 30), np.zeros(30, dtype=int)
    velocity = np.array([1.0, 2, 3]) + np.cross([0.3, -0.2, 0.5], position)
    assert np.abs(motion_in_pieces(position, velocity, mass, labels)).max() < 1e-12
    assert inner_kinetic_energy(position, velocity, mass, labels)[0] < 1e-24
    position = np.array([[0.0, 0, 0], [5, 0, 0], [7, 0, 0]])
    velocity = np.array([[1.0, 1, 1], [0, 1, 0], [0, -1, 0]])
    labels, mass = np.array([1, 0, 0]), np.ones(3)
    assert np.abs(motion_in_pieces(position, velocity, mass, labels)).max() < 1e-12
    stretched = velocity + np.array([[0, 0, 0], [-1, 0, 0], [1, 0, 0]])
    assert inner_kinetic_energy(position, stretched, mass, labels) == pytest.approx([1.0, 0.0])
