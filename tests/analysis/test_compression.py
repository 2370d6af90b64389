"""d, v and the largest compression (A24 eqs 10-13)."""

import numpy as np
import pytest

from analysis.measures.compression import *


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
    time = np.linspace(0.0, 1.0, 5)
    rising = maximum_compression(time, time, np.ones(5))
    falling = maximum_compression(time, -time, -np.ones(5))
    assert not rising.inside and (rising.length, rising.time) == (1.0, 1.0)
    assert not falling.inside and (falling.length, falling.time) == (0.0, 0.0)
    time = np.linspace(0.0, 10.0, 51)
    d, v = 5.0 - (time - 4.1) ** 2, -2.0 * (time - 4.1)
    d[40:] = v[40:] = np.nan
    assert maximum_compression(time, d, v).length == pytest.approx(5.0, rel=1e-12)
    assert maximum_compression(time, np.full(51, np.nan), v) is None
    with pytest.raises(ValueError, match="^d: must have the shape"):
        maximum_compression(np.arange(3.0), np.arange(4.0), np.arange(3.0))


def test_maximum_of_a_cosine_converges_with_the_fourth_power_of_the_interval():
    errors = []
    for samples in (20, 40):
        time = np.linspace(0.0, 3.0, samples)
        maximum = maximum_compression(time, np.cos(time - 1.234), -np.sin(time - 1.234))
        errors.append(abs(maximum.length - 1.0))
        assert errors[-1] <= maximum.length_error
        assert abs(maximum.time - 1.234) <= maximum.time_error
    assert errors[0] < 2e-5 and errors[1] < errors[0] / 8


def test_noise_stays_within_the_stated_error():
    random = np.random.default_rng(2)
    time = np.linspace(0.0, 10.0, 101)
    for _ in range(50):
        noise = 1e-3 * random.normal(size=time.size)
        maximum = maximum_compression(time, 5.0 - (time - 4.1) ** 2 + noise, -2.0 * (time - 4.1))
        assert maximum.length == pytest.approx(5.0, abs=4e-3)
        assert abs(maximum.time - 4.1) <= maximum.time_error * (1 + 1e-9) < 0.5
        assert 0 < maximum.length_error < 1e-2


def test_d_max_is_of_the_first_compression():
    """Aggregates that stuck creep together further, 1.3 after a first maximum of 1: that is not d_max."""
    time = np.linspace(0.0, 20.0, 2001)
    d = np.where(time < np.pi, np.sin(time), 1.3 * (1 - np.exp(np.pi - time)))
    first, exceeded = first_compression(time, d, np.gradient(d, time))
    assert first.length == pytest.approx(1.0, abs=1e-3) and first.inside and exceeded
    assert maximum_compression(time, d, np.gradient(d, time)).length > 1.29


def test_largest_return_speed():
    """v = cos t falls to -1 at pi; what comes before the largest compression, or is still growing at the end, is not
    it."""
    time = np.linspace(0.0, 6.0, 601)
    speed, when = largest_return_speed(time, np.cos(time), np.pi / 2)
    assert speed == pytest.approx(1.0, abs=1e-5) and when == pytest.approx(np.pi, abs=0.01)
    assert largest_return_speed(time[:300], np.cos(time[:300]), np.pi / 2) == (None, None)
    assert largest_return_speed(time, np.abs(np.cos(time)), np.pi / 2) == (None, None)
