"""Tests of the sizes of fragments (A22 eqs 28, 31-33) and of velocities between neighbours, against sums term by term."""

import numpy as np
import pytest
from written_runs import chain

from analysis.measures.fragments import *
from analysis.measures.pair_velocities import pair_velocities, root_mean_square


def chains(sizes):
    """Contact pairs of fragments that are chains of these sizes."""
    return np.concatenate(
        [np.reshape(chain(start, n), (-1, 2)) for start, n in zip(np.cumsum([0, *sizes]), sizes)]
    ).astype(int)


@pytest.mark.parametrize("seed", range(3))
def test_cumulative_distributions_of_hand_made_fragments(seed):
    """Eqs 31 to 33, summed term by term."""
    sizes = np.random.default_rng(seed).integers(1, 40, 25)
    found = fragment_sizes(fragment_labels(sizes.sum(), chains(sizes)))
    assert sorted(found) == sorted(sizes)
    n = np.bincount(sizes, minlength=200)
    for N in (1, 1.5, 2, 7, 12.99, 39, 100):
        up, down = int(np.ceil(N)), int(np.floor(N))
        assert cumulative_number(found, [N])[0] == n[up:].sum()
        assert cumulative_grains(found, [N])[0] == sum(n[k] * k for k in range(1, down + 1))
        expected = sum(n[k] * k ** (2 / 3) for k in range(1, down + 1))
        assert cumulative_cross_section(found, [N])[0] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize(
    "sizes, growth", [([200], 1.0), ([100, 100], 0.0), ([1] * 200, -0.99), ([150, 50], 0.5), ([60] + [1] * 140, -0.4)]
)
def test_growth_efficiency_from_coalescence_to_dust(sizes, growth):
    largest = fragment_sizes(fragment_labels(200, chains(sizes))).max()
    assert growth_efficiency(largest, 100, 100) == pytest.approx(growth)
    assert growth_efficiency(43957, 50000, 50000) == pytest.approx(-0.12086) and growth_efficiency(30, 20, 10) == 1.0


def test_velocities_of_neighbours_by_all_pairs():
    random = np.random.default_rng(1)
    position, velocity = random.uniform(0, 6, (80, 3)), random.normal(size=(80, 3))
    expected = []
    for i in range(80):
        for j in range(i):
            apart = position[i] - position[j]
            distance = np.linalg.norm(apart)
            if distance < 1.1:
                expected.append(-(velocity[i] - velocity[j]) @ apart / distance)
    assert len(expected) > 40
    assert np.sort(pair_velocities(position, velocity, 1.1)) == pytest.approx(np.sort(expected))
    assert np.isnan(root_mean_square([])) and root_mean_square([3.0, -4.0]) == pytest.approx(12.5**0.5)
