"""A model of the outcomes, fitted to the table of runs: scikit-learn's, in variables without dimensions.

Probabilities: logistic regression on polynomials of third order of FEATURES, its regularisation chosen by cross-validation; errors
from fits with random weights of the runs (the Bayesian bootstrap, Rubin 1981), which undecided runs join with one outcome or another.
What is left: remains.Remains.

Fitted are runs whose aggregates touched and whose outcome is decided, but for the held-out ones; runs of all materials together."""

from functools import cached_property
from importlib.util import find_spec

import numpy as np

from ..measures.outcome import NEVER_MET, UNDECIDED
from .neighbours import ONE_CONTACT, slow
from .remains import LEVEL, Remains
from .rules import KINDS, outcome
from .variables import FIT, SEED, energy, fit_and_held_out, folds, offsets, scaled, variables

MEMBERS = 40  # fits with random weights
ORDER = 3  # measured best: scores.py
STRENGTHS = 0.1, 0.3, 1.0, 3.0, 10.0  # 1/regularisation, tried
STRENGTH = 3.0  # of fits that don't choose: as best() does for all structures together
STICKING, BOUNCING = KINDS[:2]


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
        self.of_fit = table[table.split == FIT]  # also what never met, or is undecided

    @cached_property
    def _classifiers(self):
        """The fit to the decided runs, and members: fits with random weights to all that touched, undecided ones with an outcome of _guessed()."""
        from sklearn.base import clone

        fit, random = best(self.points, self.runs.outcome), np.random.default_rng(SEED)
        still_open = self.of_fit[self.of_fit.outcome == UNDECIDED]
        seen = np.array([outcome(row) for row in still_open.to_dict("records")], dtype=object)
        points = np.concatenate([self.points, scaled(variables(still_open))])
        found = [clone(fit).fit(self.points, self.runs.outcome)]
        for _ in range(self.members):
            outcomes = np.concatenate([self.runs.outcome, _guessed(seen, random)])
            weights = random.exponential(size=len(points))
            found.append(clone(fit).fit(points, outcomes, fit__sample_weight=weights))
        return found

    @cached_property
    def _meeting(self):
        """Fit to whether aggregates touch, and ends of the runs' coordinates but for the velocity, as it is geometry. None where all touch."""
        touched, points = self.of_fit.outcome != NEVER_MET, scaled(variables(self.of_fit))[:, 1:]
        if touched.all():
            return None
        return classifier(STRENGTH, order=2).fit(points, touched), points.min(axis=0), points.max(axis=0)

    def touching(self, points, upto=None):
        """Probability (n,) that aggregates touch whose impact parameter is b < 1; points, upto: as probabilities() has them. Beyond the runs that
        of the nearest end."""
        if self._meeting is None:
            return np.ones(len(points))
        fit, *ends = self._meeting
        several = offsets(scaled(points), upto)
        return np.mean([fit.predict_proba(np.clip(at[:, 1:], *ends))[:, 1] for at in several], axis=0)

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

    @cached_property
    def slow(self):
        """neighbours.Slow of these runs."""
        return slow(self.runs)

    @cached_property
    def remains(self):
        """remains.Remains of these runs."""
        return Remains(self.runs)


def _guessed(seen, random):
    """Outcomes (n,) of undecided runs: as it looked at the end of the run, or else sticking, and where it looked so, bouncing; how often, drawn
    anew each time."""
    other = np.where(seen == STICKING, BOUNCING, STICKING)
    return np.where(random.uniform(size=len(seen)) < random.uniform(), seen, other)


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
