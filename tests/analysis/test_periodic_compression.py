"""Pressure, tension and what else a compression's history tells, of made histories."""

import numpy as np
import pytest

from analysis.measures.periodic_cell import *
from analysis.studies.compression.curve import FILLINGS, coordination_at, pressure_at
from analysis.theory.aggregates import bcca_coordination
from analysis.theory.compression import compressive_strength_dense

SCALE = 4.74e5


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
        "constraintWork": np.zeros_like(filling),
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


def test_the_pressure_at_the_end_is_a_mean():
    """By the work over the volume, whatever the samples meet; of a cell that was stretched that of the samples."""
    history = compression()
    seen = dict(history, pressure=3.0 * history["pressure"])
    assert pressure_at_end(seen, 1e4) == pytest.approx(SCALE * 0.5**3, rel=0.1)
    turned = {name: np.append(series, series[-2::-1]) for name, series in seen.items()}
    turned["time"] = 1e6 + np.append(history["time"] - 1e6, 1e6 - history["time"][-2::-1])
    assert pressure_at_end(turned, 1e4) == pytest.approx(3 * SCALE * 0.004**3, rel=0.1)


def test_coordination_at_fillings_and_bins_to_the_end_of_runs():
    """Of A24 eq 45, whatever the bin's width; to 0.5 and to random close packing, as far as the study's tables go."""
    history = compression()
    history["coordination"] = bcca_coordination(history["filling"]) + 0.1
    found = coordination_at(history)
    inside = np.isfinite(found)
    assert inside.sum() > 10 and found[inside] == pytest.approx(bcca_coordination(FILLINGS[inside]) + 0.1, rel=1e-12)
    for high in (0.5, 0.64):
        found = pressure_at(compression(high=high))
        assert FILLINGS[np.isfinite(found)][-1] > 0.97 * high


def test_fillings_at_a_share_of_a_channel_and_at_a_pressure():
    history = compression(samples=2001)
    other = history["filling"].copy()
    one = np.where(history["filling"] > 0.1, 0.2 * other, 0.0)
    history.update(one=one, other=other)
    assert np.isnan(filling_at_share(history, "other", "one", 0.3))  # from the start
    one[10] = 0.9  # for a moment
    assert filling_at_share(history, "one", "other", 0.1) == pytest.approx(0.1, rel=3e-3)
    assert np.isnan(filling_at_share(history, "one", "other", 0.3))  # not to the end
    history = compression()
    assert filling_at_pressure(history, 300.0, 1000.0) == pytest.approx((300 / SCALE) ** (1 / 3), rel=2e-3)
    history["boundaryWork"][2000:] -= 1e-6 * history["boundaryWork"][2000]  # for a moment
    assert filling_at_pressure(history, 300.0, 1000.0) == pytest.approx((300 / SCALE) ** (1 / 3), rel=2e-3)
    assert np.isnan(filling_at_pressure(history, 1e9, 1000.0))
    assert windows(np.arange(10.0), 4.0) == [(0, 4), (4, 8)]
    assert windows(np.arange(3.0), 4.0) == [(0, 3)]


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
        "constraintWork": np.zeros_like(grown),
    }
    both = {name: np.concatenate([history[name], more[name]]) for name in more}
    fillings, stress = tension(both, 5e4)
    assert stress[:4] == pytest.approx(50.0, rel=1e-9) and stress[-2:] == pytest.approx(0.0, abs=1e-9)
    assert fillings[0] > fillings[-1]
