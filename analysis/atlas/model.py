"""The model of the outcomes, fitted to the table of runs with scikit-learn.

Probabilities of the outcomes are logistic regressions on polynomials of third order of the coordinates, fitted to
decided runs, but for the held-out ones, of all materials together. Errors are the scatter of fits with random weights
of the runs (the Bayesian bootstrap, Rubin 1981); undecided runs are in these alone, each time with an outcome drawn.
"""

from functools import cached_property

import numpy as np
import pandas
from sklearn.base import clone
from sklearn.ensemble import ExtraTreesRegressor
from sklearn.linear_model import LogisticRegression
from sklearn.model_selection import GridSearchCV
from sklearn.pipeline import Pipeline
from sklearn.preprocessing import OneHotEncoder, PolynomialFeatures, StandardScaler

from ..measures.outcome import NEVER_MET, UNDECIDED
from .outcome_table import LEFT
from .rules import KINDS, OF_KIND, change, outcome
from .variables import FIT, ONE_CONTACT, energy, fit_and_held_out, scaled, slow, variables

MEMBERS = 40  # fits with random weights
ORDER = 3  # the best one on held-out runs
STRENGTHS = 0.1, 0.3, 1.0, 3.0, 10.0  # 1/regularisation; cross-validation chooses one
STRENGTH = 3.0  # which it chooses for all runs together
LEVEL = 0.9  # of all intervals
SEED, FOLDS = 1, 5  # of cross-validation
LEAST = 1e-3  # probability of what was observed in a logarithmic loss
OFFSETS = (np.arange(8) + 0.5) / 8  # squares of impact parameters of an average
STICKING, BOUNCING = KINDS[:2]


def classifier(strength=STRENGTH, order=ORDER):
    """The unfitted logistic regression on polynomials of that order."""
    return Pipeline(
        [
            ("scale", StandardScaler()),
            ("powers", PolynomialFeatures(order, include_bias=False)),
            ("fit", LogisticRegression(C=strength, max_iter=10000)),
        ]
    )


def best_classifier(points, outcomes):
    """The classifier() with that one of STRENGTHS which has the least cross-validated logarithmic loss: mean of -ln of
    the probability of what was observed, which counts as LEAST at least."""

    def score(fit, points, outcomes):
        observed = chances(fit, points)[outcomes[:, None] == np.array(KINDS)]
        return np.log(np.maximum(observed, LEAST)).mean()

    search = GridSearchCV(classifier(), {"fit__C": STRENGTHS}, scoring=score, cv=folds(len(points)), refit=False)
    return classifier(search.fit(points, np.asarray(outcomes)).best_params_["fit__C"])


def chances(fit, points):
    """Probabilities (n, 5) of KINDS by a fitted classifier; 0 for those that it was not shown."""
    found = np.zeros((len(points), len(KINDS)))
    found[:, [KINDS.index(kind) for kind in fit.classes_]] = fit.predict_proba(points)
    return found


def folds(number):
    """[(rows of the others, rows)] of FOLDS parts of so many rows, drawn at random."""
    parts = np.array_split(np.random.default_rng(SEED).permutation(number), FOLDS)
    return [(np.concatenate([part for part in parts if part is not own]), own) for own in parts]


def offsets(points, averaged):
    """[coordinates (n, 5)] of points at each impact parameter of an average uniform in b^2, or as they are."""
    coordinates = scaled(points)
    if not averaged:
        return [coordinates]
    return [np.column_stack([coordinates[:, :-1], np.full(len(coordinates), square)]) for square in OFFSETS]


class Model:
    """The model of a table of runs (atlas.columns), with `members` fits with random weights.

    Points are those of variables(). averaged: over impact parameters, uniform in b^2, whatever the points have.
    """

    def __init__(self, table, members=MEMBERS):
        self.runs, _ = fit_and_held_out(table)
        self.slow, self.members = slow(self.runs), members
        self._points, self._all = scaled(variables(self.runs)), table[table.split == FIT]

    @cached_property
    def remains(self):
        """The Remains of these runs."""
        return Remains(self.runs)

    def probabilities(self, points, averaged=False):
        """Probabilities p (n, 5) of rules.KINDS and half widths (n, 5) of their intervals of LEVEL."""
        fits = np.stack([self._of_fit(fit, points, averaged) for fit in self._fits])
        low, high = np.quantile(fits[1:], (0.5 - LEVEL / 2, 0.5 + LEVEL / 2), axis=0)
        own = energy(points)
        never_yet = np.where((own >= ONE_CONTACT) & (own < self.slow.energy), self.slow.most, 0.0)
        return fits[0], np.maximum((high - low) / 2, never_yet[:, None])

    def touching(self, points, averaged=False):
        """Probability (n,) that aggregates with b < 1 touch; beyond the runs that of the nearest end."""
        if self._meeting is None:
            return np.ones(len(points))
        fit, *ends = self._meeting
        several = offsets(points, averaged)
        return np.mean([fit.predict_proba(np.clip(at[:, 1:], *ends))[:, 1] for at in several], axis=0)

    def _of_fit(self, fit, points, averaged):
        found = np.mean([chances(fit, at) for at in offsets(points, averaged)], axis=0)
        # A regression leaves other outcomes where all runs stick: they fade out from that energy to half of it.
        fade = np.clip(1 + np.log2(energy(points).to_numpy() / self.slow.energy), 0.0, 1.0)
        found[:, 1:] *= fade[:, None]
        found[:, 0] = 1 - found[:, 1:].sum(axis=1)
        return found

    @cached_property
    def _fits(self):
        """The fit to the decided runs, and those with random weights to all that touched."""
        best, random = best_classifier(self._points, self.runs.outcome), np.random.default_rng(SEED)
        undecided = self._all[self._all.outcome == UNDECIDED]
        at_end = outcome(undecided).astype(object)
        points = np.concatenate([self._points, scaled(variables(undecided))])
        found = [clone(best).fit(self._points, self.runs.outcome)]
        for _ in range(self.members):
            outcomes = np.concatenate([self.runs.outcome, _guessed(at_end, random)])
            weights = random.exponential(size=len(points))
            found.append(clone(best).fit(points, outcomes, fit__sample_weight=weights))
        return found

    @cached_property
    def _meeting(self):
        """Fit to whether aggregates touch, without the velocity, as it is geometry, and ends of the runs' coordinates;
        None where all touch."""
        touched, points = self._all.outcome != NEVER_MET, scaled(variables(self._all))[:, 1:]
        if touched.all():
            return None
        return classifier(order=2).fit(points, touched), points.min(axis=0), points.max(axis=0)


def _guessed(at_end, random):
    """Outcomes (n,) of undecided runs, some as they were when the run ended, and the others sticking, or bouncing where
    they stuck then; how many is drawn anew each time."""
    other = np.where(at_end == STICKING, BOUNCING, STICKING)
    return np.where(random.uniform(size=len(at_end)) < random.uniform(), at_end, other)


TREES, LEAF = 100, 3  # of the forest, and runs in a leaf of it
TRAINED = ("largest", "second", "filling_after")  # what the trees are grown for
SIDES = ("gained", "lost")  # parts of `largest`
PIECES = (*SIDES, "second", "eroded")
QUERIES = 500  # at once, which bounds memory


def left(table):
    """DataFrame of outcome_table.LEFT of a table of runs."""
    return table.rename(columns={"filling_largest": "filling_after"})[list(LEFT)]


class Remains:
    """What is left of collisions: means and intervals of LEFT, from the runs that are most like them.

    The runs that share leaves of extremely randomised trees (Geurts et al. 2006) with a query are its distribution, as
    in quantile regression forests (Meinshausen 2006), of numbers that carry over to other sizes: what the target has
    gained over the projectile's mass, or lost over its own; the second piece over the projectile's mass; the filling
    over that before. An interval takes so much of the distribution that it holds LEVEL of the fitted runs, each
    predicted from the others (distributional conformal prediction, Chernozhukov et al. 2021).

    Half of the collisions leave one piece. As no interval that ends there holds a chosen part of the runs, the
    intervals of the largest and second piece are of collisions that leave more.
    """

    def __init__(self, runs):
        self.runs, self.points = runs.reset_index(drop=True), scaled(variables(runs))
        several, ratio = self.runs.second > 0, self.runs.mass_ratio
        changed = change(self.runs.largest, ratio)
        lost = changed.clip(upper=0)
        self._values = left(self.runs).assign(
            largest=changed,
            gained=changed.clip(lower=0),
            lost=lost,
            second=self.runs.second * (1 + 1 / ratio),
            eroded=-lost / ratio,
            filling_after=self.runs.filling_largest / variables(self.runs).filling,
        )
        self._known = self._values.notna().assign(**dict.fromkeys(("largest", *PIECES), several))

    @cached_property
    def _trees(self):
        return _Trees(self.points, self._values[list(TRAINED)])

    def means(self, points, p, averaged=False):
        """DataFrame (n rows) of means of LEFT and rules.OF_KIND at points, with the probabilities p (n, 5) of KINDS.

        Pieces are means over the outcomes by p, of each outcome's runs: consistent with p. averaged: as in Model.
        """
        parts = []
        for rows, here, weights in self._chunks(points, averaged):
            of_kinds = [self._pieces(kind, weights) for kind in KINDS]
            own = sum(p[:, None] * pieces for p, pieces in zip(p[rows].T, of_kinds))
            own = own.assign(**{name: np.matmul(*self._distribution(name, weights)) for name in LEFT[2:]})
            found = _in_table(own, here)
            found["second"] = np.minimum(found.second, np.minimum(found.largest, 1 - found.largest))
            transfer, erosion, fragmentation = (of_kinds[KINDS.index(kind)] for kind in OF_KIND.values())
            values = transfer.gained, erosion.eroded, 1 + fragmentation.lost
            parts.append(found.assign(**dict(zip(OF_KIND, values))))
        return pandas.concat(parts, ignore_index=True)

    def intervals(self, points):
        """DataFrame (n rows) of NAME_low and NAME_high for LEFT: ends of the intervals at points."""
        parts = []
        for _, here, weights in self._chunks(points, averaged=False):
            ends = []
            for end, sign in (("low", -1), ("high", 1)):
                at = {}
                for name in (*SIDES, *LEFT[1:]):
                    reach = self._reach["largest" if name in SIDES else name]
                    at[name] = _quantiles(*self._distribution(name, weights), 0.5 + sign * reach)
                ends.append(_in_table(pandas.DataFrame(at), here).add_suffix(f"_{end}"))
            parts.append(pandas.concat(ends, axis=1))
        return pandas.concat(parts, ignore_index=True)

    def _chunks(self, points, averaged):
        """(slice, points there, weights (n, runs)) of parts of the points."""
        for start in range(0, len(points), QUERIES):
            rows = slice(start, start + QUERIES)
            here = points.iloc[rows].reset_index(drop=True)
            yield rows, here, self._trees.weights(offsets(here, averaged))

    def _pieces(self, kind, weights):
        """DataFrame (n, PIECES): means over the runs of an outcome; 0 where there are none."""
        rows = (self.runs.outcome == kind).to_numpy()
        own = self._values.loc[rows, list(PIECES)].to_numpy()
        return pandas.DataFrame(_shares(weights[:, rows]) @ own, columns=PIECES)

    def _distribution(self, name, weights):
        """Weights (n, k) of sum 1 of the runs that have that number, and their numbers (k,)."""
        rows = self._known[name].to_numpy()
        return _shares(weights[:, rows]), self._values[name].to_numpy()[rows]

    @cached_property
    def _reach(self):
        """{name of LEFT: how far from the median, in probability, the ends of its interval are}: from the ranks of the
        runs in the distributions by which the others predict them."""
        ranks = pandas.DataFrame(np.nan, index=self.runs.index, columns=list(LEFT))
        for others, own in folds(len(self.runs)):
            trees = _Trees(self.points[others], self._values[list(TRAINED)].iloc[others])
            weights = trees.weights([self.points[own]])
            for name in LEFT:
                known, values = self._known[name].to_numpy(), self._values[name].to_numpy()
                share = _shares(weights[:, known[others]])
                ranks.loc[own, name] = _ranks(share, values[others][known[others]], values[own])
        return {name: _limit(np.abs(ranks[name][self._known[name]] - 0.5)) for name in LEFT}


class _Trees:
    """Weights of the runs at coordinates (n, 5): how many trees have them in the leaf of the query."""

    def __init__(self, points, values):
        scatter = values.std()
        scatter[scatter <= 1e-9] = 1.0  # all alike, but for rounding
        self.forest = ExtraTreesRegressor(TREES, min_samples_leaf=LEAF, random_state=SEED)
        self.forest.fit(points, (values / scatter).fillna(0.0))
        leaves = self.forest.apply(points)
        self.leaves = OneHotEncoder(handle_unknown="ignore").fit(leaves)
        shared = self.leaves.transform(leaves)
        self.runs = shared.multiply(1 / shared.sum(axis=0)).T.tocsr()

    def weights(self, several):
        """(n, runs), rows of sum 1: mean over [coordinates (n, 5)]."""
        shared = sum(self.leaves.transform(self.forest.apply(points)) for points in several)
        return (shared @ self.runs).toarray() / (TREES * len(several))


def _in_table(own, points):
    """LEFT in the units of the table of runs, from those of the trees, at points."""
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
    """Rows of sum 1; equal ones where no run has a weight."""
    weights = weights + 1e-12
    return weights / weights.sum(axis=1, keepdims=True)


def _quantiles(weights, values, part):
    """Quantile (n,) of each distribution, a row of weights (n, k) of values (k,)."""
    order = np.argsort(values)
    sums = np.cumsum(weights[:, order], axis=1)
    return values[order][np.argmax(sums >= part - 1e-9, axis=1)]


def _ranks(weights, values, own):
    """Part of each distribution that is below own (n,), and half of what equals it."""
    below, equal = values < own[:, None] - 1e-12, np.abs(values - own[:, None]) <= 1e-12
    return (weights * (below + 0.5 * equal)).sum(axis=1)


def _limit(distances):
    """The distance from 1/2 that LEVEL of them, and of one more, do not exceed."""
    number = len(distances)
    rank = int(np.ceil(LEVEL * (number + 1)))
    return np.sort(distances)[rank - 1] if rank <= number else 0.5
