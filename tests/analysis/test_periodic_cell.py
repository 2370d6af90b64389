"""A periodic cell: virial pressure against closed forms, and pressure and tension of made histories."""

import numpy as np
import pytest
from written_runs import cubic_lattice

from analysis.measures.periodic_cell import *

A = 2e-7
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


def test_pressure_by_the_work_counts_what_happens_between_samples():
    """An oscillation that every sample meets at its top is not in the work, nor in the pressure."""
    history = compression()
    seen = dict(history, pressure=3.0 * history["pressure"])
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


def test_pressure_of_springs_along_one_axis():
    """A third of the force through a plane across x over its area."""
    site, pairs = cubic_lattice(3)
    pressure = contact_pressure(A * site, pairs[::3], np.full(27, 2e-9), np.full(3, 3 * A))
    assert pressure == pytest.approx(9 * 2e-9 / (3 * A) ** 2 / 3, rel=1e-12)


def test_images_do_not_matter():
    """Grains moved by whole edges, with their velocities as K13 eqs 8-11 have them, give the same pressures."""
    random = np.random.default_rng(5)
    cell, rate = np.array([1.0, 1.2, 1.5]), np.array([-0.3, -0.2, 0.1])
    position, velocity, mass = random.uniform(-0.4, 0.4, (20, 3)), random.normal(size=(20, 3)), random.uniform(1, 2, 20)
    image = random.integers(-2, 3, (20, 3))
    elsewhere, faster = position + image * cell, velocity + image * rate * cell
    assert cell_velocity(elsewhere, faster, cell, rate) == pytest.approx(velocity, abs=1e-12)
    one, other = (kinetic_pressure(mass, x, v, cell, rate) for x, v in ((position, velocity), (elsewhere, faster)))
    assert one == pytest.approx((mass * (velocity**2).sum(axis=1)).sum() / 3 / 1.8, rel=1e-12)
    assert other == pytest.approx(one, rel=1e-12)
    pairs = random.integers(0, 20, (30, 2))
    forces = random.normal(size=30)
    first, second = (contact_pressure(x, pairs, forces, cell) for x in (position, elsewhere))
    assert second == pytest.approx(first, rel=1e-9)
    assert filling_factor([1.0, 1.0], [4.0, 4.0, 4.0]) == pytest.approx(2 * 4 / 3 * np.pi / 64)
