"""When a run is sampled, and which samples become states."""

from dataclasses import dataclass
from math import ceil

import numpy as np

MOST_SAMPLES = 200_000  # that a history holds in memory: 30 MB


@dataclass(frozen=True)
class Schedule:
    """Steps of the run; a sample every `interval` of them and at both ends; which samples become states."""

    steps: int
    interval: int
    states: frozenset

    @property
    def samples(self):
        """Number of intervals between samples."""
        return self.steps // self.interval

    def samples_after(self, iteration, fused):
        """Number of samples taken when O.iter is `iteration`. fused: an O.step is all steps between two samples, and the
        start is sampled first; otherwise the first step of each interval begins with a sample."""
        return iteration + 1 if fused else (iteration - 1) // self.interval + 1

    @classmethod
    def of(cls, duration, time_step, interval=50, fewest_samples=300, states=22, kept=None):
        """At most `interval` steps between samples, and at least `fewest_samples` if the steps suffice.

        Runs of more than MOST_SAMPLES intervals are sampled less often. kept: the interval of a run that is continued.
        """
        steps = max(1, ceil(duration / time_step * (1 - 1e-12)))
        interval = kept or max(1, min(interval, steps // fewest_samples), ceil(steps / MOST_SAMPLES))
        samples = ceil(steps / interval)
        chosen = np.linspace(0, samples, states).round().astype(int)
        return cls(samples * interval, interval, frozenset(int(number) for number in chosen))
