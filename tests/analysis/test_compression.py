"""d, v and the largest compression (A24 eqs 10-13); pressure and tension of a periodic cell (K13)."""

import numpy as np
import pytest
from written_runs import cubic_lattice

from analysis.measures.compression import *
from analysis.measures.periodic_cell import *


def test_d_and_v_of_few_grains():
    """One empty side leaves no value, and a grain at zero belongs to neither."""
    found = compression_and_velocity([-3.0, 1.0, 2.0], [4.0, -1.0, -2.0], 2.5)
    assert found == pytest.approx((5.0 - (1.5 + 3.0), -(-1.5 - 4.0)))
    assert np.all(np.isnan(compression_and_velocity([0.0, 0.0], [1.0, 1.0], 1.0)))
    x, speed = np.array([-1.0, 0.0, 3.0]), np.array([2.0, 100.0, -2.0])
    assert compression_and_velocity(x, speed, 2.0) == (0.0, 4.0)


def test_maximum_of_a_parabola_between_samples():
    """At an end it is only a bound; samples without a value are left out."""
    time = np.linspace(0.0, 10.0, 8)
    maximum = maximum_compression(time, 5.0 - (time - 4.1) ** 2, -2.0 * (time - 4.1))
    assert (maximum.length, maximum.time) == pytest.approx((5.0, 4.1), rel=1e-12)
    assert maximum.inside and maximum.length_error < 1e-12 and maximum.time_error < 1e-12
    time = np.linspace(0.0, 10.0, 51)
    d, v = 5.0 - (time - 4.1) ** 2, -2.0 * (time - 4.1)
    d[40:] = v[40:] = np.nan
    assert maximum_compression(time, d, v).length == pytest.approx(5.0, rel=1e-12)
    assert maximum_compression(time, np.full(51, np.nan), v) is None
    rising = maximum_compression(time, time, np.ones(51))
    assert not rising.inside and (rising.length, rising.time) == (10.0, 10.0)


def test_maximum_of_a_cosine_converges_with_the_fourth_power_of_the_interval():
    errors = []
    for samples in (20, 40):
        time = np.linspace(0.0, 3.0, samples)
        maximum = maximum_compression(time, np.cos(time - 1.234), -np.sin(time - 1.234))
        errors.append(abs(maximum.length - 1.0))
        assert errors[-1] <= maximum.length_error
        assert abs(maximum.time - 1.234) <= maximum.time_error
    assert errors[0] < 2e-5 and errors[1] < errors[0] / 8


def test_d_max_is_of_the_first_compression():
    """Aggregates that stuck creep together further, 1.3 after a first maximum of 1: that is not d_max."""
    time = np.linspace(0.0, 20.0, 2001)
    d = np.where(time < np.pi, np.sin(time), 1.3 * (1 - np.exp(np.pi - time)))
    first = first_compression(time, d, np.gradient(d, time))
    assert first.length == pytest.approx(1.0, abs=1e-3) and first.inside and d.max() > first.length
    assert maximum_compression(time, d, np.gradient(d, time)).length > 1.29


def test_largest_return_speed():
    """v = cos t falls to -1 at pi; what comes before the largest compression, or is still growing at the end, is not
    it."""
    time = np.linspace(0.0, 6.0, 601)
    speed, when = largest_return_speed(time, np.cos(time), np.pi / 2)
    assert speed == pytest.approx(1.0, abs=1e-5) and when == pytest.approx(np.pi, abs=0.01)
    assert np.isnan(largest_return_speed(time[:300], np.cos(time[:300]), np.pi / 2)).all()
    assert np.isnan(largest_return_speed(time, np.abs(np.cos(time)), np.pi / 2)).all()


# ---- a periodic cell: virial pressure, and pressure and tension of made histories ----


A = 2e-7
SCALE = 4.74e5


def compression(samples=20_001):
    """A made history: P = SCALE phi^3, constant strain rate, 1e6 s long."""
    time = np.linspace(0.0, 1e6, samples)
    filling = 0.004 * 125 ** (time / 1e6)
    edge = (1.0 / filling) ** (1 / 3)
    history = {"time": time, "filling": filling, "pressure": SCALE * filling**3}
    history |= {f"edge_{axis}": edge for axis in "xyz"}
    # dW = P dV, of a volume of 1/phi
    return {**history, "boundaryWork": -SCALE * filling**2 / 2, "constraintWork": np.zeros_like(filling)}


def test_pressure_by_the_work_counts_what_happens_between_samples():
    """An oscillation that every sample meets at its top is not in the work, nor in the pressure; of a cell that was
    stretched the last pressure is that of the samples."""
    history = compression()
    sampled = dict(history, pressure=3.0 * history["pressure"])
    fillings, pressures = pressure_over(sampled, 1e4)
    assert pressures == pytest.approx(SCALE * fillings**3, rel=0.02)
    assert pressure_at_end(sampled, 1e4) == pytest.approx(SCALE * 0.5**3, rel=0.1)
    turned = {name: np.append(series, series[-2::-1]) for name, series in sampled.items()}
    turned["time"] = 1e6 + np.append(history["time"] - 1e6, 1e6 - history["time"][-2::-1])
    assert pressure_at_end(turned, 1e4) == pytest.approx(3 * SCALE * 0.004**3, rel=0.1)


def test_filling_from_which_on_the_pressure_stays_above_another():
    history = compression()
    assert filling_at_pressure(history, 300.0, 1000.0) == pytest.approx((300 / SCALE) ** (1 / 3), rel=2e-3)
    history["boundaryWork"][2000:] -= 1e-6 * history["boundaryWork"][2000]  # for a moment
    assert filling_at_pressure(history, 300.0, 1000.0) == pytest.approx((300 / SCALE) ** (1 / 3), rel=2e-3)


def test_tension_of_a_stretched_cell():
    """A volume that grows after the compression, with work as of a constant tension, then none."""
    history = compression(samples=2001)
    grown = np.linspace(1.0, 2.0, 500)
    last = {name: series[-1] for name, series in history.items()}
    work = 50.0 * np.minimum(grown - 1.0, 0.5) * last["edge_x"] ** 3
    more = {name: np.full(500, value) for name, value in last.items()}
    more |= {"time": 1e6 + np.arange(1, 501) * 1e3, "filling": last["filling"] / grown}
    more |= {"edge_x": last["edge_x"] * grown, "boundaryWork": last["boundaryWork"] - work}
    both = {name: np.concatenate([history[name], more[name]]) for name in more}
    _, stress = tension(both, 5e4)
    assert stress[:4] == pytest.approx(50.0, rel=1e-9) and stress[-2:] == pytest.approx(0.0, abs=1e-9)
    both["boundaryWork"][-500:] += 3e-3 * work[-1] * np.random.default_rng(7).normal(size=500)
    assert tension(both, 5e3)[1].max() > 70.0 and tensile_strength(both, 5e3)[0] == pytest.approx(50.0, rel=0.1)


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
    one, other = (kinetic_pressure(mass, x, v, cell, rate) for x, v in ((position, velocity), (elsewhere, faster)))
    assert one == pytest.approx((mass * (velocity**2).sum(axis=1)).sum() / 3 / 1.8, rel=1e-12)
    assert other == pytest.approx(one, rel=1e-12)
    pairs = random.integers(0, 20, (30, 2))
    forces = random.normal(size=30)
    first, second = (contact_pressure(x, pairs, forces, cell) for x in (position, elsewhere))
    assert second == pytest.approx(first, rel=1e-9)
    assert filling_factor([1.0, 1.0], [4.0, 4.0, 4.0]) == pytest.approx(2 * 4 / 3 * np.pi / 64)
