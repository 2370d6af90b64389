"""The power law of made pressures comes back, and its errors are as large as its deviations are."""

import numpy as np
import pytest

from analysis.studies.compression.curve import (
    FILLINGS,
    coordination_at,
    filling_at_pressure,
    filling_at_share,
    pressure_at,
    pressure_over,
    tension,
    windows,
)
from analysis.studies.compression.strength_fit import fit_strength
from analysis.theory.aggregates import bcca_coordination
from analysis.theory.compression import compressive_strength_dense

SCALE, EXPONENT = 4.74e5, 3.2


def made(random, seeds, scatter=0.3, together=0.9):
    """Pressures (S, K) that scatter about the power law; the logarithms of neighbouring bins are correlated."""
    noise = np.empty((seeds, len(FILLINGS)))
    noise[:, 0] = random.normal(size=seeds)
    for k in range(1, len(FILLINGS)):
        noise[:, k] = together * noise[:, k - 1] + np.sqrt(1 - together**2) * random.normal(size=seeds)
    return SCALE * FILLINGS**EXPONENT * np.exp(scatter * noise - 0.5 * scatter**2)


def test_exact_power_law():
    fit = fit_strength(FILLINGS, np.tile(SCALE * FILLINGS**3, (3, 1)), 0.005, 0.1)
    assert (fit.scale, fit.exponent, fit.at_three) == pytest.approx((SCALE, 3.0, SCALE), rel=1e-9)
    assert max(fit.errors) < 1e-9 and fit.at_three_error < 1e-9
    assert fit.bins == 11 and fit.runs == 3


def test_errors_of_correlated_bins():
    """Pulls of 300 made sets of ten seeds: their spread is 1 where errors are right. Errors from the scatter about the line,
    as if bins were independent, would be a third of it."""
    random = np.random.default_rng(8)
    fits = [fit_strength(FILLINGS, made(random, 10), 0.004, 0.1) for _ in range(300)]
    exponent = np.array([(fit.exponent - EXPONENT) / fit.errors[1] for fit in fits])
    offset = np.array([(np.log(fit.scale) - np.log(SCALE)) / fit.errors[0] for fit in fits])
    for pulls in (exponent, offset):
        assert abs(pulls.mean()) < 0.35 and 0.8 < pulls.std() < 1.35, (pulls.mean(), pulls.std())
    assert np.median([fit.correlation for fit in fits]) > 0.8


def test_one_seed_has_no_errors_and_too_few_bins_a_reason():
    one = fit_strength(FILLINGS, SCALE * FILLINGS[None] ** 3, 0.005, 0.1)
    assert one.errors == (None, None) and one.at_three_error is None and one.scale == pytest.approx(SCALE)
    few = fit_strength(FILLINGS, SCALE * FILLINGS[None] ** 3, 0.09, 0.1)
    assert few.scale is None and "a power law needs 3" in few.reason
    gaps = np.tile(SCALE * FILLINGS**3, (2, 1))
    gaps[1, FILLINGS < 0.02] = np.nan
    assert fit_strength(FILLINGS, gaps, 0.005, 0.1).bins == 6


def test_bins_in_which_one_seed_alone_is_pressed_are_not_fitted():
    """Two of three clusters pull at first: without the third the mean has no logarithm."""
    pressures = np.tile(SCALE * FILLINGS**3, (3, 1))
    pressures[:2, FILLINGS < 0.02] *= -0.4
    fit = fit_strength(FILLINGS, pressures, 0.005, 0.1)
    assert fit.bins == 6 and fit.scale == pytest.approx(SCALE) and np.isfinite(fit.errors).all()


def compression(power=3.0, low=0.004, high=0.5, samples=20_001):
    """A made history: P = SCALE phi^power, constant strain rate, 1e6 s long."""
    time = np.linspace(0.0, 1e6, samples)
    filling = low * (high / low) ** (time / 1e6)
    edge = (1.0 / filling) ** (1 / 3)
    return {
        "time": time,
        "filling": filling,
        "pressure": SCALE * filling**power,
        **{f"edge_{axis}": edge for axis in "xyz"},
        # dW = P dV, of a volume of 1/phi
        "boundaryWork": -SCALE * filling ** (power - 1.0) / (power - 1.0),
    }


def test_binned_pressure_has_little_bias_and_keeps_to_what_is_covered():
    """A bin's width biases by a thousandth where P goes with phi^3, and by less than its error where P is as steep as T23."""
    found = pressure_at(compression())
    inside = np.isfinite(found)
    assert FILLINGS[inside][0] == pytest.approx(10**-2.25) and FILLINGS[inside][-1] == pytest.approx(0.49)
    thin = inside & (FILLINGS < 0.11)
    assert found[thin] == pytest.approx(SCALE * FILLINGS[thin] ** 3, rel=1.2e-3)
    steep = dict(compression(samples=100_001), boundaryWork=None)
    filling = steep["filling"]
    middle = compressive_strength_dense(np.sqrt(filling[1:] * filling[:-1]), SCALE)
    steep["boundaryWork"] = np.concatenate([[0.0], np.cumsum(middle * np.diff(1.0 / filling))])
    assert pressure_at(steep)[inside] == pytest.approx(compressive_strength_dense(FILLINGS[inside], SCALE), rel=1e-6)


def test_pressure_by_the_work_counts_what_happens_between_samples():
    """An oscillation that every sample meets at its top is not in the work, nor in the pressure."""
    history = compression()
    seen = dict(history, pressure=3.0 * history["pressure"])
    assert np.array_equal(pressure_at(seen), pressure_at(history), equal_nan=True)
    fillings, pressures = pressure_over(seen, 1e4)
    assert pressures == pytest.approx(SCALE * fillings**3, rel=0.02)


def test_coordination_at_fillings():
    """Of A24 eq 45, whatever the bin's width."""
    history = compression()
    history["coordination"] = bcca_coordination(history["filling"]) + 0.1
    found = coordination_at(history)
    inside = np.isfinite(found)
    assert inside.sum() > 10 and found[inside] == pytest.approx(bcca_coordination(FILLINGS[inside]) + 0.1, rel=1e-12)


def test_bins_reach_the_end_of_runs():
    """Of those to 0.5 and to random close packing, as far as the tables of the study go."""
    for high in (0.5, 0.64):
        found = pressure_at(compression(high=high))
        assert FILLINGS[np.isfinite(found)][-1] > 0.97 * high


def test_filling_from_which_on_one_channel_has_a_share_of_another():
    history = compression(samples=2001)
    other = history["filling"].copy()
    one = np.where(history["filling"] > 0.1, 0.2 * other, 0.0)
    history.update(one=one, other=other)
    assert np.isnan(filling_at_share(history, "other", "one", 0.3))  # from the start
    one[10] = 0.9  # for a moment
    assert filling_at_share(history, "one", "other", 0.1) == pytest.approx(0.1, rel=3e-3)
    assert np.isnan(filling_at_share(history, "one", "other", 0.3))  # not to the end


def test_filling_at_a_pressure():
    history = compression()
    assert filling_at_pressure(history, 300.0, 1000.0) == pytest.approx((300 / SCALE) ** (1 / 3), rel=2e-3)
    history["boundaryWork"][2000:] -= 1e-6 * history["boundaryWork"][2000]  # for a moment
    assert filling_at_pressure(history, 300.0, 1000.0) == pytest.approx((300 / SCALE) ** (1 / 3), rel=2e-3)
    assert np.isnan(filling_at_pressure(history, 1e9, 1000.0))


def test_tension_of_a_stretched_cell():
    """A volume that grows after the compression, with work as of a constant tension, then none."""
    history = compression(samples=2001)
    assert len(tension(history, 1e4)[0]) == 0
    grown = np.linspace(1.0, 2.0, 500)
    volume = np.prod([history[f"edge_{axis}"][-1] for axis in "xyz"])
    more = {
        "time": 1e6 + np.arange(1, 501) * 1e3,
        "filling": history["filling"][-1] / grown,
        "pressure": np.zeros(500),
        "edge_x": history["edge_x"][-1] * grown,
        "edge_y": np.full(500, history["edge_y"][-1]),
        "edge_z": np.full(500, history["edge_z"][-1]),
        "boundaryWork": history["boundaryWork"][-1] - 50.0 * np.minimum(grown - 1.0, 0.5) * volume,
    }
    both = {name: np.concatenate([history[name], more[name]]) for name in more}
    fillings, stress = tension(both, 5e4)
    assert stress[:4] == pytest.approx(50.0, rel=1e-9) and stress[-2:] == pytest.approx(0.0, abs=1e-9)
    assert fillings[0] > fillings[-1]


def test_windows_leave_the_incomplete_one_out():
    assert windows(np.arange(10.0), 4.0) == [(0, 4), (4, 8)]
    assert windows(np.arange(3.0), 4.0) == [(0, 3)]
