"""Fits on made-up collisions: the truth is recovered, and the stated errors are those that the results have.

Random seeds are fixed; a statistical bound says how often it would fail for other seeds."""

import numpy as np
import pytest
from made_collisions import MODULI, OFFSET, V, line_of, made_points
from scipy.optimize import least_squares
from written_runs import RADIUS

from analysis.studies.elastoplastic import paper
from analysis.studies.elastoplastic.moduli_search import ModuliSearch
from analysis.studies.elastoplastic.points import make_points, resampled
from analysis.studies.elastoplastic.size_fit import errors_of_design, fit_sizes, offset_from_line
from analysis.studies.elastoplastic.start_offset import common_slope, correct
from analysis.studies.elastoplastic.velocity_fit import fit_velocities, moduli_errors_of_design
from analysis.theory.andrews import (
    Spheres,
    elastic_compression,
    elastic_time,
    largest_compression,
    plastic_compression,
    plastic_time,
    time_of_largest_compression,
)

VELOCITIES = tuple(10 ** (0.1 * i) for i in range(8))


def sized(points, resamples=200, seed=1):
    return fit_sizes(points, resampled(points, resamples, seed)[0], RADIUS, V)


def fitted(points, resamples=100, seed=1, raw=False):
    return fit_velocities(points, resampled(points, resamples, seed), OFFSET, OFFSET, "known", RADIUS, 1000.0, raw)


def test_offset_is_the_papers_own_number():
    """Eq 18 as printed gives 0.267 r; the form that follows from eqs 14-19 the printed 0.271 r."""
    assert offset_from_line(paper.C1, paper.C2) == pytest.approx(paper.OFFSET[0.4], abs=5e-4)
    assert paper.C2 / (2 - paper.C1 / 2) == pytest.approx(0.267, abs=5e-4)
    c1, c2 = paper.line(0.3)
    assert offset_from_line(c1, c2) == pytest.approx(-0.010) and 2 * c1 == pytest.approx(0.199)


def test_without_scatter_the_truth_comes_out():
    points = made_points(np.random.default_rng(0), 3, scatter=0.0, velocities=VELOCITIES)
    at = points.chosen(points.velocity == V)
    assert sized(at).values == pytest.approx(line_of(), rel=1e-6)
    quiet = made_points(np.random.default_rng(0), 3, scatter=1e-6, velocities=VELOCITIES)
    assert fitted(quiet, 5).values == pytest.approx(MODULI, rel=1e-4)


def test_errors_of_the_line_are_those_it_has():
    """400 data sets of four sizes with ten seeds: the fraction within one error is 68.3 %, +- 7.7 % at 99.9 %
    confidence, one standard error of t(27) being 67.4 %."""
    random, truth = np.random.default_rng(3), line_of()
    pulls = []
    for k in range(400):
        fit = sized(made_points(random, 10, (40.0, 50.0, 60.0, 80.0)), 150, k)
        pulls.append([(fit.values[name] - truth[name]) / fit.errors[name] for name in truth])
    pulls = np.array(pulls)
    assert np.all(np.abs(np.mean(np.abs(pulls) < 1, axis=0) - 0.674) < 0.077)
    assert np.all(np.abs(pulls.mean(axis=0)) < 3.3 * 1.1 / 20)


def test_bootstrap_variance_is_right_for_three_seeds():
    """Mean of error^2 over 1,500 sets against the true variance s^2/3: 1 +- 0.12 at 99.9 % (two degrees of
    freedom each give a relative variance of 1)."""
    random, ratios = np.random.default_rng(4), []
    for k in range(1500):
        points = made_points(random, 3, (40.0,), scatter=0.3)
        ratios.append(np.var(resampled(points, 60, k)[0][:, 0], ddof=1) / (0.3 * RADIUS) ** 2 * 3)
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.12)


def test_same_pairs_at_all_velocities_are_not_taken_for_independent():
    """The mean of d_max over eight velocities, half of whose variance is the pair's: its true variance is
    s^2/n (1/2 + 1/16); independent draws would find s^2/n/8. 400 sets with 10 seeds, ratio 1 +- 0.1 at 99.9
    %."""
    random, found = np.random.default_rng(5), []
    for k in range(400):
        d_max = resampled(made_points(random, 10, (40.0,), VELOCITIES), 60, k)[0]
        found.append(np.var(d_max.mean(axis=1), ddof=1) / (0.2 * RADIUS) ** 2 * 10)
    assert np.mean(found) == pytest.approx(0.5 + 1 / 16, rel=0.1)


def test_moduli_are_recovered_within_their_errors():
    """30 data sets of two sizes, eight velocities, ten seeds. Their pulls have a root mean square of 1.2
    (t(9): 1.13), which 30 tell to +- 0.5 at 99.9 %; the fraction within one error is 65 % +- 29 %."""
    random, pulls, chi_square = np.random.default_rng(6), [], []
    for k in range(30):
        fit = fitted(made_points(random, 10, (40.0, 80.0), VELOCITIES, 0.15), 40, k)
        pulls.append((np.array(fit.values) - MODULI) / fit.errors)
        chi_square.append(fit.chi_square / fit.expected)
    pulls = np.array(pulls)
    assert np.all(np.abs(np.sqrt(np.mean(pulls**2, axis=0)) - 1.2) < 0.5)
    assert np.all(np.abs(np.mean(np.abs(pulls) < 1, axis=0) - 0.65) < 0.29)
    assert 0.6 < np.mean(chi_square) < 1.6 and 0 < fit.expected < 30 and 0 <= fit.chance <= 1


def test_weights_of_each_point_agree_with_smoothed_ones():
    points = made_points(np.random.default_rng(7), 20, (80.0,), VELOCITIES, 0.1)
    smooth, raw = fitted(points), fitted(points, raw=True)
    for i in (0, 1):
        assert raw.values[i] == pytest.approx(smooth.values[i], abs=2.0 * smooth.errors[i])


def test_spheres_that_never_yield_have_no_yield_stress():
    v = np.array(VELOCITIES)
    elastic, radius = Spheres(4e-6, 400.0, np.inf, 20e6), np.full(8, 4e-6)
    delta, tau = elastic_compression(v, elastic), elastic_time(v, elastic)
    moduli, chi_square = (a[0] for a in ModuliSearch(v, 400.0).best(delta[None], tau[None], 1e-9, 1e-9, radius[None]))
    assert moduli[0] == np.inf and moduli[1] == pytest.approx(20e6, rel=1e-5) and chi_square < 1e-6
    # Scatter may look like a little yield at the largest velocity, but the resamples know no upper bound.
    fit = fitted(made_points(np.random.default_rng(8), 10, (80.0,), VELOCITIES, 0.01, (60e6, 20e6)))
    yielding = 2 / np.pi * 20e6 * (delta[-1] / 4e-6) ** 0.5
    assert fit.values[0] > 0.8 * yielding and np.mean(np.isinf(fit.resamples[:, 0])) > 0.05
    assert fit.values[1] == pytest.approx(20e6, abs=4 * fit.errors[1])


def test_rigid_spheres_have_no_modulus():
    v, radius = np.array(VELOCITIES), np.full(8, 4e-6)
    rigid = Spheres(4e-6, 400.0, 2e6, np.inf)
    delta, tau = plastic_compression(v, rigid), np.full(8, plastic_time(v, rigid))
    moduli = ModuliSearch(v, 400.0).best(delta[None], tau[None], 1e-9, 1e-9, radius[None])[0][0]
    assert moduli[1] == np.inf and moduli[0] == pytest.approx(2e6, rel=1e-3)


def test_search_agrees_with_scipys():
    """Ten noisy sets at once against least_squares from the truth: chi square no higher, moduli the same."""
    random, v, radius = np.random.default_rng(15), np.array(VELOCITIES), np.full(8, 4e-6)
    truth = Spheres(4e-6, 400.0, *MODULI)
    delta = largest_compression(v, truth) * (1 + 0.02 * random.normal(size=(10, 8)))
    tau = time_of_largest_compression(v, truth) * (1 + 0.02 * random.normal(size=(10, 8)))
    found, chi_square = ModuliSearch(v, 400.0).best(delta, tau, 5e-9, 3e-9, np.tile(radius, (10, 1)))

    def residuals(x, k):
        spheres = Spheres(radius, 400.0, *np.exp(x))
        return np.concatenate(
            [
                (largest_compression(v, spheres) - delta[k]) / 5e-9,
                (time_of_largest_compression(v, spheres) - tau[k]) / 3e-9,
            ]
        )

    for k in range(10):
        end = least_squares(residuals, np.log(MODULI), args=(k,), method="lm", xtol=1e-12, ftol=1e-12)
        assert chi_square[k] <= 2 * end.cost * (1 + 1e-6) + 1e-6
        assert found[k] == pytest.approx(np.exp(end.x), rel=1e-3)


def test_what_cannot_be_fitted_says_why():
    one_size = made_points(np.random.default_rng(9), 3, (40.0,))
    assert "only one size, R = 40 r" in sized(one_size).reason
    assert "no size at filling 0.4 has 3 velocities (at most 1)" in fitted(one_size).reason
    alone = made_points(np.random.default_rng(9), 1, (40.0,), VELOCITIES)
    assert "no point with two seeds" in fitted(alone).reason
    assert sized(made_points(np.random.default_rng(9), 1)).errors["c1"] is None


def test_one_seed_a_point_has_no_error_however_the_resamples_round():
    """On another processor the mean of equal numbers may be off in its last digit, and their scatter 1e-17."""
    points = made_points(np.random.default_rng(9), 1)
    rounded = resampled(points, 50)[0] * (1 + 1e-16 * np.random.default_rng(0).integers(-2, 3, (50, 3)))
    fit = fit_sizes(points, rounded, RADIUS, V)
    assert fit.errors == dict.fromkeys(("c1", "c2", "offset", "ratio")) and fit.values["c1"] > 0
    assert not points.varies.any() and made_points(np.random.default_rng(9), 2).varies.all()


def test_one_seed_takes_the_scatter_of_its_size():
    random = np.random.default_rng(10)
    points = made_points(random, 12, (40.0,), VELOCITIES)
    samples = [s if k else tuple(a[:1] for a in s) for k, s in enumerate(points.samples)]
    seeds = [s if k else s[:1] for k, s in enumerate(points.seeds)]
    fewer = make_points(points.filling, points.radius, points.velocity, tuple(samples), tuple(seeds))
    spread = resampled(fewer, 2000)[0].std(axis=0)
    assert spread[0] == pytest.approx(fewer.d_scatter[0], rel=0.1) and np.isnan(fewer.raw_d_scatter[0])


def test_errors_of_a_design_are_those_of_its_fits():
    """The closed form against the scatter of 2,000 fits: 10 % is six standard errors of a standard
    deviation."""
    random, radii, truth = np.random.default_rng(12), np.array([40.0, 60.0, 80.0]), line_of()
    lines = truth["c1"] * radii - truth["c2"] + 0.2 / np.sqrt(10) * random.normal(size=(2000, 3))
    slope, negative = np.polyfit(radii, lines.T, 1)
    expected = errors_of_design(0.2, radii, 10, truth["c1"], truth["c2"])
    assert slope.std() == pytest.approx(expected["c1"], rel=0.1)
    assert negative.std() == pytest.approx(expected["c2"], rel=0.1)
    assert offset_from_line(slope, -negative).std() == pytest.approx(expected["offset"], rel=0.1)


def test_errors_of_the_moduli_of_a_design_are_those_of_its_fits():
    """The first-order errors against the scatter of 400 fits: 15 % is four standard errors of a standard deviation,
    and some more for the second order."""
    random = np.random.default_rng(16)
    radius, v = (a.ravel() for a in np.meshgrid([2e-6, 4e-6], VELOCITIES))
    truth = Spheres(radius, 400.0, *MODULI)
    errors = 3e-9, 1e-9 / v
    data = [
        model(v, truth) + error * random.normal(size=(400, 16))
        for model, error in zip((largest_compression, time_of_largest_compression), errors)
    ]
    found, chi_square = ModuliSearch(v, 400.0).best(*data, *errors, np.tile(radius, (400, 1)))
    assert found.std(axis=0) == pytest.approx(moduli_errors_of_design(MODULI, v, radius, 400.0, *errors), rel=0.15)
    assert chi_square.mean() == pytest.approx(30, abs=3.3 * (60 / 400) ** 0.5)


def test_control_variate_takes_the_offsets_scatter_away():
    """500 sets of ten: corrected values are right in the mean and scatter as stated, by less than the plain
    means."""
    random, corrected, plain, errors = np.random.default_rng(13), [], [], []
    for _ in range(500):
        offset = 0.3 + random.normal(size=10)
        fix = correct(offset, 2.0 + offset + 0.3 * random.normal(size=10))
        corrected.append(fix.corrected)
        plain.append(fix.mean)
        errors.append(fix.corrected_error)
        assert fix.own_slope and fix.shifted == pytest.approx(2.0, abs=4.5 * 0.3 / 10**0.5)
    assert np.mean(corrected) == pytest.approx(2.0, abs=3.3 * np.std(corrected) / 500**0.5)
    assert np.std(corrected) == pytest.approx(np.sqrt(np.mean(np.square(errors))), rel=0.15)
    assert np.std(corrected) < 0.5 * np.std(plain)


def test_slope_common_to_groups():
    x = np.array([-1.0, 0.0, 1.0])
    slope, error = common_slope([(x, 5 + 2 * x, "abc"), (x + 3, 1 + 2 * x, "def")])
    assert slope == pytest.approx(2.0) and error == pytest.approx(0.0, abs=1e-12)
    assert common_slope([(x[:2], x[:2], "ab")]) == (None, None) and common_slope([]) == (None, None)


def test_pairs_that_recur_are_not_taken_for_independent():
    """The same 20 pairs at eight velocities, with a scatter that belongs to the pair: the error of the slope is that of 20
    runs, not of 160. 400 sets tell it to 12 % at 99.9 %; that of 160 independent runs would be low by 65 %."""
    random, slopes, errors = np.random.default_rng(17), [], []
    for _ in range(400):
        x, pair = random.normal(size=20), random.normal(size=20)
        slope, error = common_slope([(x, v + pair, range(20)) for v in range(8)])
        slopes.append(slope)
        errors.append(error)
    assert np.sqrt(np.mean(np.square(errors))) == pytest.approx(np.std(slopes), rel=0.12)
