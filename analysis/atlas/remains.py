"""What is left of a collision: means and intervals of LEFT, from the runs that are most like it.

The runs that share leaves of extremely randomised trees (Geurts et al. 2006) with a query are its distribution (as in quantile regression
forests, Meinshausen 2006), of numbers in units that carry over to other sizes: what the target has gained over the projectile's mass, or lost
over its own; the second largest piece over the projectile's mass; the filling over that before. Intervals are calibrated: the part of the distribution that they take is that which holds
LEVEL of the fitted runs when each is foretold from the others (distributional conformal prediction, Chernozhukov et al. 2021).

Three quarters of the collisions may leave one piece. No interval that such a run ends can hold a chosen part of the runs, so the intervals of
the largest and second largest piece are of collisions that leave more than one."""

from functools import cached_property

import numpy as np
import pandas

from .variables import LEFT, SEED, folds, left, offsets, scaled, variables

TREES, LEAF = 100, 3  # of the forest, and runs in a leaf of it
LEVEL = 0.9  # of all intervals
CHUNK = 500  # queries at once, which bounds memory
SIDES, GROWN = (
    ("gained", "lost"),
    ("largest", "second", "filling_after"),
)  # parts of `largest`; what the trees are grown for


class Remains:
    """Fitted to a table of runs (DataFrame with the columns of atlas.columns)."""

    def __init__(self, runs):
        self.runs, self.points = runs.reset_index(drop=True), scaled(variables(runs))
        several, share = self.runs.second > 0, 1 / (1 + self.runs.mass_ratio)
        more = self.runs.largest - share
        gained, lost = more.clip(lower=0) / (1 - share), more.clip(upper=0) / share
        filling = self.runs.filling_largest / variables(self.runs).filling
        second = self.runs.second / (1 - share)
        self.own = left(self.runs).assign(
            largest=gained + lost, second=second, filling_after=filling, gained=gained, lost=lost
        )
        of_parts = dict.fromkeys(("largest", "second", *SIDES), several)
        self.known = self.own.notna().assign(**of_parts)

    @cached_property
    def _trees(self):
        return _Trees(self.points, self.own[list(GROWN)])

    def means(self, points, upto=None):
        """DataFrame of LEFT, means at variables() points; upto: as Model.probabilities has it."""
        return self._told(points, upto, lambda name, weights, own: weights @ own, self.own.notna())

    def intervals(self, points):
        """DataFrame of NAME_low and NAME_high for LEFT: ends of the intervals that hold LEVEL of such runs."""
        found = []
        for end, sign in (("low", -1), ("high", 1)):
            reach = lambda name: self.reach["largest" if name in SIDES else name]
            at = lambda name, weights, own: _quantiles(weights, own, 0.5 + sign * reach(name))
            found.append(self._told(points, None, at, self.known).add_suffix(f"_{end}"))
        return pandas.concat(found, axis=1)

    def _told(self, points, upto, tell, known):
        """DataFrame of tell(name, weights (n, k) of the known runs, their numbers (k,)) for LEFT, in the units of the table."""
        parts = []
        for start in range(0, len(points), CHUNK):
            here = points.iloc[start : start + CHUNK]
            weights = self._trees.weights(offsets(scaled(here), upto))
            found = {}
            for name in (*SIDES, *LEFT[1:]):
                rows = known[name].to_numpy()
                found[name] = tell(name, _shares(weights[:, rows]), self.own[name].to_numpy()[rows])
            parts.append(_in_table(pandas.DataFrame(found), here.reset_index(drop=True)))
        return pandas.concat(parts, ignore_index=True)

    @cached_property
    def reach(self):
        """{name of LEFT: how far from the median, in probability, the ends of its interval are}: from the ranks of the fitted runs in the
        distributions that the others foretell."""
        ranks = pandas.DataFrame(np.nan, index=self.runs.index, columns=list(LEFT))
        for others, own in folds(len(self.runs)):
            trees = _Trees(self.points[others], self.own[list(GROWN)].iloc[others])
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
