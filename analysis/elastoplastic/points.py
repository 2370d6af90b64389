"""Seeds of one parameter set gathered into points, and their bootstrap.

A seed is one pair of aggregates; at other velocities (same filling and radius) it is the same pair, so that
such points are not independent. The bootstrap therefore draws one weight for each pair and uses it at all
velocities (Rubin's Bayesian bootstrap: Dirichlet weights), and stretches the deviations from the mean by
[(n+1)/(n-1)]^(1/2), without which the errors of few seeds come out too small."""

from dataclasses import dataclass

import numpy as np
from scipy.special import digamma

RESAMPLES = 1000
RANDOM_SEED = 20240124


@dataclass(frozen=True)
class Points:
    """K parameter sets: filling, radius [m], velocity [m/s], number of seeds (K,); seeds (K,) tuples; d_max
    [m], t_max [s] (K,) means, or (B, K) for B resamples; d_scatter, t_scatter (K,): standard deviations of
    one run, smoothed (smoothed_scatter; nan where no point of that size has two seeds), raw_d_scatter,
    raw_t_scatter: each point's own (nan for one seed); samples (K,) tuples of (d (n,), t (n,))."""

    filling: np.ndarray
    radius: np.ndarray
    velocity: np.ndarray
    number: np.ndarray
    seeds: tuple
    samples: tuple
    d_max: np.ndarray
    t_max: np.ndarray
    d_scatter: np.ndarray
    t_scatter: np.ndarray
    raw_d_scatter: np.ndarray
    raw_t_scatter: np.ndarray

    def __len__(self):
        return len(self.filling)

    def chosen(self, mask):
        """Points of the mask (K,)."""
        index = np.flatnonzero(mask)
        return Points(
            self.filling[index],
            self.radius[index],
            self.velocity[index],
            self.number[index],
            tuple(self.seeds[i] for i in index),
            tuple(self.samples[i] for i in index),
            self.d_max[..., index],
            self.t_max[..., index],
            self.d_scatter[index],
            self.t_scatter[index],
            self.raw_d_scatter[index],
            self.raw_t_scatter[index],
        )

    @property
    def groups(self):
        """(K,) int: one number for each (filling, radius)."""
        return np.unique(np.stack([self.filling, self.radius]), axis=1, return_inverse=True)[1].ravel()


def points_of(rows, d_max=lambda row: row.d_max):
    """Points of rows (measure.Row), sorted by filling, radius, velocity. d_max: what is taken for it."""
    sets = {}
    for row in rows:
        key = (round(row.filling, 6), round(row.radius / row.grain_radius, 3), round(row.velocity, 6))
        sets.setdefault(key, []).append(row)
    members = [sorted(sets[key], key=lambda row: row.seed) for key in sorted(sets)]
    samples = tuple((np.array([d_max(r) for r in m]), np.array([r.t_max for r in m])) for m in members)
    filling, radius, velocity = (
        np.array([getattr(m[0], name) for m in members], dtype=float) for name in ("filling", "radius", "velocity")
    )
    return make_points(filling, radius, velocity, samples, tuple(tuple(r.seed for r in m) for m in members))


def make_points(filling, radius, velocity, samples, seeds):
    """Points from arrays (K,), samples ((d (n,), t (n,)) a point) and seeds (a tuple of n a point)."""
    number = np.array([len(d) for d, _ in samples])
    d_max, t_max = (np.array([sample[i].mean() for sample in samples]) for i in (0, 1))
    raw = [np.array([sample[i].std(ddof=1) if len(sample[i]) > 1 else np.nan for sample in samples]) for i in (0, 1)]
    points = Points(filling, radius, velocity, number, seeds, samples, d_max, t_max, *raw, *raw)
    smooth = [np.full(len(number), np.nan) for _ in raw]
    for group in range(points.groups.max() + 1 if len(points) else 0):
        mask = points.groups == group
        for values, own in zip(smooth, raw):
            values[mask] = smoothed_scatter(velocity[mask], own[mask], number[mask])
    return Points(filling, radius, velocity, number, seeds, samples, d_max, t_max, *smooth, *raw)


def smoothed_scatter(velocity, scatter, number):
    """Standard deviations (K,) of one run that follow a power of the velocity, from each point's own (K,) and
    its number of seeds: ln s^2 against ln v by least squares, weighted with the degrees of freedom and freed
    of its bias (digamma). A constant for less than four points; nan without any point of two seeds.

    Weights 1/s^2 of three seeds each would vary by orders of magnitude by chance alone."""
    known = np.isfinite(scatter) & (scatter > 0) & (number > 1)
    if not known.any():
        return np.full(len(scatter), np.nan)
    freedom = number[known] - 1.0
    log = 2.0 * np.log(scatter[known]) - digamma(freedom / 2.0) + np.log(freedom / 2.0)
    x = np.log(velocity)
    degree = 1 if known.sum() >= 4 and np.ptp(x[known]) > 0 else 0
    return np.exp(0.5 * np.polyval(np.polyfit(x[known], log, degree, w=np.sqrt(freedom)), x))


def resampled(points, resamples=RESAMPLES, random_seed=RANDOM_SEED):
    """d_max, t_max (B, K) of B bootstrap resamples (the module's head). A point with one seed varies by the
    smoothed scatter of its size; where there is none, not at all."""
    random = np.random.default_rng(random_seed)
    d_max, t_max = (np.tile(mean, (resamples, 1)) for mean in (points.d_max, points.t_max))
    for group in np.unique(points.groups):
        members = np.flatnonzero(points.groups == group)
        pairs = sorted(set().union(*(points.seeds[k] for k in members)))
        weights = random.exponential(size=(resamples, len(pairs)))
        alone = random.normal(size=(resamples, len(members), 2))
        for place, k in enumerate(members):
            n = points.number[k]
            if n == 1:
                for i, (values, scatter) in enumerate(((d_max, points.d_scatter), (t_max, points.t_scatter))):
                    values[:, k] += np.nan_to_num(scatter[k]) * alone[:, place, i]
                continue
            own = weights[:, [pairs.index(seed) for seed in points.seeds[k]]]
            own = own / own.sum(axis=1, keepdims=True) * np.sqrt((n + 1.0) / (n - 1.0))
            for values, mean, sample in ((d_max, points.d_max, 0), (t_max, points.t_max, 1)):
                values[:, k] += own @ (points.samples[k][sample] - mean[k])
    return d_max, t_max


def standard_error(values):
    """Standard deviation over resamples (B,...), of those that are finite; None where there is no scatter."""
    values = np.asarray(values, dtype=float)
    values = values[np.isfinite(values)]
    spread = float(values.std(ddof=1)) if values.size > 1 else 0.0
    return spread if spread > 0 else None


def percentile_error(values):
    """Half the distance between the 15.87 and the 84.13 per cent of resamples (B,), which is one standard
    deviation of a normal distribution and bears the long tails of a modulus; None where it is zero or not
    finite."""
    low, high = np.quantile(values, [0.158655, 0.841345], method="nearest")
    spread = 0.5 * float(high - low) if np.isfinite(high) else np.inf
    return spread if np.isfinite(spread) and spread > 0 else None
