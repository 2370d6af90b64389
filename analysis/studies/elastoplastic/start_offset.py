"""How much of d_max comes from where the aggregates' centres of mass lie at the start.

A24 places the centres of the spheres at -+(R + r), so that d should start at -2 r; the centres of mass lie
off by chance, and d(0) + 2 r is known for every run. d_max is regressed on it and read off at zero (a mere shift of the
zero of d gives a slope of 1). The offset is in the paper's d too and has mean 0, so that this can't explain a difference
of means; how little of the scatter it explains, zone_fit tells."""

from dataclasses import dataclass

import numpy as np

from ...statistics import group_means, mean_and_error, pair_weights, resampling_error, stretch

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
    """(slope, its error) of d_max on offset, common to groups of (offset (n,), d_max (n,), pairs (n,)), each with a mean
    of its own; (None, None) when too few runs are left for an error.

    pairs: labels of the pairs of aggregates. Where each occurs once the error is that of least squares; where one recurs,
    as it does at other velocities, its runs are not independent, and the error is from resampled pairs."""
    if not groups:
        return None, None
    group = np.concatenate([np.full(len(o), k) for k, (o, _, _) in enumerate(groups)])
    x, y = (np.concatenate([np.asarray(g[i], dtype=float) for g in groups]) for i in (0, 1))
    pairs = np.concatenate([np.asarray(list(g[2])).astype(str) for g in groups])
    freedom = np.unique(pairs).size - len({tuple(sorted(set(g[2]))) for g in groups}) - 1
    slopes, squares = _slopes(x, y, group, np.ones((1, x.size)))
    # All offsets of each group the same, but for rounding: no slope.
    if freedom < 1 or not squares[0] > x.size * (1e-12 * np.abs(x).max()) ** 2:
        return None, None
    slope = float(slopes[0])
    if np.unique(pairs).size < x.size:
        number = np.unique(pairs).size
        return slope, resampling_error(_slopes(x, y, group, pair_weights(pairs))[0]) * stretch(number, number - freedom)
    rest = (y - slope * x) - group_means(y - slope * x, group, np.ones((1, x.size)))[0]
    return slope, float(np.sqrt(rest @ rest / (x.size - len(groups) - 1) / squares[0]))


def _slopes(x, y, group, weights):
    """(slope, sum of squares of x) (B,) about the means of the groups."""
    dx, dy = x - group_means(x, group, weights), y - group_means(y, group, weights)
    square = np.sum(weights * dx**2, axis=1)
    return np.sum(weights * dx * dy, axis=1) / np.where(square > 0, square, np.nan), square


def correct(offset, d_max, slope_of_filling=(None, None)):
    """Correction of one point from the runs' offset and d_max (n,), in one unit; with its own slope from
    FEWEST_FOR_SLOPE runs on, with that of the filling (slope, error) otherwise."""
    n = len(d_max)
    own = n >= FEWEST_FOR_SLOPE
    slope, slope_error = common_slope([(offset, d_max, range(n))]) if own else slope_of_filling
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
