"""Size distributions, means over B_off, thresholds and fits (A22 eqs 28-42) against made data; velocities of neighbours."""

import numpy as np
import pandas
import pytest

from analysis.measures.fragments import (
    cumulative_cross_section,
    cumulative_grains,
    cumulative_number,
    fragment_labels,
    fragment_sizes,
    growth_efficiency,
)
from analysis.measures.pair_velocities import pair_velocities, root_mean_square
from analysis.studies.viscous.impact_mean import Draws, at_impacts, impact_mean, impact_weights
from analysis.studies.viscous.measure import sizes_from_text, sizes_text
from analysis.studies.viscous.size_distribution import (
    fit_power_law,
    fitted_curves,
    power_law_with_errors,
    size_distribution,
    whole_numbers,
)
from analysis.studies.viscous.threshold import threshold_velocity

TWELFTHS = np.arange(13) / 12


def chains(sizes):
    """Contact pairs of fragments that are chains of these sizes."""
    ends = np.concatenate([[0], np.cumsum(sizes)])
    return np.array([[k, k + 1] for a, b in zip(ends, ends[1:]) for k in range(a, b - 1)]).reshape(-1, 2)


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


def test_sizes_as_text_and_back():
    sizes = np.random.default_rng(1).integers(1, 9, 50)
    assert sorted(sizes_from_text(sizes_text(sizes))) == sorted(sizes)
    with pytest.raises(ValueError):
        sizes_from_text("3 fragments")


def test_weights_are_exact_for_one_and_for_the_square():
    weights = impact_weights(TWELFTHS)
    assert weights.sum() == pytest.approx(1, rel=1e-14)  # <1> = 1
    assert weights @ TWELFTHS == pytest.approx(1 / 2, rel=1e-14)  # <B^2> = int 2 B B^2 dB
    assert weights[1:-1] == pytest.approx(1 / 12) and weights[[0, -1]] == pytest.approx(1 / 24)
    uneven = np.array([0, 0.1, 0.5, 1.0])
    assert impact_weights(uneven) @ (3 - 2 * uneven) == pytest.approx(2, rel=1e-14)
    # of B^4 the trapezoidal rule has the error h^2/6
    assert weights @ TWELFTHS**2 - 1 / 3 == pytest.approx(1 / 12**2 / 6, rel=1e-9)


@pytest.mark.parametrize("squares", [[0, 0.5], [0, 0.5, 0.9], [0.1, 0.5, 1], [0, 0.5, 0.4, 1]])
def test_weights_need_the_whole_range(squares):
    with pytest.raises(ValueError, match="must rise from 0 to 1"):
        impact_weights(squares)


def made_table(growth, seeds, velocities=(10**1.7,), scatter=0.0, random=None, squares=TWELFTHS):
    """Runs whose f_gro is growth(B^2, v) and scatters, half of the variance common to a pair."""
    common = {seed: random.normal() if scatter else 0.0 for seed in seeds}
    rows = []
    for velocity in velocities:
        for square in squares:
            for seed in seeds:
                noise = scatter * np.sqrt(0.5) * (common[seed] + (random.normal() if scatter else 0.0))
                rows.append(
                    dict(impact=square**0.5, velocity=velocity, seed=seed, growth=growth(square, velocity) + noise)
                )
    return pandas.DataFrame(rows)


def test_mean_of_a_table_and_its_errors():
    table = made_table(lambda square, _: 1 - 2 * square, (1, 2, 3))
    mean, resamples = impact_mean(table, table.growth, Draws(table.seed))
    assert mean == pytest.approx(0, abs=1e-14) and np.abs(resamples).max() < 1e-12
    assert impact_mean(table[table.impact > 0], table.growth[table.impact > 0], Draws(table.seed)) is None
    assert [len(samples) for _, samples, _ in at_impacts(table, table.growth)] == [3] * 13


def test_errors_are_those_of_many_studies():
    """The bootstrap's error beside the scatter of the mean over independent studies of six pairs."""
    random = np.random.default_rng(3)
    means, errors = [], []
    for _ in range(60):
        table = made_table(lambda square, _: 0.0, range(6), scatter=0.3, random=random)
        mean, resamples = impact_mean(table, table.growth, Draws(table.seed, 300))
        means.append(mean)
        errors.append(resamples.std())
    assert np.sqrt(np.mean(np.square(errors))) / np.std(means) == pytest.approx(1, abs=0.25)


def test_threshold_of_made_data():
    """f_gro falls linearly in ln v through 0 at 55 m/s, whatever the velocities of the runs."""
    velocities = 10 ** (0.1 * np.arange(13, 21))
    growth = 0.7 * np.log(55.0 / velocities)
    assert threshold_velocity(velocities, growth) == pytest.approx(55, rel=1e-12)
    shifted = np.stack([growth, growth + 0.07, growth - 5, growth + 5])
    found = threshold_velocity(velocities, shifted)
    assert found[:2] == pytest.approx([55, 55 * np.exp(0.1)]) and np.isnan(found[2:]).all()
    assert np.isnan(threshold_velocity([10.0], np.array([0.5])))


def test_the_first_fall_counts():
    assert threshold_velocity([1.0, 10.0, 100.0, 1000.0], [1.0, -1.0, 1.0, -1.0]) == pytest.approx(10**0.5)


@pytest.mark.parametrize("exponent, amplitude", [(1.0, 1.0), (0.6, 2.0), (1.5, 30.0)])
def test_fits_recover_the_law(exponent, amplitude):
    """N_cum of the law itself, eq 41."""
    numbers = whole_numbers(5000)
    grains = amplitude * numbers ** (2 - exponent) / (2 - exponent)
    assert fit_power_law(numbers, grains) == pytest.approx((exponent, amplitude), rel=1e-9)
    noise = np.exp(0.1 * np.random.default_rng(1).normal(size=(200, 1)))
    law = power_law_with_errors(numbers, grains, grains * noise)
    assert law.exponent_error < 1e-9 and law.amplitude_error / amplitude == pytest.approx(0.1, rel=0.2)
    assert fit_power_law(numbers, np.zeros(len(numbers))) == (None, None)


def test_fits_recover_fragments_of_one_over_n():
    """Fragments drawn from f(N) = 1/N (Poisson numbers n(N) of that mean), many runs: eqs 35 to 38."""
    random, total = np.random.default_rng(2), 2000
    rows = []
    for seed in range(40):
        for square in (0.0, 0.5, 1.0):
            number = random.poisson(1 / np.arange(1, total // 4 + 1))
            sizes = np.repeat(np.arange(1, total // 4 + 1), number)
            text = sizes_text(np.append(sizes, max(1, total - sizes.sum())))
            rows.append(dict(grains=total // 2, impact=square**0.5, seed=seed, fragments=text))
    table = pandas.DataFrame(rows)
    found = size_distribution(table, Draws(table.seed, 200))
    law = found.power_law
    assert abs(law.exponent - 1) < 4 * law.exponent_error < 0.5
    assert abs(law.amplitude - 1) < 4 * law.amplitude_error < 1
    low = found.numbers < 100
    number, grains, section = (values[low] for values in fitted_curves(found.numbers, total // 4))
    assert found.number[low] - 1 == pytest.approx(number, abs=1)
    assert found.grains[low][5:] == pytest.approx(grains[5:], rel=0.3)
    assert found.cross_section[low][5:] == pytest.approx(section[5:], rel=0.35)


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
