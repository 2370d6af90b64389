"""How good the model is, beside simpler ones: on the held-out runs, and by cross-validation on the others."""

import numpy as np
import pandas
from scipy.spatial import cKDTree

from .model import Model, best_strength, chances, classifier, folds, is_kind
from .rules import KINDS
from .variables import fit_and_held_out, left, scaled, variables

NEIGHBOURS, BINS = 5, 10
STRUCTURES = np.array(["bcca", "bpca", "cpe", "compressed"])
CONSTANT = 1.0  # counts shared out among the kinds, so that what was not seen is not impossible


def of_atlas(train, test):
    """(probabilities (n, 5) of KINDS, LEFT with intervals) of Model for the rows of test."""
    model, points = Model(train, members=0), variables(test)
    return model.probabilities(points)[0], model.left(points)


def of_nearest(train, test):
    """Fractions among the nearest runs."""
    points = scaled(variables(train))
    scatter = points.std(axis=0)
    _, rows = cKDTree(points / scatter).query(scaled(variables(test)) / scatter, k=NEIGHBOURS)
    return np.array([_fractions(train.outcome.to_numpy()[own]) for own in rows]), None


def of_velocity(train, test):
    """Fractions below and above one velocity over v_break, with the least Brier score."""
    return _of_threshold(train, test, lambda at: at.velocity), None


def of_energy(train, test):
    """The same with the energy of the impact over N E_break (Wada et al. 2009, 2013): mu v^2/2 over all grains' E_break."""
    return _of_threshold(train, test, lambda at: at.velocity**2 * at.mass_ratio / (1 + at.mass_ratio) ** 2), None


def of_more(more):
    """The atlas's classifier with more(table) -> (n, k) beside the coordinates."""

    def of(train, test):
        points, others = (np.column_stack([scaled(variables(table)), more(table)]) for table in (train, test))
        fit = classifier(best_strength(points, train.outcome)).fit(points, train.outcome)
        return chances(fit, others), None

    return of


PREDICTORS = {
    "the atlas": of_atlas,
    "with contacts a grain": of_more(lambda t: t[["coordination_target", "coordination_projectile"]]),
    "with the structure": of_more(lambda t: t.structure.to_numpy()[:, None] == STRUCTURES),
    "with the material": of_more(lambda t: t.material == "silicate"),
    f"nearest {NEIGHBOURS} runs": of_nearest,
    "one velocity": of_velocity,
    "one impact energy a grain (Wada et al.)": of_energy,
}


def _of_threshold(train, test, of):
    x, own, outcome = of(variables(train)).to_numpy(), of(variables(test)).to_numpy(), train.outcome.to_numpy()
    best = None
    for limit in np.quantile(x, np.linspace(0.05, 0.95, 37)):
        sides = np.array([_fractions(outcome[x <= limit]), _fractions(outcome[x > limit])])
        score = brier(sides[(x > limit).astype(int)], outcome)
        if best is None or score < best[0]:
            best = score, limit, sides
    return best[2][(own > best[1]).astype(int)]


def _fractions(outcome):
    counts = np.array([np.count_nonzero(outcome == kind) for kind in KINDS]) + CONSTANT / len(KINDS)
    return counts / counts.sum()


def brier(p, outcome):
    """Brier score: mean over runs of the sum over kinds of (p - observed)^2, 0 to 2."""
    return float(((p - is_kind(outcome)) ** 2).sum(axis=1).mean())


def reliability(p, outcome):
    """DataFrame (a row a bin of probability, of all kinds together): mean p, observed fraction, number.

    >>> reliability(np.array([[1.0, 0, 0, 0, 0]]), ["sticking"]).observed.tolist()
    [0.0, 1.0]
    """
    p, hit = p.ravel(), is_kind(outcome).ravel().astype(float)
    bins = np.minimum((p * BINS).astype(int), BINS - 1)
    return (
        pandas.DataFrame({"p": p, "observed": hit, "number": 1})
        .groupby(bins)
        .agg({"p": "mean", "observed": "mean", "number": "sum"})
    )


def mean_miss(p, outcome):
    """Mean of |p - observed| over the bins of reliability(), each with its number."""
    bins = reliability(p, outcome)
    return float(np.average((bins.p - bins.observed).abs(), weights=bins.number))


def scores(table):
    """DataFrame (a row a predictor and set of runs): number, brier, mean_miss, and of the atlas the fractions of the runs within the intervals
    of LEFT. table: of runs; sets: held out (fitted to all others), and cross-validated (of the others)."""
    fit, held = fit_and_held_out(table)
    found = []
    for name, of in PREDICTORS.items():
        p = [of(fit.iloc[others], fit.iloc[kept]) for others, kept in folds(len(fit))]
        order = np.concatenate([kept for _, kept in folds(len(fit))])
        found.append(
            _scored(name, "cross-validated", [part for part, _ in p], [rest for _, rest in p], fit.iloc[order])
        )
        found.append(_scored(name, "held out", *([part] for part in of(fit, held)), held))
    return pandas.DataFrame(found).sort_values("runs", kind="stable")


def _scored(name, of, p, rest, table):
    p = np.concatenate(p)
    found = {
        "predictor": name,
        "runs": of,
        "number": len(table),
        "brier": brier(p, table.outcome),
        "mean_miss": mean_miss(p, table.outcome),
    }
    if rest[0] is not None:
        rest, truth = pandas.concat(rest, ignore_index=True), left(table).reset_index(drop=True)
        for column in ("largest", "filling_after"):
            known = truth[column].notna()
            inside = truth[column].between(rest[f"{column}_low"] - 1e-9, rest[f"{column}_high"] + 1e-9)
            found[f"within_{column}"] = float(inside[known].mean())
    return found
