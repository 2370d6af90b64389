"""How well the model predicts held-out runs, beside simpler ones and other methods of scikit-learn:

    python3 -m analysis.atlas.scores [RUNS.csv]        fits all of them, in a minute, and prints a table

brier     mean over runs of the sum over outcomes of (p - observed)^2
more      brier less that of the atlas, and `error`, its standard error, runs paired
"""

import sys

import numpy as np
import pandas

from ..printable import FAILED, complain
from .columns import read_runs
from .make import NO_SKLEARN
from .outcome_table import PROBABILITIES, read_outcomes
from .query import RUNS_FILE, outcomes_file
from .rules import KINDS
from .variables import STRUCTURES, energy, fit_and_held_out, of_structure, scaled, variables


def classifiers():
    """{name: (classifier, its features of a table of runs)}; a tree of depth 1 is one threshold."""
    from sklearn.ensemble import HistGradientBoostingClassifier, RandomForestClassifier
    from sklearn.tree import DecisionTreeClassifier

    from .model import SEED, classifier

    boosted = HistGradientBoostingClassifier(
        learning_rate=0.03,
        max_iter=150,
        max_leaf_nodes=4,
        min_samples_leaf=10,
        l2_regularization=1.0,
        random_state=SEED,
    )
    forest = RandomForestClassifier(100, min_samples_leaf=2, random_state=SEED)
    contacts = lambda table: np.column_stack([place(table), table.coordination_target, table.coordination_projectile])
    velocity = lambda table: variables(table)[["velocity"]].to_numpy()
    return {
        "one model for all structures": (classifier(), place),
        "and contacts a grain": (classifier(), contacts),
        "second order": (classifier(order=2), place),
        "gradient boosting": (boosted, place),
        "random forest": (forest, place),
        "one velocity": (DecisionTreeClassifier(max_depth=1), velocity),
        "one impact energy a grain": (DecisionTreeClassifier(max_depth=1), energy_a_grain),
    }


def place(table):
    """The model's coordinates (n, 5) of a table of runs."""
    return scaled(variables(table))


def energy_a_grain(table):
    """(n, 1) kinetic energy over E_break of all grains (Wada et al. 2009, 2013)."""
    points = variables(table)
    return (energy(points) / (points.grains * (1 + points.mass_ratio))).to_numpy()[:, None]


def scores(table):
    """DataFrame, a row a predictor: the scores at the module's head for the held-out runs of a table (DataFrame)."""
    from .model import Model, chances

    fit, held = fit_and_held_out(table)
    found = {"the atlas": np.zeros((len(held), 5)), "its tables at each impact parameter": np.zeros((len(held), 5))}
    for structure in STRUCTURES:
        own, points = held.structure.isin(STRUCTURES[structure]), variables(of_structure(held, structure))
        of_model = Model(of_structure(table, structure), members=1).probabilities(points)[0]
        of_table = read_outcomes(outcomes_file(structure, averaged=False)).lookup(PROBABILITIES, **points)
        for p, values in zip(found.values(), (of_model, np.column_stack([of_table[name] for name in PROBABILITIES]))):
            p[own] = values
    for name, (fitted, features) in classifiers().items():
        found[name] = chances(fitted.fit(features(fit), fit.outcome), features(held))
    observed = held.outcome.to_numpy()[:, None] == np.array(KINDS)
    squares = pandas.DataFrame({name: ((p - observed) ** 2).sum(axis=1) for name, p in found.items()})
    more = squares.sub(squares["the atlas"], axis=0)
    return pandas.DataFrame({"brier": squares.mean(), "more": more.mean(), "error": more.sem()})


if __name__ == "__main__":
    try:
        print(scores(read_runs((sys.argv[1:] or [RUNS_FILE])[0])).round(3).to_string())
    except ModuleNotFoundError:
        complain(NO_SKLEARN)
        sys.exit(FAILED)
