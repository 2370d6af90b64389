"""The collision atlas: what its runs say by themselves. The model that is fitted to them is analysis.atlas.model."""

from math import hypot

import numpy as np
import pandas

from ..atlas.columns import COLUMNS, NAME, measure
from ..atlas.make import SIZES
from ..atlas.outcome_table import PROBABILITIES, read_outcomes
from ..atlas.query import outcome, outcomes_file
from ..atlas.rules import KINDS
from ..atlas.rules import outcome as outcome_at_end
from ..atlas.variables import STRUCTURES, decided, drawn, fit_and_held_out, of_structure, slow, variables
from ..figures.style import letter, panels, styled
from ..measures.fragments import growth_efficiency
from ..measures.outcome import NEVER_MET, UNDECIDED
from ..runs.measured import UNLIKE
from ..theory import ICE, breaking_velocity
from .columns import NotMeasured, group
from .comparison import Row
from .estimates import Estimate, average, beside, ending, estimate, fraction, zero_of_fit
from .figures import COLOURS, plain_ticks, points
from .study import Study

STICKING, BOUNCING, _, EROSION, _ = KINDS
SLOW, ERODING = 5.0, 13.0  # v_break (3.82 m/s for ice); from 13 on most erode, chosen after the runs
COMPACT, MANY_CONTACTS = 0.4, 6.0
EQUAL, HEAD_ON = 0.5, 0.5  # mass ratio at least, impact parameter at most
UNEQUAL = 0.25  # mass ratio from which on to EQUAL it is about 1/3
GROWING = 5.0, 18.0  # v_break: where the mean growth efficiency falls through 0
STICKING_FALLS = 3.0, 14.0  # v_break: where the fraction that sticks falls through 1/2; chosen after the runs
RATIOS = {"below 1/16": (0.0, 1 / 16), "1/16 to 1/4": (1 / 16, 1 / 4), "1/4 to 1": (1 / 4, 1.0)}  # of masses


def _measure(run, row):
    if not NAME.fullmatch(run.path.name):
        raise NotMeasured(f"{run.path}: no run of the atlas, whose names are numbers")
    values = measure(run)
    return [values[column.name] for column in COLUMNS]


def prepared(runs):
    """The table with further columns: `speed` over v_break, `size` (grains of the larger aggregate), `filling` (mean by
    mass of both), `aggregates` (of STRUCTURES), `contacts` (a grain, of the aggregate with more)."""
    at = variables(runs)
    return runs.assign(
        speed=at.velocity,
        size=at.grains,
        filling=at.filling,
        aggregates=runs.structure.map({name: group for group, names in STRUCTURES.items() for name in names}),
        contacts=runs[["coordination_target", "coordination_projectile"]].max(axis=1),
    )


# Estimates. Every run has a pair of its own, so that the jackknife's error of a mean is that of independent values.


def less(one, other):
    """Estimate of one less another, of different runs."""
    error = None if one.error is None or other.error is None else hypot(one.error, other.error)
    return Estimate(one.value - other.value, error, one.pairs + other.pairs)


def bouncing_exponent(runs):
    """a of N ~ v^a, the grains from which on half of the runs bounce: logistic regression on ln N and ln v."""
    try:
        from sklearn.linear_model import LogisticRegression
    except ModuleNotFoundError:  # the package does without it
        return np.nan
    bounced = runs.outcome == BOUNCING
    if bounced.all() or not bounced.any():
        return np.nan
    x = np.log(runs[["size", "speed"]].to_numpy())
    scatter = x.std(axis=0)
    by_size, by_speed = LogisticRegression(C=100.0).fit((x - x.mean(axis=0)) / scatter, bounced).coef_[0] / scatter
    return -by_speed / by_size


def _ends(runs):
    """The runs with `grown`, their growth efficiency (N_largest - N_target)/N_projectile, and whether they have
    `stuck`, as they end; no more columns than are needed, for the jackknife's sake."""
    q = runs.mass_ratio
    grown = growth_efficiency(runs.largest * (1.0 + q), 1.0, q)
    own = runs[["pair", "structure", "size", "speed", "mass_ratio"]]
    return own.assign(grown=grown, stuck=outcome_at_end(runs) == STICKING)


def critical_speed(runs):
    """Speed [v_break] above which targets lose more than they gain: where the growth efficiency, linear in ln v over
    GROWING, falls through 0."""
    return zero_of_fit(runs.speed, runs.grown)


def sticking_speed(runs):
    """Speed [v_break] at which half of the runs have stuck when they end: their fraction linear in ln v over
    STICKING_FALLS."""
    return zero_of_fit(runs.speed, runs.stuck - 0.5)


def rows(runs):
    """What papers say of when aggregates bounce, beside the runs; then what the runs add. Slow: below SLOW."""
    chosen_by_none = drawn(runs)
    known = decided(chosen_by_none)
    slowly = chosen_by_none[(chosen_by_none.outcome != NEVER_MET) & (chosen_by_none.speed < SLOW)]
    many = slowly.contacts >= MANY_CONTACTS
    compressed = slowly[(slowly.structure == "compressed") & slowly.filling.between(0.35, 0.45)]
    what = "bouncing, slow, compressed of filling 0.35 to 0.45"
    yield Row(what, ending(compressed, BOUNCING), (None, 0.05), "none: to 5 %", "Oshiro 2025")
    what = "bouncing, slow, fewer than 6 contacts a grain"
    yield Row(what, ending(slowly[~many], BOUNCING), (None, 0.02), "none: to 2 %", "Wada 2011")
    what = "bouncing, slow, 6 contacts a grain or more"
    yield Row(what, ending(slowly[many], BOUNCING), (0.1, None), "they do: above 10 %", "Wada 2011")
    slow_known = known[known.speed < SLOW]
    bounced = (slow_known.outcome == BOUNCING).astype(float)
    narrow = slow_known.filling.between(0.4, 0.5)
    cpe, cut = (average(bounced[narrow & (slow_known.structure == name)]) for name in ("cpe", "compressed"))
    what = "bouncing, slow, filling 0.4 to 0.5, CPE less compressed"
    yield Row(what, less(cpe, cut), (0, None), "more contacts, more often", "Wada 2011")
    compact = slow_known.filling > COMPACT
    large = slow_known["size"] > slow_known["size"][compact].median()
    more = less(average(bounced[compact & large]), average(bounced[compact & ~large]))
    what = "bouncing, slow, filling above 0.4, larger half less smaller half"
    yield Row(what, more, (0, None), "larger ones more often", "Arakawa 2023")
    exponent = estimate(bouncing_exponent, slow_known.loc[compact, ["pair", "size", "speed", "outcome"]])
    what = "a of N ~ v^a, where half bounce, slow, filling above 0.4"
    yield Row(what, exponent, (-4 / 3 - 0.5, -4 / 3 + 0.5), "-4/3: to 1/2", "Oshiro 2025")
    central = (slow_known.impact < 0.7) & (slow_known.mass_ratio >= 1 - UNLIKE)
    dense = (slow_known.structure == "compressed") & (slow_known.filling > 0.35)
    lost = average(slow_known.lost_in_compression[central & dense])
    what = "dissipated until the largest compression, slow, compressed of filling 0.35 to 0.5, b < 0.7, equal"
    yield Row(what, lost, None, "nearly 90 %, of another measure", "Oshiro 2025")
    met = _ends(chosen_by_none[chosen_by_none.outcome != NEVER_MET])
    yield from _growth(met)
    yield from _sticking_speeds(met)
    yield from _outcomes(slowly, known)
    yield from _predictions(runs)


def _growth(met):
    """Up to which speed targets grow, over all impact parameters: against the mass ratio, and the structure. Undecided
    runs count as they end: without them those that lose more would remain."""
    met = met[met.speed.between(*GROWING)]
    bpca, of_ratio = met[met.structure == "bpca"], []
    within = lambda low, high: bpca[(bpca.mass_ratio > low) & (bpca.mass_ratio <= high)]
    for words, (low, high) in RATIOS.items():
        of_ratio.append(within(low, high))
        yield Row(f"critical velocity of BPCA, masses {words} [v_break]", estimate(critical_speed, of_ratio[-1]))
    ratio = beside(critical_speed, of_ratio[0], of_ratio[-1], np.divide)
    what = "critical velocity of BPCA, masses below 1/16 over 1/4 to 1"
    yield Row(what, ratio, (0.75, 1.33), "hardly another: to a third", "Wada 2013")
    halves = [bpca[(bpca["size"] > bpca["size"].median()) == large] for large in (True, False)]
    what = "critical velocity of BPCA, larger half over smaller half of targets"
    yield Row(what, beside(critical_speed, *halves, np.divide), (0.75, 1.33), "not by size: to a third", "Wada 2013")
    near = within(UNEQUAL, EQUAL), within(EQUAL, 1.0)
    what = "critical velocity of BPCA, masses 1/4 to 1/2 over 1/2 to 1"
    yield Row(what, beside(critical_speed, *near, np.divide), (0.375, 0.67), "half: to a third", "Hasegawa 2021")
    for name in ("bcca", "cpe", "compressed"):
        found = estimate(critical_speed, met[met.structure == name])
        yield Row(f"critical velocity of {name}, all masses [v_break]", found)


def _sticking_speeds(met):
    """At which speed half of the runs have stuck when they end, over all impact parameters, against the structure."""
    met = met[met.speed.between(*STICKING_FALLS)]
    equal = met[(met.structure == "bpca") & (met.mass_ratio > UNEQUAL)]
    yield Row("velocity at which half of BPCA stick, masses 1/4 to 1 [v_break]", estimate(sticking_speed, equal))
    for name in ("bcca", "cpe", "compressed"):
        found = estimate(sticking_speed, met[met.structure == name])
        yield Row(f"velocity at which half of {name} stick, all masses [v_break]", found)


def _outcomes(slowly, known):
    """What becomes of slow and fast collisions."""
    many = slowly[slowly.contacts >= MANY_CONTACTS]
    turned = (many.outcome == BOUNCING) & many.restitution.notna()
    yield Row("turning back, slow, 6 contacts a grain or more", fraction(many, turned, many.outcome == UNDECIDED))
    head_on = slowly[(slowly.mass_ratio > EQUAL) & (slowly.impact < HEAD_ON)]
    for name in STRUCTURES:
        own = head_on[head_on.aggregates == name]
        yield Row(f"bouncing, slow, equal and head-on (b < 1/2), {name}", ending(own, BOUNCING))
    for name, own in (("5 to 13", known.speed.between(SLOW, ERODING)), ("above 13", known.speed > ERODING)):
        for kind in KINDS:
            yield Row(f"{kind.replace('_', ' ')}, {name} v_break", ending(known[own], kind))


def _predictions(runs):
    """Up to which energy all runs stuck, and how well the tables of outcomes predict runs that they were not fitted
    to."""
    fit, held = fit_and_held_out(runs)
    yield Row("kinetic energy below which all fitted runs stuck [E_break]", Estimate(slow(fit).energy))
    yield Row("fitted runs below that energy", Estimate(slow(fit).number))
    p, within = _predicted(held)
    observed = held.outcome.to_numpy()[:, None] == np.array(KINDS)
    frequencies = np.array([(fit.outcome == kind).mean() for kind in KINDS])
    score = lambda p: average(pandas.Series(((p - observed) ** 2).sum(axis=1)))
    yield Row("Brier score of the tables of outcomes, held-out runs", score(p))
    yield Row("Brier score of the fitted runs' frequencies, held-out runs", score(frequencies))
    several = held[within.notna()]
    what = "largest piece within its 90 % interval, held-out runs with several pieces"
    yield Row(what, fraction(several, within.dropna() == 1))


def _predicted(held):
    """Probabilities (n, 5) of KINDS of held-out runs by the tables at each impact parameter, and whether (1, 0) the
    largest piece lies within its interval: NaN where one piece is left, or outside of the data."""
    p, within = np.full((len(held), len(KINDS)), np.nan), pandas.Series(np.nan, held.index)
    for structure in STRUCTURES:
        own = of_structure(held, structure)
        pair = own["size"] * own.mass_ratio, own["size"]
        speed = own.speed * breaking_velocity(ICE, 1e-7)
        found = outcome(speed, *pair, own.filling, impact=own.impact, structure=structure)
        p[held.index.get_indexer(own.index)] = np.column_stack([found[name] for name in PROBABILITIES])
        inside = (found["largest_low"] <= own.largest) & (own.largest <= found["largest_high"])
        within[own.index] = inside.astype(float).where((found["inside"] == 1) & (own.pieces > 1))
    return p, within


# Figures: lines and areas are of the tables of outcomes, dots are runs.


SPEEDS = np.geomspace(0.078, 26.2, 9)  # v_break: limits of bands
FILLINGS = (0.0, 0.04, 0.12, 0.2, 0.3, 0.4, 0.6)
GRAINS, RATIO = 256, 0.25  # of the lines: where most runs are
VELOCITIES = (0.5, 2.2, 10.0)  # v_break: 1.9, 8.4 and 38 m/s for ice
FEWEST = 20  # runs of a structure in a band of fillings, to be drawn


def figures(runs):
    """The fraction that sticks against velocity, and the region in which aggregates bounce."""
    tables = {structure: read_outcomes(outcomes_file(structure, averaged=True)) for structure in STRUCTURES}
    known = decided(drawn(runs))  # those chosen would hide what lies behind them
    caption = (
        "Fraction of collisions that stick, averaged over impact parameters. Dots: decided runs that were not chosen, "
        "in a band of filling φ and velocity (ice: v_break = 3.8 m/s), with standard errors; lines: the tables of "
        f"outcomes at {GRAINS} grains and a mass ratio of 1/4, with their errors; dotted: extrapolated."
    )
    yield "sticking", caption, _sticking(known, tables)
    caption = (
        "Fraction of collisions of equal aggregates that bounce, averaged over impact parameters, by the tables of "
        "outcomes; line: 1/2, dotted: with its error (90 %); hatched: extrapolated. Dots: decided runs that were not "
        "chosen, of all mass ratios near that velocity; black ones bounced."
    )
    yield "bouncing", caption, _bouncing(known, tables)


@styled
def _sticking(runs, tables):
    """p_stick(v), a panel for each band of fillings."""
    figure, axes = panels(2, 3, 3.4, 2.9)
    velocity = np.geomspace(runs.speed.min(), runs.speed.max(), 100)
    bands = runs.groupby(np.digitize(runs.filling, FILLINGS[1:-1]))
    for (_, band), place in zip(bands, axes.ravel()):
        filling = band.filling.mean()
        for (structure, table), colour in zip(tables.items(), COLOURS):
            own = band[band.aggregates == structure]
            if len(own) < FEWEST:
                continue
            found = table.lookup(velocity=velocity, grains=GRAINS, mass_ratio=RATIO, filling=filling)
            p, error, inside = found["p_sticking"], found["error_sticking"], found["inside"] == 1
            low, high = np.clip(p - error, 0, 1), np.clip(p + error, 0, 1)
            place.fill_between(velocity, low, high, color=colour, alpha=0.2, lw=0)
            place.plot(velocity, np.where(inside, p, np.nan), color=colour, label=structure)
            place.plot(velocity, p, ":", color=colour)
            of_speed = own.groupby(np.digitize(own.speed, SPEEDS[1:-1]))
            points(place, of_speed.speed.mean(), [ending(part, STICKING) for _, part in of_speed], colour)
        place.set(xscale="log", ylim=(-0.03, 1.03))
        place.set_title(rf"$\phi$ = {filling:.2g}", fontsize=10)
    for place in axes[-1]:
        place.set_xlabel("$v/v_{break}$")
    for place in axes[:, 0]:
        place.set_ylabel("$p_{stick}$")
    axes[-1, -1].legend(frameon=False)
    letter(axes, "")
    return figure


@styled
def _bouncing(runs, tables):
    """p_bounce in filling and size, a row of panels for each structure."""
    figure, axes = panels(len(tables), len(VELOCITIES), 3.7, 3.1)
    ratio = (VELOCITIES[1] / VELOCITIES[0]) ** 0.5
    for row, (structure, table) in zip(axes, tables.items()):
        for place, velocity in zip(row, VELOCITIES):
            near = (runs.aggregates == structure) & runs.speed.between(velocity / ratio, velocity * ratio)
            areas = _areas_of_bouncing(place, table, velocity)
            for bounced, marker, colour in ((False, ".", "0.6"), (True, "o", "#111111")):
                own = runs[near & ((runs.outcome == BOUNCING) == bounced)]
                place.plot(own.filling, own["size"], marker, color=colour, markersize=4)
            place.set_title(f"{structure}, $v$ = {velocity:g} $v_{{break}}$", fontsize=10)
        row[0].set_ylabel("grains of the larger aggregate")
    for place in axes[-1]:
        place.set_xlabel(r"filling factor $\phi$")
    figure.colorbar(areas, ax=list(axes.ravel()), label="$p_{bounce}$, equal masses")
    return figure


def _areas_of_bouncing(place, table, velocity):
    """p_bounce of a table at a velocity, with the line p = 1/2; returns the coloured areas."""
    first, last = table.axes[3].nodes[[0, -1]]
    filling, grains = np.linspace(first, last, 60), np.geomspace(SIZES[0], SIZES[-1], 60)
    found = table.lookup(velocity=velocity, grains=grains[:, None], mass_ratio=1.0, filling=filling)
    look = dict(vmin=0, vmax=1, cmap="Purples", shading="nearest", rasterized=True)
    areas = place.pcolormesh(filling, grains, found["p_bouncing"], **look)
    for sign, line in ((0, "-"), (-1, ":"), (1, ":")):
        p = found["p_bouncing"] + sign * found["error_bouncing"]
        if p.min() < 0.5 < p.max():
            place.contour(filling, grains, p, levels=[0.5], colors="#7b3fa0", linestyles=line)
    place.contourf(filling, grains, found["inside"], levels=[-1, 0.999], colors="none", hatches=["///"])
    place.set(yscale="log", xlim=(first, last), ylim=(grains[0], grains[-1]))
    plain_ticks(place, "y")
    return areas


STUDY = Study(
    title="The collision atlas",
    question="What do two aggregates do when they meet: where in size, filling, velocity and mass ratio do they stick, "
    "bounce, erode and break?",
    values={"neck": 0.0, "viscoelasticTime": 0.0, "planar": 0},
    key=("velocity", "impact", "number"),
    measured=(group(_measure, *COLUMNS),),
    pair=("number",),
    rows=rows,
    figures=figures,
    prepared=prepared,
    independent="runs",
)
