"""Means over the impact parameter (A22 eq 29), with errors from the seeds.

A seed is one pair of aggregates, the same at every B_off, velocity and T_vis: the bootstrap draws one weight for each
pair of a size and uses it everywhere (statistics.weighted_deviations), so that differences and ratios of what is
measured with the same pairs have the errors that they should."""

import numpy as np

from ...statistics import RANDOM_SEED, RESAMPLES, weighted_deviations

FEWEST_IMPACTS = 3


def impact_weights(squares):
    """Weights (K,) of A at rising B_off^2 = squares (K,), from 0 to 1, in <A> = int_0^1 2 B A dB = int_0^1 A d(B^2): A22
    eq 29, by the trapezoidal rule in B_off^2, which is exact for A linear in B_off^2. On the paper's 13 points: 1/12 each,
    1/24 at both ends. ValueError where the squares don't go from 0 to 1.

    >>> impact_weights([0.0, 0.5, 1.0]).tolist()
    [0.25, 0.5, 0.25]
    """
    squares = np.asarray(squares, dtype=float)
    steps = np.diff(squares)
    if not spans(squares):
        raise ValueError(f"B_off^2 = {squares.tolist()}: must rise from 0 to 1")
    return 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps))


def spans(squares):
    """Whether squares (K,) of B_off rise from 0 to 1, to rounding, in FEWEST_IMPACTS points or more."""
    squares = np.asarray(squares, dtype=float)
    if len(squares) < FEWEST_IMPACTS:
        return False
    return bool(abs(squares[0]) < 1e-6 and abs(squares[-1] - 1) < 1e-6 and np.all(np.diff(squares) > 0))


class Draws:
    """RESAMPLES weights of each seed of one size: deviations() of a mean over runs of some of them."""

    def __init__(self, seeds, resamples=RESAMPLES, random_seed=RANDOM_SEED):
        self.place = {seed: i for i, seed in enumerate(sorted(set(map(int, seeds))))}
        self.weights = np.random.default_rng(random_seed).exponential(size=(resamples, len(self.place)))

    def deviations(self, samples, seeds):
        """(B, ...) deviations of the mean of samples (n, ...) of these seeds (n,); zeros for one seed."""
        samples = np.asarray(samples, dtype=float)
        found = np.zeros((len(self.weights), *samples.shape[1:]))
        if len(samples) > 1:
            own = self.weights[:, [self.place[int(seed)] for seed in seeds]]
            for index in np.ndindex(samples.shape[1:]):
                found[(slice(None), *index)] = weighted_deviations(samples[(slice(None), *index)], own)
        return found


def at_impacts(runs, values):
    """[(B_off^2, samples (n, ...), seeds (n,))] of a table of runs, sorted; values: (runs, ...) of its rows."""
    squares = runs.impact.to_numpy() ** 2
    seeds, values = runs.seed.to_numpy(), np.asarray(values, dtype=float)
    keys = squares.round(6)
    return [(float(key), values[keys == key], seeds[keys == key]) for key in np.unique(keys)]


def impact_mean(runs, values, draws):
    """(<A>, resamples (B, ...)) of A22 eq 29 over a table of runs of one size, velocity and T_vis; values: A of its rows,
    (runs, ...). None where their B_off don't go from 0 to 1."""
    points = at_impacts(runs, values)
    if not spans([square for square, *_ in points]):
        return None
    mean = resamples = 0.0
    for weight, (_, samples, seeds) in zip(impact_weights([square for square, *_ in points]), points):
        mean = mean + weight * samples.mean(axis=0)
        resamples = resamples + weight * (samples.mean(axis=0) + draws.deviations(samples, seeds))
    return mean, resamples


def head_on_mean(runs, values, draws):
    """As impact_mean, of the head-on collisions alone."""
    points = [(samples, seeds) for square, samples, seeds in at_impacts(runs, values) if square == 0]
    if not points:
        return None
    ((samples, seeds),) = points
    mean = samples.mean(axis=0)
    return mean, mean + draws.deviations(samples, seeds)


def has_scatter(runs):
    """Whether some B_off of a table of runs has two seeds or more, so that errors can be told."""
    return bool(runs.groupby(runs.impact.round(6)).seed.nunique().max() > 1)
