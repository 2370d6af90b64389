"""How much of d_max comes from where the aggregates' centres of mass lie at the start.

A24 places the centres of the spheres at -+(R + r), so that d should start at -2 r; the centres of mass lie
off by chance, and d(0) + 2 r is known for every run. As a control variate it takes that part of the scatter
away: d_max is regressed on it and read off at zero (where a mere shift of the zero of d gives a slope of
1)."""

from dataclasses import dataclass

import numpy as np

from ...statistics import mean_and_error

FEWEST_FOR_SLOPE = 4


@dataclass(frozen=True)
class Correction:
    """d_max of one point: seeds, mean with error as defined, mean_offset, slope with error (own or common to
    its filling: own_slope), corrected (at offset zero) with error, shifted = mean of d_max - offset with
    error. Lengths in the unit given; errors None where the seeds don't suffice."""

    seeds: int
    mean: float
    error: float
    mean_offset: float
    slope: float
    slope_error: float
    own_slope: bool
    corrected: float
    corrected_error: float
    shifted: float
    shifted_error: float


def common_slope(groups):
    """(slope, its error) of d_max on offset, common to groups of (offset (n,), d_max (n,)), each with a mean
    of its own; (None, None) when too few runs are left for an error."""
    x = np.concatenate([o - o.mean() for o, _ in groups]) if groups else np.zeros(0)
    y = np.concatenate([d - d.mean() for _, d in groups]) if groups else np.zeros(0)
    freedom = x.size - len(groups) - 1
    square = x @ x
    # All offsets of each group the same, but for rounding: no slope.
    largest = max((np.abs(o).max() for o, _ in groups), default=0.0)
    if freedom < 1 or not square > x.size * (1e-12 * largest) ** 2:
        return None, None
    slope = x @ y / square
    rest = y - slope * x
    return float(slope), float(np.sqrt(rest @ rest / freedom / square))


def correct(offset, d_max, slope_of_filling=(None, None)):
    """Correction of one point from the runs' offset and d_max (n,), in one unit; with its own slope from
    FEWEST_FOR_SLOPE runs on, with that of the filling (slope, error) otherwise."""
    n = len(d_max)
    own = n >= FEWEST_FOR_SLOPE
    slope, slope_error = common_slope([(offset, d_max)]) if own else slope_of_filling
    shifted = d_max - offset
    corrected = corrected_error = None
    if slope is not None:
        rest = d_max - slope * offset
        corrected = float(rest.mean())
        if n > 1:
            # The slope took one of the degrees of freedom, if it is this point's own.
            variance = rest.var(ddof=2 if own else 1)
            corrected_error = float(np.sqrt(variance / n + (offset.mean() * slope_error) ** 2))
    return Correction(
        n,
        *mean_and_error(d_max),
        float(offset.mean()),
        slope,
        slope_error,
        own,
        corrected,
        corrected_error,
        *mean_and_error(shifted),
    )
