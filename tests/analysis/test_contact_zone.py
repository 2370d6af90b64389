"""What packings say before they collide, and the return phase."""

import numpy as np
import pytest
from small_collision import cluster

from analysis.measures.contact_zone import bond_direction, loose_fraction, rigid_approach, zone_filling, zone_volume
from analysis.measures.return_phase import largest_return_speed
from analysis.studies.collision_points import return_values
from analysis.studies.elastoplastic.start import start_values


@pytest.mark.parametrize(("depth", "width"), [(0.25, 0.25), (0.02, 0.4), (1.9, 0.5), (2.0, 0.3)])
def test_volume_of_the_zone_is_what_random_points_find(depth, width):
    """A million points in a sphere: the fraction inside to five standard errors."""
    random = np.random.default_rng(1)
    points = random.uniform(-1, 1, (2_000_000, 3))
    points = points[np.einsum("ij,ij->i", points, points) < 1.0]
    inside = np.mean((points[:, 0] > 1.0 - depth) & (np.hypot(points[:, 1], points[:, 2]) < width))
    expected = zone_volume(1.0, depth, width) / (4 * np.pi / 3)
    assert inside == pytest.approx(expected, abs=5 * np.sqrt(expected * (1 - expected) / len(points)))


def test_filling_of_the_zone_is_one_in_the_mean_and_sees_holes():
    """40 random packings of 1,000 points in a sphere: 1 to four standard errors of their mean; without points in the zone 0,
    with those of the zone doubled nearly 2."""
    random, found = np.random.default_rng(2), []
    for _ in range(40):
        x = random.normal(size=(1000, 3))
        x *= (random.uniform(size=1000) ** (1 / 3) / np.linalg.norm(x, axis=1))[:, None] * 5.0
        found.append(zone_filling(x + [3.0, 0, 0], [3.0, 0, 0], 5.0, -1.0, 0.5, 0.5))
    assert np.mean(found) == pytest.approx(1.0, abs=4 * np.std(found) / 40**0.5)
    hole = x[~((x[:, 0] < -2.5) & (np.hypot(x[:, 1], x[:, 2]) < 2.5))]
    assert (
        zone_filling(hole, np.zeros(3), 5.0, -1.0, 0.5, 0.5)
        == 0.0
        < zone_filling(hole, np.zeros(3), 5.0, 1.0, 0.5, 0.5)
    )


@pytest.mark.parametrize(("axis", "expected"), [((1, 0, 0), 1 / 6), ((1, 1, 0), 5 / 24), ((1, 1, 1), 2 / 9)])
def test_direction_of_a_face_centred_lattice(axis, expected):
    bonds = np.array([(a, b, 0) for a in (1, -1) for b in (1, -1)], dtype=float)
    bonds = np.concatenate([bonds, bonds[:, [0, 2, 1]], bonds[:, [2, 0, 1]]])
    along = np.array(axis) / np.linalg.norm(axis)
    across = np.linalg.svd(along[None])[2][1:]
    turned = np.concatenate([[[0, 0, 0]], bonds @ np.vstack([along, across]).T])
    pairs = [[0, k] for k in range(1, 13)]
    assert bond_direction(turned, pairs) == pytest.approx(expected, rel=1e-12)
    assert np.isnan(bond_direction(turned, []))


@pytest.mark.parametrize("number", [1, 7, 60])
def test_rigid_approach_is_what_all_pairs_say(number):
    """Two random clouds, each moved towards the other until so many pairs are close; deep grains count too."""
    random = np.random.default_rng(number)
    first, second = random.uniform(-4, 0, (150, 3)), random.uniform(0, 4, (150, 3)) + [3.0, -4.0, -4.0]
    first[:, 0] *= 5
    found = rigid_approach(first, second, 1.0, number)
    for approach, closer in ((found * (1 - 1e-9), number - 1), (found * (1 + 1e-9), number)):
        # a pair counts once it has come within reach, also when the grains have passed each other
        aside = np.hypot(*(first[:, None, 1:] - second[None, :, 1:]).transpose(2, 0, 1))
        gap = second[None, :, 0] - first[:, None, 0] - np.sqrt(np.maximum(1.0 - aside**2, 0.0))
        assert ((aside <= 1.0) & (gap <= approach)).sum() == closer
    assert np.isnan(rigid_approach(first, second + [0.0, 50.0, 0.0], 1.0, 1))


def test_rigid_approach_of_two_rows():
    """Three grains in a row behind each other, head on to one."""
    row = np.array([[0.0, 0, 0], [-2, 0, 0], [-4, 0, 0]])
    assert rigid_approach(row, [[5.0, 0, 0]], 2.0, 1) == pytest.approx(3.0)
    assert rigid_approach(row, [[5.0, 1.2, 0]], 2.0, 2) == pytest.approx(7.0 - 1.6)


def test_loose_grains():
    assert loose_fraction(5, [[0, 1], [1, 2]]) == pytest.approx(0.4) and loose_fraction(3, []) == pytest.approx(2 / 3)


def test_both_aggregates_count_at_the_pole_where_they_meet():
    """A ball of grains and its copy: removing what is in the zone of the second leaves half; the far pole does not matter."""
    radius, grain = 8.0, 1.0
    ball = cluster(radius) / 1e-7
    centre = np.array([radius + grain, 0.0, 0.0])
    near = ((ball[:, 0] < -0.75 * radius) & (np.hypot(ball[:, 1], ball[:, 2]) < 0.25 * radius)).nonzero()[0]
    far = ((ball[:, 0] > 0.75 * radius) & (np.hypot(ball[:, 1], ball[:, 2]) < 0.25 * radius)).nonzero()[0]

    def filling(second):
        position = np.concatenate([ball - centre, second + centre])
        aggregate = np.repeat([0, 1], [len(ball), len(second)])
        return start_values(position, aggregate, [], radius, grain)["zone_filling"]

    whole, one = filling(ball), zone_filling(ball, np.zeros(3), radius, 1.0)
    assert filling(np.delete(ball, near, axis=0)) == pytest.approx(one / 2)
    assert filling(np.delete(ball, far, axis=0)) == pytest.approx(
        one / 2 + (whole - one / 2) * len(ball) / (len(ball) - len(far))
    )


def test_largest_return_speed():
    """v = cos t falls to -1 at pi; what comes before the largest compression, or is still growing at the end, is not it."""
    time = np.linspace(0.0, 6.0, 601)
    speed, when = largest_return_speed(time, np.cos(time), np.pi / 2)
    assert speed == pytest.approx(1.0, abs=1e-5) and when == pytest.approx(np.pi, abs=0.01)
    assert largest_return_speed(time[:300], np.cos(time[:300]), np.pi / 2) == (None, None)
    assert largest_return_speed(time, np.abs(np.cos(time)), np.pi / 2) == (None, None)
    gap = np.cos(time)
    gap[313:316] = np.nan
    assert largest_return_speed(time, gap, np.pi / 2)[0] == pytest.approx(1.0, abs=1e-3)
    assert np.isnan(return_values({"time": time[:9], "v": np.ones(9)}, 0.0)["return_speed"])
