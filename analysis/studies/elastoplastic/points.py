"""Seeds of one parameter set gathered into points, and their bootstrap.

A seed is one pair of aggregates; at other velocities (same filling and radius) it is the same pair, so that
such points are not independent. The bootstrap therefore draws one weight for each pair and uses it at all
velocities (statistics.weighted_deviations)."""

from dataclasses import dataclass, fields

import numpy as np

from ...statistics import RANDOM_SEED, RESAMPLES, scatter, smoothed_scatter, weighted_deviations


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
        parts = (getattr(self, field.name) for field in fields(self))
        return Points(*(tuple(p[i] for i in index) if isinstance(p, tuple) else p[..., index] for p in parts))

    @property
    def groups(self):
        """(K,) int: one number for each (filling, radius)."""
        return np.unique(np.stack([self.filling, self.radius]), axis=1, return_inverse=True)[1].ravel()

    @property
    def varies(self):
        """(K,) bool: whether a point's resamples differ: it has two seeds, or another one of its size has."""
        return np.isin(self.groups, self.groups[self.number > 1])


def parameter_sets(table):
    """[(filling, radius [grain radii], velocity [m/s]), table of its runs in the order of `table`], sorted."""
    keys = [table.filling.round(6), (table.radius / table.grain_radius).round(3), table.velocity.round(6)]
    return list(table.groupby(keys, sort=True))


def points_of(table, d_max=lambda table: table.d_max):
    """Points of a table of runs (measure.COLUMNS), sorted by filling, radius, velocity. d_max: what is taken for it, a
    column of the table."""
    members = [runs.sort_values("seed", kind="stable") for _, runs in parameter_sets(table)]
    samples = tuple((d_max(runs).to_numpy(dtype=float), runs.t_max.to_numpy(dtype=float)) for runs in members)
    first = [runs.iloc[0] for runs in members]
    filling, radius, velocity = (np.array([row[n] for row in first], float) for n in ("filling", "radius", "velocity"))
    return make_points(filling, radius, velocity, samples, tuple(tuple(map(int, runs.seed)) for runs in members))


def make_points(filling, radius, velocity, samples, seeds):
    """Points from arrays (K,), samples ((d (n,), t (n,)) a point) and seeds (a tuple of n a point)."""
    number = np.array([len(d) for d, _ in samples])
    d_max, t_max = (np.array([sample[i].mean() for sample in samples]) for i in (0, 1))
    raw = [np.array([scatter(sample[i]) for sample in samples]) for i in (0, 1)]
    points = Points(filling, radius, velocity, number, seeds, samples, d_max, t_max, *raw, *raw)
    smooth = [np.full(len(number), np.nan) for _ in raw]
    for group in range(points.groups.max() + 1 if len(points) else 0):
        mask = points.groups == group
        for values, own in zip(smooth, raw):
            values[mask] = smoothed_scatter(velocity[mask], own[mask], number[mask])
    return Points(filling, radius, velocity, number, seeds, samples, d_max, t_max, *smooth, *raw)


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
            if points.number[k] == 1:
                for i, (values, spread) in enumerate(((d_max, points.d_scatter), (t_max, points.t_scatter))):
                    values[:, k] += np.nan_to_num(spread[k]) * alone[:, place, i]
                continue
            own = weights[:, [pairs.index(seed) for seed in points.seeds[k]]]
            for values, sample in zip((d_max, t_max), points.samples[k]):
                values[:, k] += weighted_deviations(sample, own)
    return d_max, t_max
