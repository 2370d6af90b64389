"""The time until two packings touch, against all pairs of grains and against a collision of two spheres."""

import numpy as np
import pytest

from yade_scripts import packings
from yade_scripts.packings.approach import first_touch

OVERLAP = 1e-9


def by_all_pairs(first, second, velocity):
    """The same by a quadratic equation for every pair."""
    apart = (first.position[:, None] - second.position[None]).reshape(-1, 3)
    radii = (first.radius[:, None] + second.radius[None]).ravel()
    a, b = velocity @ velocity, apart @ velocity
    root = b**2 - a * (np.einsum("ij,ij->i", apart, apart) - radii**2)
    times = ((b - np.sqrt(np.where(root < 0, np.nan, root))) / a)[(root >= 0) & (b > 0)]
    return times.min() if times.size else None


def grain(x, y=0.0, radius=1e-7):
    return packings.Packing(np.array([[x, y, 0.0]]), np.array([radius]), 0)


def test_two_grains_by_hand():
    """Head-on: the gap over the speed; off by b: 2r cos(asin(b/2r)); beside each other, or moving apart: never."""
    velocity = np.array([-2.0, 0.0, 0.0])
    assert first_touch(grain(0), grain(1e-6), velocity) == pytest.approx(8e-7 / 2, rel=1e-12)
    offset = first_touch(grain(0), grain(1e-6, 1.2e-7), velocity)
    assert offset == pytest.approx((1e-6 - np.sqrt(4 - 1.44) * 1e-7) / 2, rel=1e-12)
    assert first_touch(grain(0), grain(1e-6, 2.01e-7), velocity) is None
    assert first_touch(grain(0), grain(1e-6), -velocity) is None
    assert first_touch(grain(0), grain(3e-7, radius=2e-7), velocity) == pytest.approx(0, abs=1e-15)


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("planar", [False, True])
def test_bcca_clusters_in_any_direction(seed, planar):
    pair = [packings.bcca(60, 1e-7, OVERLAP, seed, index, planar) for index in (0, 1)]
    random = np.random.default_rng(seed)
    velocity = random.normal(size=3) * (1, 1, 0 if planar else 1)
    across = np.cross(velocity, (0, 0, 1))
    offset = random.uniform(0, 0.5) * sum(map(packings.extent, pair))
    start = -100e-7 * velocity / np.linalg.norm(velocity) + offset * across / np.linalg.norm(across)
    pair[1] = packings.moved(pair[1], start)
    found, expected = first_touch(*pair, velocity), by_all_pairs(*pair, velocity)
    assert (found is None) == (expected is None) and found == (expected and pytest.approx(expected, rel=1e-9))


@pytest.mark.parametrize("impact", [0.0, 0.5, 0.9, 1.0])
def test_cpe_aggregates(impact):
    pair = [packings.cpe(0.4, 8e-7, 1e-7, OVERLAP, 3, index) for index in (0, 1)]
    pair[1] = packings.moved(pair[1], (18e-7, impact * 18e-7, 0))
    velocity = np.array([-3.0, 0.0, 0.0])
    found, expected = first_touch(*pair, velocity), by_all_pairs(*pair, velocity)
    assert (found is None) == (expected is None) == (impact == 1.0)
    assert found is None or found == pytest.approx(expected, rel=1e-9)
