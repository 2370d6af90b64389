"""How well the model predicts held-out runs, beside simpler ones and other methods of scikit-learn:

    python3 -m analysis.atlas.scores [RUNS.csv]        fits all of them, in a minute, and prints a table

brier     mean over runs of the sum over outcomes of (p - observed)^2
more      brier less that of the atlas, and `error`, its standard error, runs paired
log_loss  mean of -ln of the probability of what was observed
"""

import sys

import numpy as np
import pandas

from . import NO_SKLEARN
from .columns import read_runs
from .outcome_table import PROBABILITIES, read_outcomes
from .query import RUNS_FILE, outcomes_file
from .variables import STRUCTURES, energy, fit_and_held_out, of_structure, scaled, variables

try:
    from sklearn.ensemble import HistGradientBoostingClassifier, RandomForestClassifier
    from sklearn.tree import DecisionTreeClassifier

    from .model import SEED, Model, chances, classifier, is_kind, log_loss
except ModuleNotFoundError:
    if __name__ == "__main__":
        sys.exit(NO_SKLEARN)
    raise


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
# Name: classifier, and its features of a table of runs. A tree of depth 1 is one threshold.
CLASSIFIERS = {
    "one model for all structures": (classifier(), coordinates),
    "and contacts a grain": (
        classifier(),
        lambda table: coordinates(table, table.coordination_target, table.coordination_projectile),
    ),
    "second order": (classifier(order=2), coordinates),
    "gradient boosting": (BOOSTED, coordinates),
    "random forest": (RandomForestClassifier(100, min_samples_leaf=2, random_state=SEED), coordinates),
    "one velocity": (DecisionTreeClassifier(max_depth=1), velocity),
    "one impact energy a grain": (DecisionTreeClassifier(max_depth=1), energy_a_grain),
}


def predictions(table):
    """Held-out runs of a table (DataFrame, n rows), and {predictor: probabilities (n, 5) of KINDS} of them."""
    fit, held = fit_and_held_out(table)
    found = {"the atlas": np.zeros((len(held), 5)), "its tables at each impact parameter": np.zeros((len(held), 5))}
    for structure in STRUCTURES:
        own, points = held.structure.isin(STRUCTURES[structure]), variables(of_structure(held, structure))
        of_model = Model(of_structure(table, structure), members=0).probabilities(points)[0]
        of_table = read_outcomes(outcomes_file(structure, averaged=False)).lookup(PROBABILITIES, **points)
        for p, values in zip(found.values(), (of_model, np.column_stack([of_table[name] for name in PROBABILITIES]))):
            p[own] = values
    for name, (fitted, shown) in CLASSIFIERS.items():
        found[name] = chances(fitted.fit(shown(fit), fit.outcome), shown(held))
    return held, found


def scores(table):
    """DataFrame, a row a predictor: the scores at the module's head for the held-out runs of a table (DataFrame)."""
    held, predicted = predictions(table)
    squares = {name: ((p - is_kind(held.outcome)) ** 2).sum(axis=1) for name, p in predicted.items()}
    rows = []
    for name, p in predicted.items():
        more = squares[name] - squares["the atlas"]
        own = {"brier": squares[name].mean(), "more": more.mean(), "error": more.std() / len(more) ** 0.5}
        rows.append({"predictor": name, **own, "log_loss": log_loss(p, held.outcome)})
    return pandas.DataFrame(rows)


if __name__ == "__main__":
    print(scores(read_runs((sys.argv[1:] or [RUNS_FILE])[0])).round(3).to_string(index=False))
