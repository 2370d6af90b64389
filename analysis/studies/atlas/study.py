"""What the runs of the atlas say by themselves; the model fitted to them is analysis.atlas.model."""

import numpy as np
import pandas
from scipy.spatial import cKDTree

from ...atlas.columns import COLUMNS, is_run_of_the_atlas, measure
from ...atlas.rules import KINDS
from ...atlas.variables import STRUCTURES, decided, drawn, fit_and_held_out, scaled, slow, touching, variables
from ...measures.of_run import UNLIKE
from ...measures.outcome import NEVER_MET, UNDECIDED
from ...runs.collect import Scene
from ..columns import group
from ..definition import NotMeasured, Quantity, Study
from ..estimate import exact
from ..runs import Runs, select, together
from .bouncing import threshold_exponent

STICKING, BOUNCING, *BREAKING = KINDS
SPEEDS = np.geomspace(0.078, 26.2, 9)  # v_break: limits of bands
FILLINGS = (0.0, 0.04, 0.12, 0.2, 0.3, 0.4, 0.6)
SLOW = 5.0  # v_break, 19 m/s for ice: faster aggregates break, or pass each other
MANY_CONTACTS, COMPACT = 6.0, 0.4
ERODING = 13.0  # v_break; chosen after the runs
FAST, HALF = 20.0, 0.5  # v_break; mass ratio of equals at least, and b of head-on collisions at most
HEAD_ON, EQUAL = 0.7, 1 - UNLIKE  # impact parameter at most, mass ratio at least: of others d has no meaning
BY_BAND, BY_GROUP = ("aggregates", "filling", "speed"), ("group",)


def quantities(table):
    """Quantities of a table of runs (atlas.columns): fractions are of its drawn() rows."""
    fit, _ = fit_and_held_out(table)
    yield _counts(table)
    yield _slow(slow(fit))
    table = drawn(table)
    at = variables(table)
    aggregates = table.structure.map({name: group for group, names in STRUCTURES.items() for name in names})
    bands = {"filling": _middle(at.filling, FILLINGS), "speed": _middle(at.velocity, SPEEDS)}
    table = table.assign(aggregates=aggregates, **bands)
    all_runs, runs = Runs(table, "number"), Runs(decided(table), "number")
    is_kind = lambda kind: lambda t: t.outcome == kind
    yield Quantity(
        "missed", "runs whose aggregates never touch", all_runs.fractions(is_kind(NEVER_MET), ("structure",))
    )
    still_open = all_runs.of(touching(table)).fractions(is_kind(UNDECIDED), ("structure",))
    yield Quantity("undecided", "runs whose outcome is undecided, of those that touch", still_open)
    for kind in KINDS:
        meaning = f"{kind.replace('_', ' ')}, of decided runs, by filling (mean of a band) and velocity over v_break"
        yield Quantity(f"{kind}_at", meaning, runs.fractions(is_kind(kind), BY_BAND))
    yield from _bouncing(runs, all_runs.of(touching(table)))
    yield _fast(runs)
    head_on = (runs.table.impact < HEAD_ON) & (runs.table.mass_ratio >= EQUAL) & (at.velocity[runs.table.index] < SLOW)
    compressed = (runs.table.structure == "compressed") & (at.filling[runs.table.index] > 0.35)
    lost = _grouped(runs, {"compressed of filling 0.35 to 0.5": head_on & compressed}).estimates(
        "lost_in_compression", BY_GROUP
    )
    meaning = f"dissipated until the largest compression, of K(0) and the potential energy released until then; b < {HEAD_ON:g}, mass ratio from {EQUAL:g} on, below {SLOW:g} v_break"
    yield Quantity("lost_in_compression", meaning, lost)
    yield _silicate(runs)
    broken = runs.of(runs.table[runs.table.outcome.isin(BREAKING)])
    index = broken.estimates("fragment_index", ("outcome",))
    yield Quantity("fragment_index", "n of dN/dm ~ m^-n of all pieces but the largest", index)
    change = runs.estimates(lambda t: t.filling_largest / t.filling_target, ("structure", "outcome"))
    yield Quantity("compaction", "filling of the largest piece over that of the larger aggregate before", change)
    yield Quantity(
        "energy_closure", "largest error of the ledger, of K(0)", runs.estimates("energy_closure", ("structure",))
    )


def _counts(table):
    """Grains of the larger aggregates, and cells."""
    known = {
        "least": table.grains_target.min(),
        "most": table.grains_target.max(),
        "cells": table.cell[table.cell > 0].nunique(),
        "chosen": len(table) - len(drawn(table)),
        "undecided": (table.outcome == UNDECIDED).sum(),
    }
    return Quantity(
        "grains",
        "of the larger aggregate; cells that compressed ones are cut out of; rows that were chosen; undecided ones",
        _exact(known),
    )


def _slow(own):
    meaning = f"energy over E_break below which all fitted runs stuck, and their number; anything else has a chance of {own.most:.2g} there at most (95 %)"
    return Quantity("slow", meaning, _exact({"energy": own.energy, "runs": own.number}))


def _exact(values):
    """Series of numbers without scatter, by `number`."""
    return pandas.Series(list(map(exact, values.values())), pandas.Index(list(values), name="number"), dtype=object)


def _middle(values, limits):
    """Mean of the values in each band of limits, for each of them."""
    band = pandas.Series(np.digitize(values, limits[1:-1]), values.index)
    return values.groupby(band).transform("mean")


def _grouped(runs, groups):
    """Runs with a row for each group, {name: mask (runs,)}, that a run is in, the name in the column `group`."""
    parts = [runs.table[own].assign(group=name) for name, own in groups.items()]
    return runs.of(pandas.concat(parts, ignore_index=True))


def _bouncing(runs, touched):
    """Where aggregates bounce: of all that touch and of decided runs, below SLOW, and differences of it between the latter."""
    all_slow, _ = _slower(touched)
    grouped, of_those = _grouped(all_slow, _kinds(all_slow.table)), f"of those below {SLOW:g} v_break that touch"
    fractions = lambda column: grouped.fractions(column, BY_GROUP, lambda t: t.outcome == UNDECIDED)
    yield Quantity(BOUNCING, f"runs that bounce, {of_those}", fractions("bounced"))
    yield Quantity("turned_back", f"runs that bounce and don't pass each other, {of_those}", fractions("turned_back"))
    slow, at = _slower(runs)
    table = slow.table
    compact, narrow = at.filling > COMPACT, at.filling.between(0.4, 0.5)
    large = compact & (at.grains > at.grains[compact].median())
    pairs = {
        "larger than smaller": (large, compact & ~large),
        "CPE than compressed": (narrow & (table.structure == "cpe"), narrow & (table.structure == "compressed")),
    }
    fast = touched.of(touched.table[variables(touched.table).velocity.between(SLOW, FAST)])
    groups = {
        "equal": fast.table.mass_ratio > HALF,
        "equal and head-on": (fast.table.mass_ratio > HALF) & (fast.table.impact < HALF),
    }
    found = _grouped(fast, groups).fractions(
        lambda t: t.outcome == BOUNCING, BY_GROUP, lambda t: t.outcome == UNDECIDED
    )
    meaning = f"runs that bounce, of those of {SLOW:g} to {FAST:g} v_break that touch; equal: mass ratio above {HALF:g}, head-on: b below {HALF:g}"
    yield Quantity("bouncing_fast", meaning, found)
    mean = lambda name, own: _grouped(slow, {name: own}).estimates("bounced", BY_GROUP)
    more = [mean(name, one) - mean(name, other) for name, (one, other) in pairs.items()]
    yield Quantity(
        "bouncing_more", "fraction that bounces, of one kind of aggregates less that of another", pandas.concat(more)
    )
    law = _grouped(slow, {"filling above 0.4": compact}).fit(threshold_exponent, ("exponent",), BY_GROUP)
    meaning = (
        "a of N ~ v^a, the grains from which on more than half of the runs bounce: logistic regression on ln N and ln v"
    )
    yield Quantity("bouncing_exponent", meaning, select(law, number="exponent"))


def _slower(runs):
    """(Runs of those below SLOW with the columns `bounced` and `turned_back`, their variables)."""
    at = variables(runs.table)
    own = runs.table[at.velocity < SLOW]
    bounced = own.outcome == BOUNCING
    slow = runs.of(own.assign(bounced=bounced.astype(float), turned_back=bounced & own.restitution.notna()))
    return slow, at.loc[slow.table.index]


def _kinds(table):
    """{name: mask (runs,)} of the kinds of pairs of which the page tells how often they bounce."""
    at = variables(table)
    contacts = table[["coordination_target", "coordination_projectile"]].max(axis=1)
    equal = (at.mass_ratio > HALF) & (table.impact < HALF)
    return {
        "compressed of filling 0.35 to 0.45": (table.structure == "compressed") & at.filling.between(0.35, 0.45),
        "fewer than 6 contacts": contacts < MANY_CONTACTS,
        "6 contacts or more": contacts >= MANY_CONTACTS,
        **{f"equal and head-on, {name}": equal & (table.aggregates == name) for name in STRUCTURES},
        **{f"structure {name}": table.structure == name for name in sorted(set(table.structure))},
    }


def _fast(runs):
    """Decided runs above SLOW by outcome, below and above the velocity from which most erode."""
    at = variables(runs.table).velocity
    groups = {f"{SLOW:g} to {ERODING:g} v_break": at.between(SLOW, ERODING), f"above {ERODING:g} v_break": at > ERODING}
    grouped = _grouped(runs, groups)
    of_kinds = {kind: grouped.fractions(lambda t, kind=kind: t.outcome == kind, BY_GROUP) for kind in KINDS}
    return Quantity("fast", f"decided runs above {SLOW:g} v_break by outcome", together(of_kinds, "outcome"))


def _silicate(runs):
    """Largest piece of each run of silicate less that of the nearest one of ice."""
    at, of_ice = variables(runs.table), (runs.table.material == "ice").to_numpy()
    points = scaled(at)
    scatter = points.std(axis=0)
    _, nearest = cKDTree(points[of_ice] / scatter).query(points[~of_ice] / scatter)
    more = runs.table[~of_ice].largest.to_numpy() - runs.table[of_ice].largest.to_numpy()[nearest]
    fast = at.velocity[~of_ice] > ERODING
    group = np.where(fast, f"above {ERODING:g} v_break", f"up to {ERODING:g} v_break")
    found = runs.of(runs.table[~of_ice].assign(more=more, group=group)).estimates("more", BY_GROUP)
    meaning = "mass of the largest piece of silicate aggregates over the total, less that of the run of ice nearest in v/v_break, size, mass ratio, filling and b^2"
    return Quantity("largest_more", meaning, found)


def _measure(run, row):
    """Values of COLUMNS; NotMeasured for a run of no row of the atlas."""
    if not is_run_of_the_atlas(run):
        raise NotMeasured(f"{run.path}: no run of the atlas, whose names are numbers")
    values = measure(run)
    return [values[column.name] for column in COLUMNS]


STUDY = Study(
    title="The collision atlas",
    question="What do two aggregates do when they meet: where in size, filling, velocity and mass ratio do they stick, bounce, erode and break?",
    scene=Scene(
        "the atlas", {"neck": 0.0, "viscoelasticTime": 0.0, "planar": 0}, ("velocity", "impact"), measured=("number",)
    ),
    measured=(group(_measure, *COLUMNS),),
    open_runs="means leave them out, and fractions that don't count them apart",
    quantities=quantities,
    independent="runs",
)
