"""When a run is sampled, and A24's measures of a sample."""

from dataclasses import dataclass
from math import ceil

import numpy as np


@dataclass(frozen=True)
class Schedule:
    """Steps of the run; a sample every `interval` of them and at both ends; which samples become states."""

    steps: int
    interval: int
    states: frozenset

    @classmethod
    def of(cls, duration, time_step, interval=50, fewest_samples=300, states=22):
        """At most `interval` steps between samples, and at least `fewest_samples` if the steps suffice."""
        steps = max(1, ceil(duration / time_step * (1 - 1e-12)))
        interval = max(1, min(interval, steps // fewest_samples))
        samples = ceil(steps / interval)
        chosen = np.linspace(0, samples, states).round().astype(int)
        return cls(samples * interval, interval, frozenset(chosen))


def compression_and_velocity(x, v, aggregate_radius):
    """A24's d [m] and v [m/s] (eqs 10-13) from x components (N,); nan when one side of x = 0 is empty."""
    right = x > 0
    if right.all() or not right.any():
        return np.nan, np.nan
    compression = 2 * aggregate_radius - (x[right].mean() - x[~right].mean())
    return compression, -(v[right].mean() - v[~right].mean())
