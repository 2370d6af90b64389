"""A model of the outcomes, fitted to the table of runs: scikit-learn's, in variables without dimensions.

Probabilities: logistic regression on polynomials of second order of FEATURES, its regularisation chosen by cross-validation; errors
from fits with random weights of the runs (the Bayesian bootstrap, Rubin 1981). What is left (LEFT): the runs that share leaves of a random
forest with a query are its distribution (quantile regression forests, Meinshausen 2006), of which the mean and quantiles are told.

Fitted are runs whose aggregates touched and whose outcome is decided, but for the held-out ones; runs of all materials together."""

from functools import cached_property
from importlib.util import find_spec

import numpy as np
import pandas

from .rules import KINDS
from .variables import LEFT, fit_and_held_out, left, scaled, variables

MEMBERS, TREES, LEAF = 40, 200, 5  # fits with random weights; of the forest, and runs in a leaf of it
STRENGTHS = 0.03, 0.1, 0.3, 1.0, 3.0, 10.0  # 1/regularisation, tried
FOLDS = 5
LEVEL = 0.9  # of all intervals
SEED = 1


class NoLearning(Exception):
    """scikit-learn is missing; the message is one line."""


def _require_learning():
    if find_spec("sklearn") is None:
        raise NoLearning(
            "scikit-learn is missing: must be installed (python3-sklearn, or pip install dust-analysis[atlas])"
        )


class Model:
    """Fitted to a table of runs (DataFrame with the columns of atlas.columns): its decided rows, but for those held out."""

    def __init__(self, table, members=MEMBERS):
        _require_learning()
        self.runs, _ = fit_and_held_out(table)
        self.points, self.members = scaled(variables(self.runs)), members

    @cached_property
    def _classifiers(self):
        strength = best_strength(self.points, self.runs.outcome)
        draws = np.random.default_rng(SEED).exponential(size=(self.members, len(self.runs)))
        weights = [np.ones(len(self.runs)), *draws]
        return [classifier(strength).fit(self.points, self.runs.outcome, fit__sample_weight=w) for w in weights]

    def probabilities(self, points, averaged=False):
        """(probabilities (n, 5) of rules.KINDS, half widths (n, 5) of their intervals of LEVEL) of variables() points; averaged: over impact
        parameters, uniform in b^2, whatever the points have. No half widths without members."""
        fits = np.stack([self._of_each(fit, points, averaged) for fit in self._classifiers])
        if len(fits) == 1:
            return fits[0], None
        low, high = np.quantile(fits[1:], (0.5 - LEVEL / 2, 0.5 + LEVEL / 2), axis=0)
        return fits[0], (high - low) / 2

    def _of_each(self, fit, points, averaged):
        found = np.zeros((len(points), len(KINDS)))
        for coordinates in _offsets(scaled(points), averaged):
            found += chances(fit, coordinates)
        found /= found.sum(axis=1, keepdims=True)
        found[:, 1:] *= np.clip(1 + np.log2(points.velocity.to_numpy() / self.slowest), 0.0, 1.0)[:, None]
        found[:, 0] = 1 - found[:, 1:].sum(axis=1)
        return found

    @cached_property
    def slowest(self):
        """Velocity over v_break of the slowest run that did not stick; infinite where all stuck. Below, other outcomes fade out, to none at half of it:
        what a regression leaves there is no run's, and disks have many slow collisions."""
        other = variables(self.runs).velocity[self.runs.outcome != KINDS[0]]
        return other.min() if len(other) else np.inf

    @cached_property
    def _forest(self):
        from sklearn.ensemble import RandomForestRegressor

        values = left(self.runs).drop(columns="fragment_index").fillna(0.0)
        forest = RandomForestRegressor(TREES, min_samples_leaf=LEAF, random_state=SEED).fit(
            self.points, values / values.std().replace(0.0, 1.0)
        )
        return forest, forest.apply(self.points)

    def _weights(self, points, averaged=False):
        """Weights (n, runs) of the runs in what is said of each point."""
        forest, of_runs = self._forest
        found = np.zeros((len(points), len(self.runs)))
        for coordinates in _offsets(scaled(points), averaged):
            of_points = forest.apply(coordinates)
            for tree in range(of_runs.shape[1]):
                shared = of_points[:, tree, None] == of_runs[:, tree]
                found += shared / shared.sum(axis=1, keepdims=True)
        return found / found.sum(axis=1, keepdims=True)

    def left(self, points, averaged=False):
        """DataFrame of LEFT: means, and in NAME_low and NAME_high the ends of the interval that LEVEL of such runs are in."""
        weights, values = self._weights(points, averaged), left(self.runs)
        found = {}
        for name in LEFT:
            known = values[name].notna().to_numpy()
            own = weights[:, known] + 1e-12  # where no run has one, of all alike
            own = own / own.sum(axis=1, keepdims=True)
            y = values[name].to_numpy()[known]
            order = np.argsort(y)
            sums = np.cumsum(own[:, order], axis=1)
            found[name] = own @ y
            for end, part in (("low", 0.5 - LEVEL / 2), ("high", 0.5 + LEVEL / 2)):
                found[f"{name}_{end}"] = y[order][np.argmax(sums >= part - 1e-9, axis=1)]
        return pandas.DataFrame(found)


OFFSETS = (np.arange(8) + 0.5) / 8  # b^2, of averages


def _offsets(coordinates, averaged):
    """The coordinates at each impact parameter that counts."""
    if not averaged:
        return [coordinates]
    return [np.column_stack([coordinates[:, :-1], np.full(len(coordinates), square)]) for square in OFFSETS]


def classifier(strength):
    """scikit-learn's, unfitted."""
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import Pipeline
    from sklearn.preprocessing import PolynomialFeatures, StandardScaler

    steps = [("scale", StandardScaler()), ("square", PolynomialFeatures(2, include_bias=False))]
    return Pipeline([*steps, ("fit", LogisticRegression(C=strength, max_iter=2000))])


def chances(fit, coordinates):
    """Probabilities (n, 5) of KINDS by a fitted classifier(); 0 for those that it has not seen."""
    found = np.zeros((len(coordinates), len(KINDS)))
    found[:, [KINDS.index(kind) for kind in fit.classes_]] = fit.predict_proba(coordinates)
    return found


def is_kind(outcome):
    """(n, 5): whether it was that one of KINDS."""
    return np.asarray(outcome)[:, None] == np.array(KINDS)


def best_strength(points, outcome):
    """The one of STRENGTHS with the least cross-validated log loss."""
    losses = [_loss(strength, points, outcome) for strength in STRENGTHS]
    return STRENGTHS[int(np.argmin(losses))]


def folds(number):
    """[(rows of the others, rows)] of FOLDS parts of so many rows, drawn at random."""
    parts = np.array_split(np.random.default_rng(SEED).permutation(number), FOLDS)
    return [(np.concatenate([part for part in parts if part is not own]), own) for own in parts]


def _loss(strength, points, outcome):
    """Cross-validated mean log loss."""
    outcome, found = np.asarray(outcome), np.zeros(len(points))
    for others, own in folds(len(points)):
        fit = classifier(strength).fit(points[others], outcome[others])
        found[own] = chances(fit, points[own])[is_kind(outcome[own])]
    return float(-np.log(np.maximum(found, 1e-3)).mean())
