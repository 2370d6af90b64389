"""d_max and t_max against the filling of the two zones that meet: a covariate that the packings give before they collide.

At one velocity and filling factor, with x the zones' filling over that of the aggregates (start.COLUMNS) and i the size,

    d_max = m_i + b R (x - 1) + scatter

with one slope b for all sizes, and a scatter [grain radii] that is the same at all sizes, as the size fit has it; t_max [ns]
likewise. The zone (0.25 R deep and wide) was chosen by the d_max of the first 39 pairs of each filling, so that what it
explains of these flatters it: prediction.py tests it on pairs that were not run by then. All errors are from resampled pairs
of aggregates."""

from dataclasses import dataclass

import numpy as np

from ...statistics import RESAMPLES, group_means, pair_weights, resampling_error, stretch

FEWEST = 4  # runs of a filling that are left beyond its sizes and the slope
COVARIATES = {
    "filling of the zones that meet": "zone_filling",
    "direction of the crystals": "bond_direction",
    "chance offset of the centres of mass": "offset",
    "overlap of a rigid approach": "rigid_touch",
}
LENGTHS = ("offset", "rigid_touch")  # the others are numbers
UNITS = {"d_max": "r", "t_max": "ns"}  # of what is measured, as it is given here


@dataclass(frozen=True)
class Slope:
    """What is measured (a key of UNITS, in that unit) against a covariate: slope and correlation with their errors, both about
    the means of each size; explained: the fraction of the variance, less what a covariate of no use would explain (adjusted
    R^2, may be negative); runs, sizes (their number); scatter: standard deviation about the slope, total: about the means;
    slopes (B,): resampled."""

    slope: float
    slope_error: float
    correlation: float
    correlation_error: float
    explained: float
    runs: int
    sizes: int
    scatter: float
    total: float
    slopes: np.ndarray

    @property
    def freedom(self):
        """Degrees of freedom of the scatter."""
        return self.runs - self.sizes - 1

    @property
    def worth(self):
        """Number of seeds without the covariate that one with it is worth: ratio of the variances."""
        return (self.total / self.scatter) ** 2


@dataclass(frozen=True)
class Adjusted:
    """Mean of what is measured (a key of UNITS, in that unit) at one size (radius in grain radii, seeds) with its error, mean
    x - 1 with its error, correlation with x at this size (None below four seeds), and the mean read off at x = 1 with its
    error."""

    radius: float
    seeds: int
    mean: float
    error: float
    zone: float
    zone_error: float
    correlation: float
    adjusted: float
    adjusted_error: float


def fit_slope(table, covariate="zone_filling", of="d_max"):
    """Slope of what is measured (`of`: a key of UNITS) in the runs of one filling and velocity (DataFrame of measure.COLUMNS)
    against a column; None where fewer than FEWEST degrees of freedom are left, or the column has gaps or does not vary
    within the sizes."""
    group = (table.radius / table.grain_radius).round(3).to_numpy()
    x, y = _regressor(table, covariate), _measured(table, of)
    sizes = np.unique(group).size
    if np.isnan(x).any() or len(x) - sizes - 1 < FEWEST:
        return None
    dx, dy = (values - group_means(values, group, np.ones((1, len(x))))[0] for values in (x, y))
    if not np.abs(dx).max() > 1e-9 * np.abs(x).max():
        return None
    weights = pair_weights([f"{g} {s}" for g, s in zip(group, table.seed)], RESAMPLES)
    slopes, correlations = _moments(x, y, group, weights)
    slope, correlation = (float(value[0]) for value in _moments(x, y, group, np.ones((1, len(x)))))
    rest = dy - slope * dx
    freedom = len(x) - sizes - 1
    scatter, total = np.sqrt(rest @ rest / freedom), np.sqrt(dy @ dy / (freedom + 1))
    return Slope(
        slope,
        resampling_error(slopes) * stretch(len(x), sizes + 1),
        correlation,
        resampling_error(correlations) * stretch(len(x), sizes + 1),
        float(1.0 - (scatter / total) ** 2),
        len(x),
        sizes,
        float(scatter),
        float(total),
        slopes,
    )


def _measured(table, of):
    """What is measured (n,), in its unit of UNITS."""
    values = table.d_max / table.grain_radius if of == "d_max" else 1e9 * table[of]
    return values.to_numpy(dtype=float)


def _regressor(table, covariate):
    """The covariate of the runs (n,) in grain radii."""
    return in_grain_radii(table[covariate], covariate, table.radius, table.grain_radius).to_numpy(dtype=float)


def in_grain_radii(x, covariate, radius, grain_radius):
    """A covariate in grain radii, as slopes take it: lengths as they are, numbers times R. radius, grain_radius: in m."""
    return x * (1.0 if covariate in LENGTHS else radius) / grain_radius


def adjust(table, slope, of="d_max"):
    """[Adjusted] of each size of the runs of one filling and velocity, with a fit_slope of the same on zone_filling."""
    found = []
    for radius, runs in table.groupby((table.radius / table.grain_radius).round(3)):
        x, d = runs.zone_filling.to_numpy() - 1.0, _measured(runs, of)
        n = len(d)
        plain = d.std(ddof=1) / np.sqrt(n) if n > 1 else slope.total
        found.append(
            Adjusted(
                radius=float(radius),
                seeds=n,
                mean=float(d.mean()),
                error=float(plain),
                zone=float(x.mean()),
                zone_error=float(x.std(ddof=1) / np.sqrt(n)) if n > 1 else None,
                correlation=float(np.corrcoef(x, d)[0, 1]) if n > 3 else None,
                adjusted=float(d.mean() - radius * slope.slope * x.mean()),
                # The scatter about the slope is that of all sizes together.
                adjusted_error=float(np.hypot(slope.scatter / np.sqrt(n), radius * x.mean() * slope.slope_error)),
            )
        )
    return found


def _moments(x, y, group, weights):
    """(slope, correlation) (B,) of y on x about the means of the groups."""
    dx, dy = x - group_means(x, group, weights), y - group_means(y, group, weights)
    xx, yy, xy = (np.sum(weights * product, axis=1) for product in (dx * dx, dy * dy, dx * dy))
    return xy / xx, xy / np.sqrt(xx * yy)
