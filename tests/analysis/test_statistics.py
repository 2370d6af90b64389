"""Errors and intervals.

Random seeds are fixed; a statistical bound says how often it would fail for other seeds."""

import numpy as np
import pytest

from analysis.statistics import *

_VELOCITIES = tuple(10 ** (0.1 * i) for i in range(8))


def test_mean_and_error():
    assert mean_and_error([1.0, 2.0, 6.0]) == (3.0, pytest.approx((14 / 2 / 3) ** 0.5))
    assert mean_and_error([4.0]) == (4.0, None)


def test_a_ratio_of_means_and_its_error():
    """Over a constant it is a mean's; of draws that are correlated it is smaller than of independent ones."""
    values = [1.0, 2.0, 6.0]
    assert ratio_and_error(values, [2.0, 2.0, 2.0]) == pytest.approx(np.array(mean_and_error(values)) / 2)
    draws = np.random.default_rng(3)
    below = draws.normal(10.0, 1.0, 400)
    above = 3 * below + draws.normal(0.0, 0.5, 400)
    together = ratio_and_error(above, below)
    assert together == (pytest.approx(3.0, abs=0.01), pytest.approx(0.5 / 10 / 20, rel=0.2))
    apart = ratio_of_two(mean_and_error(above), mean_and_error(below))
    assert apart[0] == pytest.approx(together[0]) and apart[1] == pytest.approx(0.3 * 2**0.5 / 20, rel=0.2)
    assert ratio_and_error([1.0, 2.0], [0.0, 3.0]) == (1.0, None)  # one draw left out leaves nothing below
    assert np.isnan(ratio_and_error([1.0, 2.0], [0.0, 0.0])[0]) and np.isnan(ratio_of_two((1.0, 0.1), (0.0, 0.0))[0])


@pytest.mark.parametrize("value", [0.1, 1e-9, 3e7])
def test_numbers_that_agree_to_rounding_have_no_scatter(value):
    """Whether their mean is exact depends on the processor."""
    same = [value, np.nextafter(value, 1e9), value, np.nextafter(value, 0.0), value]
    assert scatter(same) == 0.0 and resampling_error(same) == 0.0
    assert mean_and_error(same)[1] == 0.0 and np.isnan(scatter([value, np.nan]))
    assert scatter([0.0, 0.0, 0.0]) == 0.0 and np.isnan(scatter([value]))
    assert scatter([value, value * (1 + 1e-9)]) == pytest.approx(value * 1e-9 / 2**0.5, rel=1e-5)
    assert np.all(np.isnan(smoothed_scatter(np.ones(3), np.array([scatter(same)] * 3), np.full(3, 5))))


def test_errors_of_resamples():
    random = np.random.default_rng(0)
    normal = random.normal(5.0, 2.0, 20000)
    assert resampling_error(normal) == pytest.approx(2.0, rel=0.03)  # six standard errors
    assert percentile_error(normal) == pytest.approx(2.0, rel=0.05)
    unbounded = np.where(np.arange(20000) % 4 == 0, np.inf, normal)
    assert percentile_error(unbounded) is None and resampling_error(unbounded) == pytest.approx(2.0, rel=0.03)
    assert resampling_error([np.inf, 1.0]) is None


def test_weighted_deviations_have_the_variance_of_a_mean():
    """20,000 draws for three values: s^2/n with n - 1 degrees of freedom, to some per cent."""
    sample = np.array([1.0, 2.0, 6.0])
    found = weighted_deviations(sample, np.random.default_rng(1).exponential(size=(20000, 3)))
    assert found.mean() == pytest.approx(0.0, abs=0.06) and found.var() == pytest.approx(7 / 3, rel=0.05)


def test_smoothed_scatter_follows_a_power_without_bias():
    """s ~ v^-1 from three seeds at eight velocities, 400 times: the mean logarithm is right to 3.3 standard
    errors."""
    random, v = np.random.default_rng(11), np.array(_VELOCITIES)
    found = [smoothed_scatter(v, random.normal(size=(3, 8)).std(axis=0, ddof=1) / v, np.full(8, 3)) for _ in range(400)]
    logs = np.log(found)
    assert np.all(np.abs(logs.mean(axis=0) + np.log(v)) < 3.3 * logs.std(axis=0) / 20)


def test_wilsons_interval():
    assert wilson(0, 10) == pytest.approx((0.0, 0.2775), abs=1e-4)
    assert wilson(10, 10) == pytest.approx((0.7225, 1.0), abs=1e-4)
    assert wilson(5, 10) == pytest.approx((0.2366, 0.7634), abs=1e-4)


def test_restitutions_interval_covers_the_mean():
    """The mean of ten uniform numbers lies in the 95 % interval 92 % of the time or more: 300 sets, 88 % at
    least."""
    random = np.random.default_rng(14)
    inside = 0
    for _ in range(300):
        low, high = student_interval(random.uniform(0.2, 0.6, 10))
        inside += low < 0.4 < high
    assert inside / 300 > 0.88
    assert student_interval([0.3]) == (None, None)
    reach = 4.3027 / 3**0.5  # t of two degrees of freedom at 97.5 %
    assert student_interval([1.0, 2.0, 3.0]) == pytest.approx((2 - reach, 2 + reach), rel=1e-4)


def test_numbers_without_scatter_have_no_interval():
    """Six runs that stick all have a restitution of 0: that is no measurement of an error of 0."""
    assert student_interval([0.0] * 6) == (None, None)
    assert student_interval([0.1 + 0.2, 0.3, 0.3]) == (None, None)


def test_few_seeds_are_judged_by_students_t():
    """1,000 sets of three normal numbers: how often their mean is more than 3.8 of their own errors off is the chance that
    student_chance gives, 6.3 % +- 2.5 % at 99.9 %; the normal distribution says 0.01 %."""
    random = np.random.default_rng(15)
    pulls = [mean / error for mean, error in (mean_and_error(random.normal(size=3)) for _ in range(1000))]
    found = np.mean(np.abs(pulls) > 3.8)
    assert found == pytest.approx(student_chance(3.8, 2), abs=0.025)
    assert student_chance(3.8, 2) == pytest.approx(0.063, abs=1e-3)
    assert student_chance(-1.96, 10**6) == pytest.approx(0.05, abs=1e-4)


def test_a_pair_has_one_weight_in_all_its_runs():
    weights = pair_weights(["a", "b", "a", "c"], 50, 1)
    assert weights.shape == (50, 4) and np.array_equal(weights[:, 0], weights[:, 2])
    assert not np.array_equal(weights[:, 0], weights[:, 1])
    means = group_means(np.array([1.0, 3.0, 5.0]), np.array([0, 0, 1]), np.array([[1.0, 3.0, 2.0]]))
    assert means.tolist() == [[2.5, 2.5, 5.0]]
