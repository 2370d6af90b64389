"""How good the model is, beside simpler ones and other methods of scikit-learn:

    python3 -m analysis.atlas.scores            prints it, in some minutes

Each predictor is judged by the held-out runs, fitted to all others, and by these others in cross-validation.
"""

import sys

import numpy as np
import pandas
from sklearn.ensemble import HistGradientBoostingClassifier, RandomForestClassifier
from sklearn.neighbors import KNeighborsClassifier
from sklearn.pipeline import make_pipeline
from sklearn.preprocessing import StandardScaler
from sklearn.tree import DecisionTreeClassifier

from .columns import read_runs
from .model import LEVEL, SEED, Model, chances, classifier, folds, is_kind, left, log_loss
from .outcome_table import PROBABILITIES, read_outcomes
from .query import RUNS_FILE, outcomes_file
from .variables import STRUCTURES, energy, fit_and_held_out, of_structure, scaled, variables

ATLAS, TABLES = "the atlas", "its tables at each impact parameter"
HELD, CROSSED = "held out", "cross-validated"
BINS = 10  # of probability


def coordinates(table, *columns):
    """The model's coordinates (n, 5) of a table of runs, and other columns (n,) beside them."""
    return np.column_stack([scaled(variables(table)), *columns])


def velocity(table):
    """(n, 1), over v_break."""
    return variables(table)[["velocity"]].to_numpy()


def energy_a_grain(table):
    """(n, 1) kinetic energy over E_break of all grains (Wada et al. 2009, 2013)."""
    points = variables(table)
    return (energy(points) / (points.grains * (1 + points.mass_ratio))).to_numpy()[:, None]


BOOSTED = HistGradientBoostingClassifier(
    learning_rate=0.03, max_iter=150, max_leaf_nodes=4, min_samples_leaf=10, l2_regularization=1.0, random_state=SEED
)
# Name: classifier, and what it is shown of a table of runs. A tree of depth 1 is one threshold.
CLASSIFIERS = {
    "one model for all structures": (classifier(), coordinates),
    "and contacts a grain": (
        classifier(),
        lambda table: coordinates(table, table.coordination_target, table.coordination_projectile),
    ),
    "and the material": (classifier(), lambda table: coordinates(table, table.material == "silicate")),
    "second order": (classifier(order=2), coordinates),
    "gradient boosting": (BOOSTED, coordinates),
    "random forest": (RandomForestClassifier(100, min_samples_leaf=2, random_state=SEED), coordinates),
    "nearest 5 runs": (make_pipeline(StandardScaler(), KNeighborsClassifier(5)), coordinates),
    "one velocity": (DecisionTreeClassifier(max_depth=1), velocity),
    "one impact energy a grain": (DecisionTreeClassifier(max_depth=1), energy_a_grain),
}


def of_atlas(train, test):
    """Probabilities (n, 5) of KINDS and intervals of what is left (DataFrame) for the rows of test, by train."""
    models = {structure: Model(of_structure(train, structure), members=0) for structure in STRUCTURES}
    p = _by_structure(test, lambda structure, points: models[structure].probabilities(points)[0])
    intervals = _by_structure(test, lambda structure, points: models[structure].remains.intervals(points))
    return p.to_numpy(), intervals


def of_tables(test):
    """Probabilities (n, 5) of KINDS for the rows of test, by the atlas's tables at each impact parameter."""
    tables = {structure: read_outcomes(outcomes_file(structure, averaged=False)) for structure in STRUCTURES}
    found = _by_structure(test, lambda structure, points: tables[structure].lookup(PROBABILITIES, **points))
    return found[list(PROBABILITIES)].to_numpy()


def _by_structure(test, predict):
    """DataFrame of predict(structure, points) for the rows of test, in their order."""
    test, parts = test.reset_index(drop=True), []
    for structure in STRUCTURES:
        own = of_structure(test, structure)
        if len(own):
            parts.append(pandas.DataFrame(predict(structure, variables(own))).set_index(own.index))
    return pandas.concat(parts).sort_index()


def scores(table):
    """DataFrame, a row a predictor and a set of runs: how well the runs of a table (DataFrame) are predicted.

    brier       mean over runs of the sum over outcomes of (p - observed)^2
    more        brier less that of the atlas, with its standard error, runs paired
    log_loss    mean of -ln of the probability of what was observed
    miss        mean of |p - observed| over the bins of reliability()
    largest, filling    of the atlas: fraction of the runs within its intervals
    """
    fit, held = fit_and_held_out(table)
    splits = {HELD: [(fit, held)], CROSSED: [(fit.iloc[others], fit.iloc[own]) for others, own in folds(len(fit))]}
    rows = []
    for runs, parts in splits.items():
        test = pandas.concat([own for _, own in parts], ignore_index=True)
        of_parts = [of_atlas(*part) for part in parts]
        p = np.concatenate([own for own, _ in of_parts])
        intervals = pandas.concat([own for _, own in of_parts], ignore_index=True)
        atlas = squares(p, test.outcome)
        rows.append({"predictor": ATLAS, "runs": runs, **_row(p, test.outcome), **within(intervals, test)})
        predicted = {TABLES: of_tables(test)} if runs == HELD else {}
        for name, (fitted, shown) in CLASSIFIERS.items():
            own = [chances(fitted.fit(shown(train), train.outcome), shown(rest)) for train, rest in parts]
            predicted[name] = np.concatenate(own)
        for name, p in predicted.items():
            more = squares(p, test.outcome) - atlas
            error = more.std() / len(more) ** 0.5
            compared = {"more": more.mean(), "error": error}
            rows.append({"predictor": name, "runs": runs, **_row(p, test.outcome), **compared})
    return pandas.DataFrame(rows)


def _row(p, outcomes):
    bins = reliability(p, outcomes)
    miss = np.average((bins.p - bins.observed).abs(), weights=bins.number)
    return {"brier": squares(p, outcomes).mean(), "log_loss": log_loss(p, outcomes), "miss": miss}


def squares(p, outcomes):
    """(n,), whose mean is the Brier score."""
    return ((p - is_kind(outcomes)) ** 2).sum(axis=1)


def reliability(p, outcomes):
    """DataFrame, a row a bin of probability, of all outcomes together: mean p, observed fraction, number.

    >>> reliability(np.array([[1.0, 0, 0, 0, 0]]), ["sticking"]).observed.tolist()
    [0.0, 1.0]
    """
    p, hit = p.ravel(), is_kind(outcomes).ravel().astype(float)
    bins = np.minimum((p * BINS).astype(int), BINS - 1)
    table = pandas.DataFrame({"p": p, "observed": hit, "number": 1})
    return table.groupby(bins).agg({"p": "mean", "observed": "mean", "number": "sum"})


def within(intervals, table):
    """{name: fraction of the runs of a table within the intervals (DataFrame)}: of the largest piece, of runs that
    leave more than one, and of its filling."""
    truth = left(table).reset_index(drop=True)
    known = {"largest": truth.second > 0, "filling_after": truth.filling_after.notna()}
    inside = lambda name: truth[name].between(intervals[f"{name}_low"] - 1e-9, intervals[f"{name}_high"] + 1e-9)
    return {name.partition("_")[0]: float(inside(name)[own].mean()) for name, own in known.items()}


def main(file=RUNS_FILE):
    """Print the scores of the model of a table of runs."""
    table = read_runs(file)
    fit, held = fit_and_held_out(table)
    print(f"{len(fit)} fitted runs, {len(held)} held out; intervals of {LEVEL:.0%}")
    print(scores(table).round(3).to_string(index=False, na_rep=""))
    print("\nHeld-out runs, in bins of probability of all outcomes together:")
    print(reliability(of_atlas(fit, held)[0], held.outcome).round(3).to_string(index=False))


if __name__ == "__main__":
    main(*sys.argv[1:2])
