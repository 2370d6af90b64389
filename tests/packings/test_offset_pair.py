"""Two aggregates in their places (A22 section 2.4, eq 27): offset, momentum, and the time until they touch."""

import numpy as np
import pytest
from of_ice import OVERLAP, RADIUS

from yade_scripts import packings
from yade_scripts.experiments.collision import CollisionParameters, place
from yade_scripts.packings.placing import START_GAP, first_touch, offset_pair


def centre(packing):
    return np.average(packing.position, axis=0, weights=packing.radius**3)


@pytest.mark.parametrize("kind", [packings.bpca, packings.bcca])
@pytest.mark.parametrize("impact", [0.0, 0.4, 0.7])
@pytest.mark.parametrize("grains", [(120, 120), (200, 40)])
def test_offset_is_that_of_the_characteristic_radii(kind, impact, grains):
    pair = [kind(number, RADIUS, OVERLAP, 5, index) for index, number in enumerate(grains)]
    (target, projectile), (of_target, of_projectile) = offset_pair(*pair, 30.0, impact)
    apart = centre(projectile) - centre(target)
    expected = impact * sum(map(packings.characteristic_radius, pair))
    assert apart[1] == pytest.approx(expected, rel=1e-9, abs=1e-18) and abs(apart[2]) < 1e-18 and apart[0] > 0
    assert of_projectile - of_target == pytest.approx([-30.0, 0, 0])
    mass = [(packing.radius**3).sum() for packing in pair]
    momentum = mass[0] * of_target + mass[1] * of_projectile
    assert np.abs(momentum).max() < 1e-12 * 30 * sum(mass)
    both = mass[0] * centre(target) + mass[1] * centre(projectile)
    assert np.abs(both).max() / sum(mass) < 1e-9 * RADIUS
    touch = first_touch(target, projectile, of_projectile - of_target)
    if touch is not None:
        assert touch * 30.0 == pytest.approx(START_GAP * RADIUS, rel=1e-6)


def test_equal_aggregates_of_cpe_stay_where_they_were_and_two_sizes_of_aggregates_and_of_grains():
    """A24 section 3: centres at -/+(R + r), the offset in units of 2 (R + r)."""
    cells = dict(packing="cpe", radius=6, filling=0.4, impact=0.5, seed=2)
    _, pair, velocities = place(CollisionParameters.parse(cells), OVERLAP)
    for index, sign in ((0, -1), (1, 1)):
        made = packings.cpe(0.4, 6 * RADIUS, RADIUS, OVERLAP, 2, index)
        assert np.allclose(pair[index].position - made.position, sign * 7 * RADIUS * np.array([1, 0.5, 0]), rtol=1e-9)
    assert velocities[0][0] == -velocities[1][0] == 10**0.5 / 2
    cells = dict(packing="bcca", grains=90, projectileGrains=30, sizes="lognormal", sizeSpread=0.2, seed=4)
    _, pair, _ = place(CollisionParameters.parse(cells), OVERLAP)
    assert [packing.grains for packing in pair] == [90, 30]
    assert len(np.unique(pair[0].radius)) == 90


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
