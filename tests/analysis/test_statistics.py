"""The scatter of a run, smoothed. The random seed is fixed; the statistical bound says how often it would fail for other seeds."""

import numpy as np

from analysis.statistics import smoothed_scatter

_VELOCITIES = tuple(10 ** (0.1 * i) for i in range(8))


def test_smoothed_scatter_follows_a_power_without_bias():
    """s ~ v^-1 from three seeds at eight velocities, 400 times: the mean logarithm is right to 3.3 standard
    errors."""
    random, v = np.random.default_rng(11), np.array(_VELOCITIES)
    found = [smoothed_scatter(v, random.normal(size=(3, 8)).std(axis=0, ddof=1) / v, np.full(8, 3)) for _ in range(400)]
    logs = np.log(found)
    assert np.all(np.abs(logs.mean(axis=0) + np.log(v)) < 3.3 * logs.std(axis=0) / 20)
    assert np.all(np.isnan(smoothed_scatter(np.ones(3), np.zeros(3), np.full(3, 5))))
