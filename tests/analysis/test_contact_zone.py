"""How many grains are at the place where two aggregates meet."""

import numpy as np
import pytest

from analysis.measures.structure import zone_filling, zone_volume
from analysis.studies.elastoplastic.measure import zones_that_meet
from yade_scripts import packings


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
    left, right = (zone_filling(hole, np.zeros(3), 5.0, side, 0.5, 0.5) for side in (-1.0, 1.0))
    assert left == 0.0 < right


def test_both_aggregates_count_at_the_pole_where_they_meet():
    """A ball of grains and its copy: removing what is in the zone of the second leaves half; the far pole does not matter."""
    radius, grain = 8.0, 1.0
    ball = packings.cpe(0.6, radius, 1.0, 0.0, seed=1).position
    centre = np.array([radius + grain, 0.0, 0.0])
    polar = np.hypot(ball[:, 1], ball[:, 2]) < 0.25 * radius
    near, far = (np.flatnonzero(polar & (side * ball[:, 0] > 0.75 * radius)) for side in (-1, 1))

    def filling(second):
        position = np.concatenate([ball - centre, second + centre])
        aggregate = np.repeat([0, 1], [len(ball), len(second)])
        return zones_that_meet(position, aggregate, radius, grain)

    whole, one = filling(ball), zone_filling(ball, np.zeros(3), radius, 1.0)
    assert filling(np.delete(ball, near, axis=0)) == pytest.approx(one / 2)
    without_far = one / 2 + (whole - one / 2) * len(ball) / (len(ball) - len(far))
    assert filling(np.delete(ball, far, axis=0)) == pytest.approx(without_far)
