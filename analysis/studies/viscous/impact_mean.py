"""Means over the impact parameter (A22 eq 29), with errors from the seeds.

A seed is one pair of aggregates, the same at every B_off, velocity and T_vis: the bootstrap draws one weight for each
pair of a size and uses it everywhere (statistics.weighted_deviations), so that differences and ratios of what is
measured with the same pairs have the errors that they should. A mean counts the pairs that have all of its offsets."""

import numpy as np

from ...statistics import RANDOM_SEED, RESAMPLES, weighted_deviations
from . import paper
from .whole_pairs import offset_squares, whole_pairs

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


def offsets_text(offsets):
    """What to write after a mean over offsets (B_off^2, rising): '' for the paper's 13, which eq 29's numbers are of; with
    others it is another number: the head-on peak has the weight of half a step.

    >>> offsets_text((0.0, 0.5, 1.0)), offsets_text([k / 12 for k in range(13)])
    (', 3 offsets', '')
    """
    same = len(offsets) == len(paper.SQUARES) and np.allclose(offsets, paper.SQUARES, atol=1e-5)
    return "" if same or len(offsets) < FEWEST_IMPACTS else f", {len(offsets)} offsets"


def of_papers_offsets(offsets, theirs):
    """The paper's number `theirs` for means over offsets (B_off^2, rising), None where these are not the paper's."""
    return None if offsets_text(offsets) else theirs


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
    keys = offset_squares(runs)
    seeds, values = runs.seed.to_numpy(), np.asarray(values, dtype=float)
    return [(float(key), values[keys == key], seeds[keys == key]) for key in np.unique(keys)]


def whole_impacts(runs):
    """(the runs that a mean over B_off counts, its offsets (B_off^2, rising)) of a table of runs of one size and T_vis: those of
    pairs that, at their velocity, have all offsets. Where none has them from 0 to 1 by itself but all together have, they
    count as one pair, without error; () where not even these."""
    velocities = runs.velocity.round(6) if "velocity" in runs else np.zeros(len(runs))
    squares = offset_squares(runs)
    kept, offsets = whole_pairs(runs, squares, zip(velocities, runs.seed), spans)
    if offsets:
        return kept, offsets
    return whole_pairs(runs.assign(seed=runs.seed.min()), squares, velocities, spans)


def pair_means(runs, values):
    """(A22's <A> (P, ...) of each pair of aggregates, seeds (P,)) of a table of runs of one size, velocity and T_vis that
    whole_impacts has let through; values: A of its rows, (runs, ...)."""
    squares, seeds = offset_squares(runs), runs.seed.to_numpy()
    values, offsets, pairs = np.asarray(values, dtype=float), np.unique(squares), np.unique(seeds)
    means = [
        sum(w * values[(seeds == seed) & (squares == s)].mean(axis=0) for w, s in zip(impact_weights(offsets), offsets))
        for seed in pairs
    ]
    return np.array(means), pairs


def impact_mean(runs, values, draws):
    """(<A>, resamples (B, ...)) of A22 eq 29 over a table of runs of one size, velocity and T_vis; values: A of its rows,
    (runs, ...). None where their B_off don't go from 0 to 1."""
    kept, offsets = whole_impacts(runs.assign(place=np.arange(len(runs))))
    if not offsets:
        return None
    means, seeds = pair_means(kept, np.asarray(values, dtype=float)[kept.place])
    mean = means.mean(axis=0)
    return mean, mean + draws.deviations(means, seeds)


def head_on_runs(runs):
    """As whole_impacts, of the head-on collisions."""
    return runs[runs.impact == 0], (0.0,)


def head_on_mean(runs, values, draws):
    """As impact_mean, of the head-on collisions alone."""
    points = [(samples, seeds) for square, samples, seeds in at_impacts(runs, values) if square == 0]
    if not points:
        return None
    ((samples, seeds),) = points
    pairs = np.unique(seeds)
    means = np.array([samples[seeds == seed].mean(axis=0) for seed in pairs])
    return means.mean(axis=0), means.mean(axis=0) + draws.deviations(means, pairs)
