"""The straight line of d_max against the aggregates' radius, and what follows from it (A24 eqs 14-21)."""

from dataclasses import dataclass

import numpy as np
from scipy.stats import chi2, f

from ...statistics import pooled_scatter, resampling_error

NAMES = ("c1", "c2", "offset", "ratio")


@dataclass(frozen=True)
class SizeFit:
    """d_max = c1 R - c2 r at one filling and velocity [m/s]: c2 and offset (delta_offset) in grain radii,
    ratio = delta_max/R*. radii (sizes fitted [grain radii]), runs (their number); errors by name, None
    where no size has two runs; resamples: {name: (B,)}. Values are None where `reason` says why nothing could
    be fitted."""

    filling: float
    velocity: float
    radii: tuple
    runs: int
    values: dict
    errors: dict
    resamples: dict
    reason: str = None

    @property
    def ratio(self):
        """delta_max/R* if it was fitted and is positive, None otherwise (few runs may give any slope)."""
        return self.values["ratio"] if self.reason is None and self.values["ratio"] > 0 else None


def fit_line(radius, d_max, number):
    """(c1, c2) of d_max = c1 R - c2 by least squares over all runs: radius (K,), d_max (K,) or (B, K) means
    over `number` (K,) runs, all in one unit. A24 eq 14."""
    weight = np.asarray(number, dtype=float) / np.sum(number)
    centre = weight @ radius
    away = weight * (radius - centre)
    c1 = np.asarray(d_max) @ away / (away @ (radius - centre))
    return c1, c1 * centre - np.asarray(d_max) @ weight


def offset_from_line(c1, c2):
    """delta_offset, in the unit of c2, that makes delta_max proportional to R*: c2/(2 - c1).

    From d_max = c1 R - c2 and d_max + 2 delta_offset = (ratio/2) (R + delta_offset), A24 eqs 14-17, 19. Eq 18
    prints 2 - c1/2, but its number 0.271 r is this one."""
    return c2 / (2.0 - c1)


def size_velocity(points, preferred):
    """The velocity [m/s] at which these points (one filling) have the most sizes; of several the nearest to
    `preferred`."""
    velocities = np.unique(points.velocity)
    sizes = [np.unique(points.radius[points.velocity == v]).size for v in velocities]
    return max(zip(sizes, -np.abs(np.log(velocities / preferred)), velocities))[2]


def fit_sizes(points, resampled_d_max, grain_radius, velocity):
    """SizeFit of the points (one filling) at the velocity; resampled_d_max (B, K) of the same points."""
    at = points.velocity == velocity
    radius, number = points.radius[at] / grain_radius, points.number[at]
    filling = float(points.filling[0])
    if len(radius) < 2:
        reason = (
            f"only one size, R = {radius[0]:g} r, has runs at filling {filling:g} and {velocity:.3g} m/s: "
            "a line needs two"
        )
        return SizeFit(
            filling,
            float(velocity),
            tuple(radius),
            int(number.sum()),
            dict.fromkeys(NAMES),
            dict.fromkeys(NAMES),
            {},
            reason,
        )
    values = _derived(*fit_line(radius, points.d_max[at] / grain_radius, number))
    samples = _derived(*fit_line(radius, resampled_d_max[:, at] / grain_radius, number))
    return SizeFit(
        filling,
        float(velocity),
        tuple(radius),
        int(number.sum()),
        {name: float(value) for name, value in values.items()},
        {name: resampling_error(sample) if points.varies[at].any() else None for name, sample in samples.items()},
        samples,
    )


def _derived(c1, c2):
    return {"c1": c1, "c2": c2, "offset": offset_from_line(c1, c2), "ratio": 2.0 * c1}


def errors_of_design(scatter, radii, seeds, c1, c2):
    """Standard errors {name: error} that a line through `seeds` runs at each of `radii` [grain radii] has
    when one run scatters by `scatter` [grain radii]; to first order around (c1, c2)."""
    radii = np.asarray(radii, dtype=float)
    spread = seeds * np.sum((radii - radii.mean()) ** 2)
    variance1 = scatter**2 / spread
    variance2 = scatter**2 / (seeds * radii.size) + variance1 * radii.mean() ** 2
    both = variance1 * radii.mean()
    by_c1, by_c2 = c2 / (2.0 - c1) ** 2, 1.0 / (2.0 - c1)
    offset = by_c1**2 * variance1 + by_c2**2 * variance2 + 2.0 * by_c1 * by_c2 * both
    return {"c1": variance1**0.5, "c2": variance2**0.5, "offset": offset**0.5, "ratio": 2.0 * variance1**0.5}


@dataclass(frozen=True)
class JointDifference:
    """(c1, c2) of two lines together: chi_square with 2 degrees of freedom, its chance if the scatter were known
    (chance), and as it is, estimated with `freedom` degrees of freedom (chance_estimated: the F distribution)."""

    chi_square: float
    freedom: int

    @property
    def chance(self):
        return float(chi2.sf(self.chi_square, 2))

    @property
    def chance_estimated(self):
        return float(f.sf(0.5 * self.chi_square, 2, self.freedom))


def line_covariance(radii, number, scatter):
    """Covariance (2, 2) of (c1, c2) of a line through `number` (K,) runs at radii (K,) [grain radii] when one run
    scatters by `scatter` [grain radii]."""
    design = np.stack([np.asarray(radii, dtype=float), -np.ones(len(radii))], axis=1)
    return scatter**2 * np.linalg.inv(design.T @ (design * np.broadcast_to(number, len(radii))[:, None]))


def joint_difference(fit, points, line, design, seeds, grain_radius):
    """JointDifference of a SizeFit of points (points.Points) and a paper's line (c1, c2); None where there is no scatter.

    Both lines scatter as ours: one scatter of a run, pooled over the sizes; the paper's line has `seeds` runs at each radius
    of `design` [grain radii], since it states no errors."""
    at = points.velocity == fit.velocity
    scatter, freedom = pooled_scatter(points.raw_d_scatter[at] / grain_radius, points.number[at])
    if not scatter:
        return None
    ours = line_covariance(points.radius[at] / grain_radius, points.number[at], scatter)
    theirs = line_covariance(design, seeds, scatter)
    return _difference((fit.values["c1"], fit.values["c2"]), ours + theirs, line, freedom)


def adjusted_difference(radius, d_max, covariate, line, design, seeds, total):
    """JointDifference of A24's line and d_max = c1 R - c2 + b R x by least squares over runs: radius, d_max [grain radii],
    covariate x (n,); the scatter of a run is that about this fit, A24's, which has no covariate, `total`."""
    matrix = np.stack([radius, -np.ones(len(radius)), radius * covariate], axis=1)
    values, rest, _, _ = np.linalg.lstsq(matrix, d_max, rcond=None)
    freedom = len(radius) - 3
    ours = rest[0] / freedom * np.linalg.inv(matrix.T @ matrix)[:2, :2]
    return _difference(values[:2], ours + line_covariance(design, seeds, total), line, freedom)


def _difference(values, covariance, line, freedom):
    away = np.array(values) - np.array(line)
    return JointDifference(float(away @ np.linalg.solve(covariance, away)), freedom)
