"""The velocity at which a curve of estimates falls through 0, and what bounds it."""

import math
from dataclasses import dataclass

import numpy as np

from .curves import threshold_velocity
from .estimate import CONFIDENCE, EXACT, Estimate, combine, curve, range_text
from .runs import along


@dataclass(frozen=True, eq=False)
class Threshold(Estimate):
    """velocities (V,) [m/s], rising, and the curve's estimates (V,) there.

    The interval goes from the first to the last velocity at which the curve isn't told from 0 (Fieller 1954). All draws may fall through 0 between the same two
    velocities, though the curve isn't told from 0 at either: their scatter bounds nothing."""

    velocities: np.ndarray
    estimates: list

    def interval(self, confidence=CONFIDENCE, runs=EXACT):
        """(low, high) [m/s], infinite where no velocity of the curve is a bound; (None, None) where it has no errors, or doesn't fall."""
        if self.pairs < 2 or not math.isfinite(self.value):
            return None, None
        bounds = [own.interval(confidence, runs) if own.error else (own.value, own.value) for own in self.estimates]
        low, high = np.array(bounds).T
        last = np.flatnonzero(high > 0)[-1]
        least = threshold_velocity(self.velocities, low) if low[0] > 0 else -math.inf
        most = threshold_velocity(self.velocities[last:], high[last:]) if high[-1] <= 0 else math.inf
        return float(least), float(most)

    def chance(self, low, high, runs=EXACT):
        """p of the curve's difference from 0 at the nearest velocity of low to high, 1 where no run is; one-sided as Estimate has it. None without
        an error."""
        if self.pairs < 2 or not math.isfinite(self.value):
            return None
        if low < high and low <= self.value <= high:
            return 1.0
        x, at = np.log(self.velocities), math.log(low if self.value < low else high)
        if not x[0] <= at <= x[-1]:
            return 1.0
        k = min(int(np.searchsorted(x, at, side="right")), len(x) - 1)
        part = (at - x[k - 1]) / (x[k] - x[k - 1])
        p = combine(lambda a, b: (1 - part) * a + part * b, *self.estimates[k - 1 : k + 1]).chance(0.0, 0.0, runs)
        return p if p is None or low == high else 0.5 * p

    @property
    def text(self):
        """'56.8 (95 %: 52.1 to 66.0; 3)': its interval in place of an error, and the number of pairs."""
        low, high = self.interval()
        between = "" if low is None else f"95 %: {range_text(low, high)}; "
        return f"{self!r} ({between}{self.pairs:g})"

    def __repr__(self):
        return f"{self.value:.3g}" if math.isfinite(self.value) else "-"


def thresholds(series):
    """Series of Threshold, of a Series of Estimate with a level `velocity` [m/s], for every value of the others."""
    return along(series, "velocity", threshold_velocity, of=_threshold)


def _threshold(f, velocities, estimates):
    plain = curve(f, velocities, estimates)
    return Threshold(plain.value, plain.draws, plain.pairs, np.asarray(velocities, dtype=float), estimates)
