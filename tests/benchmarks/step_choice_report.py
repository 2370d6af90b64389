"""The fit of the constants of yade_scripts/step_choice.py to the measured scenes, and its table."""

from itertools import product

import numpy as np
import pandas as pd
from report import markdown
from scipy.optimize import minimize
from step_choice import AT_FILLINGS, COLLISIONS, COMPRESSIONS, FILLINGS, met

from yade_scripts import step_choice as rule
from yade_scripts.experiments.collision import CollisionParameters
from yade_scripts.experiments.compression import CompressionParameters
from yade_scripts.materials import pair_constants

FITTED_LEVEL = 0.98  # taken: the fit's own 95 % level holds for less among scenes unlike the grid's
LEVELS = (0.5, 0.9, 0.95, FITTED_LEVEL)
WORTH = 0.3  # of the 95 % level: the least part of bonds in it for a scene to tell of them


# ---- the rule's terms, of measured scenes ----


def collisions():
    """DataFrame of the collisions that met: the table's columns; parsed: (parameters, constants); plain: whether it is of CPE
    aggregates in space, and held; held: whether grains are not sintered and springs are held at their limits; over: error over
    step_choice.py's 95 % level."""
    found = met(COLLISIONS.read())
    parsed = [CollisionParameters.parse(COLLISIONS.given(scene)) for _, scene in found.iterrows()]
    found = found.assign(parsed=[(one, pair_constants(one, neck=one.neck)) for one in parsed])
    level = np.array([sum(rule.collision_errors(*one).values()) for one in found.parsed])
    held = (found.neck == 0) & (found.limit == "held")
    plain = held & (found.packing == "cpe") & (found.planar == 0)
    return found.assign(held=held, plain=plain, over=found.error / found.stepFraction**2 / level)


def compressions():
    """DataFrame: the table's columns and over, as collisions(); each filling at which one might have ended is a row."""
    rows = []
    for _, scene in COMPRESSIONS.read().iterrows():
        parameters = CompressionParameters.parse(COMPRESSIONS.given(scene))
        ends = {filling: scene[name] for filling, name in zip(FILLINGS, AT_FILLINGS) if scene[name] == scene[name]}
        for filling, error in (ends if scene.stretch == "no" else {scene.finalFilling: scene.error}).items():
            at_end = rule.compression_errors(parameters.changed(finalFilling=filling), pair_constants(parameters))
            rows.append({**scene, "over": error / scene.stepFraction**2 / sum(at_end.values())})
    return pd.DataFrame(rows)


# ---- fitting ----


def fit(scenes, level=FITTED_LEVEL):
    """(EVENTS, DECAY, SPEED): quantile regression of the logarithm of the error at a level."""
    kinetic, of_grain = np.array([rule.energies(*one) for one in scenes.parsed]).T
    error, step = scenes.error.to_numpy(), scenes.stepFraction.to_numpy()

    def loss(logs):
        over = np.log(error / (step**2 * sum(rule.ledger_errors(kinetic, of_grain, *np.exp(logs)))))
        return np.mean(np.where(over > 0, level * over, (level - 1) * over))

    options = {"maxiter": 4000, "xatol": 1e-6, "fatol": 1e-10}
    starts = product((-3.5, -2.5), (-1.2, -0.7), (-6.0, -4.0))
    found = [minimize(loss, start, method="Nelder-Mead", options=options) for start in starts]
    return np.exp(min(found, key=lambda f: f.fun).x)


def fitted_factors(scenes, level=FITTED_LEVEL):
    """FLUFFY, CUT, BREAKING and BREAKING_FLUFFY: the quantiles of what they stand for."""

    def over_plain(chosen):
        return np.quantile(chosen.over * [rule.scene_factor(parameters) for parameters, _ in chosen.parsed], level)

    def of_bonds(chosen, taken):
        errors = [rule.collision_errors(*one) for one in chosen.parsed]
        bonds = np.array([each.get("breaking bonds", 0) for each in errors])
        telling = bonds > WORTH * np.array([sum(each.values()) for each in errors])
        return np.quantile((taken * chosen.error / chosen.stepFraction**2)[telling] / bonds[telling], level)

    yield over_plain(scenes[scenes.held & ~scenes.plain])
    yield over_plain(scenes[(scenes.neck == 0) & (scenes.limit == "cut")])
    yield of_bonds(scenes[scenes.packing == "cpe"], rule.BREAKING)
    yield of_bonds(scenes[scenes.packing != "cpe"], rule.BREAKING_FLUFFY)


# ---- what is written ----

# conditions on the columns
PLAIN_GROUPS = """set == 'grid'; set == 'study'; set == 'random'; viscoelasticTime == 0; viscoelasticTime > 0; material == 'ice';
material == 'silicate'; velocity < 2; 2 <= velocity < 15; velocity >= 15; filling < 0.35; filling > 0.5; radius <= 8;
radius > 12; stepFraction < 0.07; stepFraction > 0.25"""
OTHER_GROUPS = """held and packing == 'bpca'; held and packing == 'bcca' and planar == 0; held and packing == 'bcca' and planar == 1;
held and packing == 'cpe' and planar == 1; held and viscoelasticTime > 0; limit == 'cut' and neck == 0;
neck > 0 and packing == 'cpe'; neck > 0 and packing != 'cpe'; neck > 0 and velocity < 8; neck > 0 and velocity >= 8;
material == 'silicate'; projectileGrains > 0"""
COMPRESSION_GROUPS = f"""linearDamping >= {rule.DAMPED}; linearDamping < {rule.DAMPED}; grains < 100; grains > 400;
strainRate < 7e-6; strainRate > 7e-5; criticalRolling < 0.5e-9; stretch != 'no'; viscoelasticTime > 0"""
REFUSED_GROUPS = "limit == 'cut'; material == 'silicate'"
REFUSED = " or ".join(REFUSED_GROUPS.split("; "))  # compressions that stepFraction=auto refuses, having been measured


def of_groups(groups, scenes, sets=("all",)):
    """Markdown: error over the formula, of each group and set."""
    rows = []
    for condition, chosen in product(groups.replace("\n", " ").split("; "), sets):
        r = scenes.query(condition)
        r = (r if chosen == "all" else r[r["set"] == chosen]).over
        if len(r):
            numbers = {"median": np.median(r), "95 %": np.quantile(r, 0.95), "largest": r.max()}
            row = {"scenes": condition, "set": chosen, "number": len(r), "fraction below": f"{np.mean(r <= 1):.3f}"}
            rows.append(row | {words: f"{value:.2f}" for words, value in numbers.items()})
    return markdown(pd.DataFrame(rows))


def of_levels(names, fitted, taken=()):
    """Markdown: the constants at each level; taken: those that step_choice.py has."""
    rows = [[f"{level:g}", *(f"{x:.3g}" for x in fitted(level))] for level in LEVELS]
    return markdown(pd.DataFrame(rows + [["taken", *taken]] * bool(taken), columns=["level", *names]))


def text():
    """The text of results/step_choice.md."""
    found, cells = collisions(), compressions()
    plain, others = found[found.plain], found[~found.plain]
    fitted, grid = plain[plain["set"] != "random"], others[others["set"] == "grid"]
    factors, constants = ("FLUFFY", "CUT", "BREAKING", "BREAKING_FLUFFY"), ("EVENTS", "DECAY", "SPEED")
    taken = [f"{getattr(rule, name):g}" for name in factors]
    of_plain = ", ".join(f"{getattr(rule, name):g}" for name in constants)
    origins = "; ".join(f"{name}: {words}" for name, words in COLLISIONS.origins().items() if name != "columns")
    return "\n\n".join(
        [
            "# Choice of the time step",
            "Largest error of the energy ledger over what `yade_scripts/step_choice.py` has for the 95 % level. "
            f"{len(found)} collisions that met ({len(COLLISIONS.read()) - len(found)} did not), "
            f"{len(COMPRESSIONS.read())} compressions. Data: step_choice.csv, step_choice_compression.csv. "
            f"Measured on: {origins}; compressions: {'; '.join(COMPRESSIONS.origins().values())}. "
            "Scenes are chosen by the columns of these tables; held: no necks, and springs held at their limits.",
            "## CPE aggregates in space",
            "Fit to all but the random ones at a level (fraction of runs below); those of the "
            f"{FITTED_LEVEL:.0%} level are taken ({of_plain}):",
            of_levels(constants, lambda level: fit(fitted, level)),
            of_groups(PLAIN_GROUPS, plain),
            "## Other collisions",
            of_levels(factors, lambda level: fitted_factors(grid, level), taken),
            of_groups(OTHER_GROUPS, others, ("grid", "random")),
            "## Compressions, ending at fillings of 0.1, 0.2, 0.3, 0.4 and 0.5",
            of_groups(COMPRESSION_GROUPS, cells.query(f"not ({REFUSED})"), ("grid", "random")),
            "Refused, because of these errors:",
            of_groups(REFUSED_GROUPS, cells.query(REFUSED)) + "\n",
        ]
    )
