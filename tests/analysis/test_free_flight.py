"""Whether pieces can still meet or break, against cases that one solves by hand."""

import numpy as np
import pytest

from analysis.measures.free_flight import (
    bulk_kinetic_energy,
    has_come_to_rest,
    inner_kinetic_energy,
    motion_in_pieces,
    pieces_can_meet,
)


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
    assert pieces_can_meet(*two_grains(separation, velocity, offset), time) is meets


def test_one_pair_of_many_is_found_in_every_chunk(monkeypatch):
    from analysis.measures import free_flight

    random = np.random.default_rng(1)
    away = random.normal(size=(40, 3))
    away /= np.linalg.norm(away, axis=1)[:, None]
    position, velocity = 50 * away, 3 * away
    labels, radius = np.arange(40), np.full(40, 0.1)
    for chunk in (1, 100, 10**6):
        monkeypatch.setattr(free_flight, "_CHUNK", chunk)
        assert not pieces_can_meet(position, velocity, radius, labels, 100.0)
        crossing = velocity.copy()
        crossing[39] = position[38] + 20 * velocity[38] - position[39]
        crossing[39] /= 20
        assert pieces_can_meet(position, crossing, radius, labels, 100.0)


def cluster(seed, grains=30):
    random = np.random.default_rng(seed)
    return random.normal(size=(grains, 3)), random.uniform(0.5, 2, grains), np.zeros(grains, dtype=int)


def test_rigid_motion_is_no_inner_motion():
    position, mass, labels = cluster(1)
    velocity = np.array([1.0, 2, 3]) + np.cross([0.3, -0.2, 0.5], position)
    assert np.abs(motion_in_pieces(position, velocity, mass, labels)).max() < 1e-12
    assert inner_kinetic_energy(position, velocity, mass, labels)[0] < 1e-24


def test_pieces_of_one_and_two_grains_turn_too():
    position = np.array([[0.0, 0, 0], [5, 0, 0], [7, 0, 0]])
    velocity = np.array([[1.0, 1, 1], [0, 1, 0], [0, -1, 0]])
    labels, mass = np.array([1, 0, 0]), np.ones(3)
    assert np.abs(motion_in_pieces(position, velocity, mass, labels)).max() < 1e-12
    stretched = velocity + np.array([[0, 0, 0], [-1, 0, 0], [1, 0, 0]])
    assert inner_kinetic_energy(position, stretched, mass, labels) == pytest.approx([1.0, 0.0])


def test_halves_that_are_drawn_apart():
    position, mass, labels = cluster(2)
    half = (position[:, 0] > 0).astype(int)
    still = np.zeros_like(position)
    drawn = still + 0.1 * (2 * half - 1)[:, None] * (1, 0, 0)
    whole = [mass[half == k].sum() for k in (0, 1)]
    reduced = whole[0] * whole[1] / sum(whole)
    energy = bulk_kinetic_energy(position, drawn, mass, labels, half)[0]
    assert 0.5 < energy / (0.5 * reduced * 0.2**2) <= 1 + 1e-12  # what is not turning
    assert bulk_kinetic_energy(position, still, mass, labels, half)[0] == 0
    shaking = np.random.default_rng(3).normal(size=position.shape)
    assert bulk_kinetic_energy(position, shaking, mass, labels, half)[0] < inner_kinetic_energy(
        position, shaking, mass, labels
    )


@pytest.mark.parametrize("stretch, apart, ends", [(0.0, 1.0, True), (2.0, 1.0, False), (0.0, -1.0, False)])
def test_a_collision_has_come_to_rest(stretch, apart, ends):
    """Two pairs of grains that fly apart (or at each other), one of which is being stretched."""
    state = {
        "position": np.array([[0.0, 0, 0], [2, 0, 0], [20, 0, 0], [22, 0, 0]]),
        "velocity": np.array([[-stretch, 0, 0], [stretch, 0, 0], [apart, 0, 0], [apart, 0, 0]]),
        "radius": np.ones(4),
        "aggregate": np.array([0, 0, 1, 1]),
        "contact_pairs": np.array([[0, 1], [2, 3]]),
    }
    assert has_come_to_rest(state, np.ones(4), breaking=1.0, time=1e3) is ends
