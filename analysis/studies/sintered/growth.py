"""The critical velocity for growth: where the mean sticking efficiency falls below one half (S17's abstract)."""

from dataclasses import dataclass

import numpy as np

from ...statistics import CONFIDENCE, group_means, pair_weights, stretch

HALF = 0.5  # of the total mass: what the largest piece must keep for growth


@dataclass(frozen=True)
class Critical:
    """velocity [m/s] (inf: not reached), low and high (the interval of CONFIDENCE from resampling seeds; inf: above the
    fastest), highest [m/s] (the fastest runs), seeds."""

    velocity: float
    low: float
    high: float
    highest: float
    seeds: int


def critical_velocity(table):
    """Critical of a table of runs of one kind (velocity, largest, packing_seed): even between the two velocities about it. None
    with fewer than two velocities or three seeds. Deviations of resampled means are stretched as for a mean."""
    velocity, values = table.velocity.to_numpy(dtype=float), table.largest.to_numpy(dtype=float)
    seeds = table.packing_seed.to_numpy()
    at, first = np.unique(velocity, return_index=True)
    number = len(np.unique(seeds))
    if len(at) < 2 or number < 3:
        return None
    mean = group_means(values, velocity, np.ones((1, len(values))))[0, first]
    drawn = group_means(values, velocity, pair_weights(seeds))[:, first]
    drawn = mean + stretch(number, 1) * (drawn - mean)
    tail = 0.5 * (1 - CONFIDENCE)
    low, high = np.quantile([fall(at, each) for each in drawn], [tail, 1 - tail], method="nearest")
    return Critical(fall(at, mean), float(low), float(high), float(at[-1]), number)


def fall(velocity, mean):
    """Velocity at which means (K,) at rising velocities (K,) first fall below HALF; inf where they don't.

    >>> fall([10.0, 20.0, 40.0], [1.0, 0.75, 0.25]), fall([10.0, 20.0], [1.0, 0.75])
    (30.0, inf)
    """
    below = np.flatnonzero(np.asarray(mean) < HALF)
    if not len(below):
        return float("inf")
    k = below[0]
    if k == 0:
        return float(velocity[0])
    part = (mean[k - 1] - HALF) / (mean[k - 1] - mean[k])
    return float(velocity[k - 1] + part * (velocity[k] - velocity[k - 1]))
