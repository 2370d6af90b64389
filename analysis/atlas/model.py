"""A model of the outcomes, fitted to the table of runs: scikit-learn's, in variables without dimensions.

Probabilities: logistic regression on polynomials of third order of FEATURES, its regularisation chosen by cross-validation; errors
from fits with random weights of the runs (the Bayesian bootstrap, Rubin 1981). What is left: remains.Remains.

Fitted are runs whose aggregates touched and whose outcome is decided, but for the held-out ones; runs of all materials together."""

from functools import cached_property
from importlib.util import find_spec

import numpy as np

from .neighbours import ONE_CONTACT, slow
from .remains import LEVEL, Remains
from .rules import KINDS
from .variables import SEED, energy, fit_and_held_out, folds, offsets, scaled, variables

MEMBERS = 40  # fits with random weights
ORDER = 3  # measured best: scores.py
STRENGTHS = 0.1, 0.3, 1.0, 3.0, 10.0  # 1/regularisation, tried


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
        from sklearn.base import clone

        fit = best(self.points, self.runs.outcome)
        draws = np.random.default_rng(SEED).exponential(size=(self.members, len(self.runs)))
        weights = [np.ones(len(self.runs)), *draws]
        return [clone(fit).fit(self.points, self.runs.outcome, fit__sample_weight=w) for w in weights]

    def probabilities(self, points, upto=None):
        """(probabilities (n, 5) of rules.KINDS, half widths (n, 5) of their intervals of LEVEL) of variables() points; upto: averaged over
        impact parameters, uniform in b^2 up to this, whatever the points have. No half widths without members."""
        fits = np.stack([self._of_each(fit, points, upto) for fit in self._classifiers])
        if len(fits) == 1:
            return fits[0], None
        low, high = np.quantile(fits[1:], (0.5 - LEVEL / 2, 0.5 + LEVEL / 2), axis=0)
        own = energy(points)
        unseen = np.where((own >= ONE_CONTACT) & (own < self.slow.energy), self.slow.most, 0.0)
        return fits[0], np.maximum((high - low) / 2, unseen[:, None])

    def _of_each(self, fit, points, upto):
        found = np.mean([chances(fit, at) for at in (offsets(scaled(points), upto))], axis=0)
        found[:, 1:] *= self._fade(points)[:, None]
        found[:, 0] = 1 - found[:, 1:].sum(axis=1)
        return found

    def _fade(self, points):
        """Factor (n,) of whatever is not sticking: 1 from the energy of slow() on, 0 at half of it and below."""
        return np.clip(1 + np.log2(energy(points).to_numpy() / self.slow.energy), 0.0, 1.0)

    def left(self, points, upto=None):
        """DataFrame of LEFT: means of remains.Remains; one piece where all stick."""
        fade, found = self._fade(points), self.remains.means(points, upto)
        largest = 1 - fade * (1 - found.largest)
        return found.assign(largest=largest, second=np.minimum(fade * found.second, 1 - largest))

    @cached_property
    def slow(self):
        """neighbours.Slow of these runs."""
        return slow(self.runs)

    @cached_property
    def remains(self):
        """remains.Remains of these runs."""
        return Remains(self.runs)


def classifier(strength, order=ORDER):
    """scikit-learn's, unfitted, on polynomials of that order."""
    from sklearn.linear_model import LogisticRegression
    from sklearn.pipeline import Pipeline
    from sklearn.preprocessing import PolynomialFeatures, StandardScaler

    steps = [("scale", StandardScaler()), ("powers", PolynomialFeatures(order, include_bias=False))]
    return Pipeline([*steps, ("fit", LogisticRegression(C=strength, max_iter=10000))])


def chances(fit, coordinates):
    """Probabilities (n, 5) of KINDS by a fitted classifier(); 0 for those that it has not seen."""
    found = np.zeros((len(coordinates), len(KINDS)))
    found[:, [KINDS.index(kind) for kind in fit.classes_]] = fit.predict_proba(coordinates)
    return found


def is_kind(outcome):
    """(n, 5): whether it was that one of KINDS."""
    return np.asarray(outcome)[:, None] == np.array(KINDS)


def best(points, outcome, order=ORDER):
    """The classifier() with that one of STRENGTHS which has the least cross-validated log loss."""
    losses = [_loss(classifier(strength, order), points, np.asarray(outcome)) for strength in STRENGTHS]
    return classifier(STRENGTHS[int(np.argmin(losses))], order)


def _loss(fit, points, outcome):
    """Cross-validated mean log loss."""
    found = np.zeros(len(points))
    for others, own in folds(len(points)):
        found[own] = chances(fit.fit(points[others], outcome[others]), points[own])[is_kind(outcome[own])]
    return float(-np.log(np.maximum(found, 1e-3)).mean())
