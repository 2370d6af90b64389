"""What is left of a collision: means and intervals of LEFT, from the runs that are most like it.

The runs that share leaves of extremely randomised trees (Geurts et al. 2006) with a query are its distribution (as in quantile regression
forests, Meinshausen 2006), of numbers in units that carry over to other sizes: what the target has gained over the projectile's mass, or lost
over its own; the second largest piece over the projectile's mass; the filling over that before. Intervals are calibrated: the part of the distribution that they take is that which holds
LEVEL of the fitted runs when each is foretold from the others (distributional conformal prediction, Chernozhukov et al. 2021).

Means of the largest pieces are those of each outcome's runs, by the probabilities of the outcomes: with these they are consistent.

Half of the collisions and more leave one piece. No interval that such a run ends can hold a chosen part of the runs, so the intervals of
the largest and second largest piece are of collisions that leave more than one."""

from functools import cached_property

import numpy as np
import pandas

from .rules import KINDS, OF_KIND, change
from .variables import LEFT, SEED, folds, left, offsets, scaled, variables

TREES, LEAF = 100, 3  # of the forest, and runs in a leaf of it
LEVEL = 0.9  # of all intervals
CHUNK = 500  # queries at once, which bounds memory
SIDES = "gained", "lost"  # parts of `largest`
PIECES = *SIDES, "second", "eroded"
TRAINED = "largest", "second", "filling_after"  # what the trees are grown for


class Remains:
    """Fitted to a table of runs (DataFrame with the columns of atlas.columns)."""

    def __init__(self, runs):
        self.runs, self.points = runs.reset_index(drop=True), scaled(variables(runs))
        several, ratio, changed = self.runs.second > 0, self.runs.mass_ratio, change(self.runs)
        gained, lost = changed.clip(lower=0), changed.clip(upper=0)
        filling = self.runs.filling_largest / variables(self.runs).filling
        second = self.runs.second * (1 + 1 / ratio)
        pieces = {"gained": gained, "lost": lost, "second": second, "eroded": -lost / ratio}
        self.own = left(self.runs).assign(largest=changed, filling_after=filling, **pieces)
        of_parts = dict.fromkeys(("largest", *PIECES), several)
        self.known = self.own.notna().assign(**of_parts)

    @cached_property
    def _trees(self):
        return _Trees(self.points, self.own[list(TRAINED)])

    def means(self, points, chances, upto=None):
        """DataFrame of LEFT and OF_KIND, means at variables() points with the chances (n, 5) of KINDS; upto: as Model.probabilities has it.

        gain_mass_transfer and loss_erosion: what the larger aggregate gains or loses over the smaller one's mass; largest_fragmentation: the
        largest piece over the larger aggregate's mass; each where that is the outcome."""
        parts = []
        for rows, here, weights in self._chunks(points, upto):
            of_kinds = [self._pieces(kind, weights) for kind in KINDS]
            pieces = sum(p[:, None] * own for p, own in zip(chances[rows].T, of_kinds))
            told = {name: np.matmul(*self._distribution(name, weights)) for name in LEFT[2:]}
            found = _in_table(pieces.assign(**told), here)
            found["second"] = np.minimum(found.second, np.minimum(found.largest, 1 - found.largest))
            transfer, erosion, fragmentation = (of_kinds[KINDS.index(kind)] for kind in OF_KIND.values())
            values = transfer.gained, erosion.eroded, 1 + fragmentation.lost
            parts.append(found.assign(**dict(zip(OF_KIND, values))))
        return pandas.concat(parts, ignore_index=True)

    def _pieces(self, kind, weights):
        """DataFrame (n, PIECES), means of the runs of that outcome; 0 where there are none."""
        rows = (self.runs.outcome == kind).to_numpy()
        return pandas.DataFrame(_shares(weights[:, rows]) @ self.own.loc[rows, list(PIECES)].to_numpy(), columns=PIECES)

    def intervals(self, points):
        """DataFrame of NAME_low and NAME_high for LEFT: ends of the intervals that hold LEVEL of such runs."""
        parts = []
        for _, here, weights in self._chunks(points):
            ends = []
            for end, sign in (("low", -1), ("high", 1)):
                reach = lambda name: self.reach["largest" if name in SIDES else name]
                at = {
                    name: _quantiles(*self._distribution(name, weights), 0.5 + sign * reach(name))
                    for name in (*SIDES, *LEFT[1:])
                }
                ends.append(_in_table(pandas.DataFrame(at), here).add_suffix(f"_{end}"))
            parts.append(pandas.concat(ends, axis=1))
        return pandas.concat(parts, ignore_index=True)

    def _chunks(self, points, upto=None):
        """(slice, points there, weights (n, runs)) of parts of the points, as memory bounds them."""
        for start in range(0, len(points), CHUNK):
            rows = slice(start, start + CHUNK)
            here = points.iloc[rows].reset_index(drop=True)
            yield rows, here, self._trees.weights(offsets(scaled(here), upto))

    def _distribution(self, name, weights):
        """(weights (n, k) of sum 1 of the runs that have that number, their numbers (k,))."""
        rows = self.known[name].to_numpy()
        return _shares(weights[:, rows]), self.own[name].to_numpy()[rows]

    @cached_property
    def reach(self):
        """{name of LEFT: how far from the median, in probability, the ends of its interval are}: from the ranks of the fitted runs in the
        distributions that the others foretell."""
        ranks = pandas.DataFrame(np.nan, index=self.runs.index, columns=list(LEFT))
        for others, own in folds(len(self.runs)):
            trees = _Trees(self.points[others], self.own[list(TRAINED)].iloc[others])
            weights = trees.weights([self.points[own]])
            for name in LEFT:
                is_known, values = self.known[name].to_numpy(), self.own[name].to_numpy()
                share = _shares(weights[:, is_known[others]])
                ranks.loc[own, name] = _ranks(share, values[others][is_known[others]], values[own])
        return {name: _reach(np.abs(ranks[name][self.known[name]] - 0.5)) for name in LEFT}


class _Trees:
    """Weights of the runs at coordinates (n, 5)."""

    def __init__(self, points, values):
        from sklearn.ensemble import ExtraTreesRegressor
        from sklearn.preprocessing import OneHotEncoder

        values = (values / values.std().where(lambda scatter: scatter > 1e-9, 1.0)).fillna(
            0.0
        )  # all alike, but for rounding
        self.forest = ExtraTreesRegressor(TREES, min_samples_leaf=LEAF, random_state=SEED).fit(points, values)
        leaves = self.forest.apply(points)
        self.leaves = OneHotEncoder(handle_unknown="ignore").fit(leaves)
        shared = self.leaves.transform(leaves)
        self.runs = shared.multiply(1 / shared.sum(axis=0)).T.tocsr()

    def weights(self, several):
        """(n, runs), rows of sum 1: mean over [coordinates (n, 5)]."""
        shared = sum(self.leaves.transform(self.forest.apply(points)) for points in several)
        return (shared @ self.runs).toarray() / (TREES * len(several))


def _in_table(own, points):
    """LEFT in the units of the table of runs, from those of the forest, at variables() points."""
    share = 1 / (1 + points.mass_ratio)
    return pandas.DataFrame(
        {
            "largest": share + own.gained * (1 - share) + own.lost * share,
            "second": (own.second * (1 - share)).clip(0, 0.5),
            "fragment_index": own.fragment_index,
            "filling_after": (own.filling_after * points.filling).clip(0, 1),
        }
    )


def _shares(weights):
    """Rows of sum 1; where no run has a weight, of all alike."""
    weights = weights + 1e-12
    return weights / weights.sum(axis=1, keepdims=True)


def _quantiles(weights, values, part):
    order = np.argsort(values)
    sums = np.cumsum(weights[:, order], axis=1)
    return values[order][np.argmax(sums >= part - 1e-9, axis=1)]


def _ranks(weights, values, own):
    """Part of each distribution, a row of weights (n, k) of values (k,), below own (n,), half of what equals it with it."""
    below, equal = values < own[:, None] - 1e-12, np.abs(values - own[:, None]) <= 1e-12
    return (weights * (below + 0.5 * equal)).sum(axis=1)


def _reach(distances):
    """The distance from 1/2 that LEVEL of them, and of one more, do not exceed."""
    number = len(distances)
    rank = int(np.ceil(LEVEL * (number + 1)))
    return np.sort(distances)[rank - 1] if rank <= number else 0.5
