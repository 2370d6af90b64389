"""How good the model is, beside simpler ones: on the held-out runs, and by cross-validation on the others."""

from functools import partial

import numpy as np
import pandas
from scipy.spatial import cKDTree

from .grid import PROBABILITIES
from .model import STRENGTH, Model, best, chances, classifier, is_kind
from .rules import KINDS
from .variables import SEED, STRUCTURES, decided, fit_and_held_out, folds, left, of_structure, scaled, variables

NEIGHBOURS, BINS = 5, 10
ATLAS, TABLES = "the atlas", "its tables at each impact parameter"
CROSSED, HELD = "cross-validated", "held out"
SEEN = 1e-3  # least probability in log losses
CONSTANT = 1.0  # counts shared out among the kinds, so that what was not seen is not impossible


def of_atlas(train, test):
    """(probabilities (n, 5) of KINDS, intervals of LEFT) of the Model of each structure for the rows of test."""
    intervals = lambda structure, points: Model(of_structure(train, structure), members=0).remains.intervals(points)
    return probabilities_of_atlas(train, test), _by_structure(test, intervals)


def probabilities_of_atlas(train, test):
    """The first of of_atlas()."""
    told = lambda structure, points: Model(of_structure(train, structure), members=0).probabilities(points)[0]
    return _by_structure(test, told).to_numpy()


def of_tables(tables, test):
    """Probabilities (n, 5) of KINDS for the rows of test by {structure: OutcomeTable at each impact parameter}."""
    told = lambda structure, points: tables[structure].lookup(PROBABILITIES, **points)
    return _by_structure(test, told)[list(PROBABILITIES)].to_numpy()


def _by_structure(test, tell):
    """DataFrame of tell(structure, variables() points of it) for the rows of test, in their order."""
    test = test.reset_index(drop=True)
    groups = {structure: of_structure(test, structure) for structure in STRUCTURES}
    parts = [
        pandas.DataFrame(tell(structure, variables(own))).set_index(own.index)
        for structure, own in groups.items()
        if len(own)
    ]
    return pandas.concat(parts).sort_index()


def of_all_structures(train, test):
    """One Model of all structures together."""
    return Model(train, members=0).probabilities(variables(test))[0], None


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


def of_learning(make, more=lambda table: np.empty((len(table), 0))):
    """make(points, outcomes) -> a classifier of scikit-learn, for the coordinates and more(table) -> (n, k) beside them."""

    def of(train, test):
        points, others = (np.column_stack([scaled(variables(table)), more(table)]) for table in (train, test))
        return chances(make(points, train.outcome).fit(points, train.outcome), others), None

    return of


def _alike(points, outcomes):
    """As the atlas's, with the regularisation that is the best for it: choosing anew takes minutes with more variables."""
    return classifier(STRENGTH)


def _boosted(points, outcomes):
    from sklearn.ensemble import HistGradientBoostingClassifier

    return HistGradientBoostingClassifier(
        learning_rate=0.03,
        max_iter=150,
        max_leaf_nodes=4,
        min_samples_leaf=10,
        l2_regularization=1.0,
        random_state=SEED,
    )


def _forest(points, outcomes):
    from sklearn.ensemble import RandomForestClassifier

    return RandomForestClassifier(100, min_samples_leaf=2, random_state=SEED)


PREDICTORS = {
    ATLAS: of_atlas,
    "one, with contacts a grain": of_learning(_alike, lambda t: t[["coordination_target", "coordination_projectile"]]),
    "one, with the material": of_learning(_alike, lambda t: t.material == "silicate"),
    "one for all structures": of_all_structures,
    "second order": of_learning(partial(best, order=2)),
    "gradient boosting": of_learning(_boosted),
    "random forest": of_learning(_forest),
    f"nearest {NEIGHBOURS} runs": of_nearest,
    "one velocity": of_velocity,
    "one impact energy a grain (Wada et al.)": of_energy,
}


def _of_threshold(train, test, of):
    x, own, outcome = of(variables(train)).to_numpy(), of(variables(test)).to_numpy(), train.outcome.to_numpy()
    least = None
    for limit in np.quantile(x, np.linspace(0.05, 0.95, 37)):
        sides = np.array([_fractions(outcome[x <= limit]), _fractions(outcome[x > limit])])
        score = ((sides[(x > limit).astype(int)] - is_kind(outcome)) ** 2).sum()
        if least is None or score < least[0]:
            least = score, limit, sides
    return least[2][(own > least[1]).astype(int)]


def _fractions(outcome):
    counts = np.array([np.count_nonzero(outcome == kind) for kind in KINDS]) + CONSTANT / len(KINDS)
    return counts / counts.sum()


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


def scores(table, tables):
    """DataFrame (a row a predictor and set of runs): number, brier, its difference to the atlas's and the error of that, log_loss, mean_miss, and of
    the atlas the fractions of the runs within the intervals of LEFT (of_largest: of those that leave more than one piece). table: of runs; tables: as
    of_tables() has them; sets: held out (fitted to all others), and cross-validated (of the others)."""
    fit, held = fit_and_held_out(table)
    parts, order = folds(len(fit)), np.concatenate([own for _, own in folds(len(fit))])
    told = []
    for name, of in PREDICTORS.items():
        told.append((name, HELD, [of(fit, held)], held))
        told.append((name, CROSSED, [of(fit.iloc[others], fit.iloc[own]) for others, own in parts], fit.iloc[order]))
    told.insert(2, (TABLES, HELD, [(of_tables(tables, held), None)], held))
    found, reference = [], {}
    for name, runs, parts, rows in told:
        p = np.concatenate([part for part, _ in parts])
        squares = _squares(p, rows.outcome)
        more = squares - reference.setdefault(runs, squares)
        row = {"predictor": name, "runs": runs, "number": len(rows), "brier": squares.mean()}
        row |= {"more": more.mean(), "error": more.std() / len(more) ** 0.5} if name != ATLAS else {}
        row |= {"log_loss": log_loss(p, rows.outcome), "mean_miss": mean_miss(p, rows.outcome)}
        if parts[0][1] is not None:
            row |= within(pandas.concat([rest for _, rest in parts], ignore_index=True), rows)
        found.append(row)
    return pandas.DataFrame(found).sort_values("runs", kind="stable")


def foretold(table, before):
    """DataFrame (a row for all runs, and for those of a structure): decided runs of the numbers from `before` on, as observed and as Model tells
    them from the earlier ones: by KINDS "observed (told)", their number, brier and mean_miss. table: of runs."""
    later, found = decided(table[table.number >= before]).reset_index(drop=True), []
    of_later = probabilities_of_atlas(table[table.number < before], later) if len(later) else None
    for name, runs in (("all", later), *later.groupby("structure")) if len(later) else ():
        p, seen = of_later[runs.index], is_kind(runs.outcome)
        counts = {kind: f"{n} ({told:.0f})" for kind, n, told in zip(KINDS, seen.sum(axis=0), p.sum(axis=0))}
        of_all = {"brier": _squares(p, runs.outcome).mean(), "miss": mean_miss(p, runs.outcome)}
        found.append({"runs": name, "number": len(runs), **counts, **of_all})
    return pandas.DataFrame(found)


def _squares(p, outcome):
    """(n,): of which Brier scores are means."""
    return ((p - is_kind(outcome)) ** 2).sum(axis=1)


def log_loss(p, outcome):
    """Mean over runs of -ln of the probability of what was observed, which counts as SEEN at least."""
    return float(-np.log(np.maximum(p[is_kind(outcome)], SEEN)).mean())


def within(intervals, table):
    """{within_NAME: fraction of the runs in the intervals (Remains.intervals) of the largest piece, where there is more than one, and of its
    filling}."""
    truth = left(table).reset_index(drop=True)
    counts = {"largest": truth.second > 0, "filling_after": truth.filling_after.notna()}
    found = {}
    for name, known in counts.items():
        inside = truth[name].between(intervals[f"{name}_low"] - 1e-9, intervals[f"{name}_high"] + 1e-9)
        found[f"within_{name}"] = float(inside[known].mean())
    return found
