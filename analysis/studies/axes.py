"""What the atlas leaves out: collisions of aggregates as they are, and of the same pairs with one thing changed."""

import re
from functools import partial

import numpy as np

from ..figures.style import letter, panels, styled
from ..measures.outcome import NEVER_MET, STICKING, UNDECIDED
from ..theory import ICE, breaking_velocity
from .columns import CLOSURE, OUTCOME, VELOCITY, Column, NotMeasured, group, one, outcome_of, parameter
from .comparison import Row
from .estimates import average, beside, estimate, zero_of_fit
from .figures import COLOURS, plain_ticks, points
from .study import Study

NAME = re.compile(r"(\d+)-([a-z]+)-(.+)")  # of a run folder: pair, axis, level
BASE = "base"
AXES = {  # axis: its title
    "drag": "drag: T_vis",
    "gamma": "surface energy [J/m²]",
    "spin": "both spin [rad/s]",
    "radii": "radii",
    "materials": "ice and silicate",
    "necks": "sintered necks [r]",
    "rolling": "critical rolling displacement",
    "springs": "a spring left out",
}
SMALL = 100  # grains of each aggregate of those whose names say no size
SPEEDS = (2.0, 3.2, 5.0, 6.5, 8.5, 12.0, 25.0)  # v_break: limits of bands
FAST = 5.0  # v_break: below, aggregates stick
HARDLY = (0.75, 1.33)  # of a critical velocity: as in the atlas


def _named(run, row):
    found = NAME.fullmatch(run.path.name)
    if not found:
        raise NotMeasured(f"{run.path}: no run of this study, whose names are NUMBER-AXIS-LEVEL")
    number, axis, level = found.groups()
    return int(number), axis, level


MEASURED = (
    group(
        _named,
        Column("number", "", "of the pair of aggregates", "i"),
        Column("axis", "", "what is changed; base: nothing", "O"),
        Column("level", "", "to what", "O"),
    ),
    parameter("grains", "", "of each aggregate", "i"),
    parameter("packing", "", "structure of both aggregates", "O"),
    VELOCITY,
    parameter("impact", "", "impact parameter over the sum of the characteristic radii"),
    OUTCOME,
    one("growth", "", "growth efficiency by mass", lambda run: float(outcome_of(run).growth_efficiency)),
    CLOSURE,
)


def prepared(runs):
    """The table with `speed` [v_break], that of the pair unchanged; `stuck` and `grown`, NaN where they did not meet or
    are undecided; `more` and `gain`: these less those of the pair unchanged; `at_end`: growth of undecided runs too, as
    they stand at their end."""
    known = ~runs.outcome.isin((NEVER_MET, UNDECIDED))
    runs = runs.assign(stuck=(runs.outcome == STICKING).astype(float).where(known), grown=runs.growth.where(known))
    runs = runs.assign(at_end=runs.growth.where(runs.outcome != NEVER_MET))
    base = runs[runs.axis == BASE].set_index("number")
    of_base = lambda name: runs.number.map(base[name])
    speed = of_base("velocity") / breaking_velocity(ICE, 1e-7)
    return runs.assign(speed=speed, more=runs.stuck - of_base("stuck"), gain=runs.grown - of_base("grown"))


def critical_speed(column, runs):
    """Speed [v_break] above which targets lose more than they gain, by `grown` or `at_end` of runs; NaN far from
    them."""
    found = zero_of_fit(runs.speed, runs[column])
    return found if FAST / 2 < found < 2 * SPEEDS[-1] else np.nan


def _fast(column, runs):
    """What critical_speed() takes of the runs from FAST on: the others stick."""
    return runs.loc[(runs.speed > FAST) & runs[column].notna(), ["pair", "speed", column]]


def rows(runs):
    """Critical velocities over that of the same pairs unchanged, and how the fraction that sticks changes."""
    for grains, alike in runs.groupby("grains"):
        base, changed = alike[(alike.axis == BASE) & alike.speed.notna()], alike[alike.axis != BASE]
        for packing, own in base.groupby("packing"):
            found = estimate(partial(critical_speed, "grown"), _fast("grown", own))
            yield Row(f"critical velocity of {packing}, nothing changed, {grains:,} grains [v_break]", found)
        for (axis, level), own in sorted(changed.groupby(["axis", "level"], sort=False), key=_place):
            yield from _changed(own, base, axis, f"{AXES[axis]}, {level}", grains)


def _changed(runs, base, axis, what, grains):
    """The same of one level of an axis."""
    paper = {"drag": (HARDLY, "hardly another", "A22"), "rolling": (HARDLY, "hardly another", "A22b")}.get(axis, ())
    size = "" if grains == SMALL else f", {grains:,} grains"
    for column, words in (("grown", ""), ("at_end", ", undecided as they stand")):
        found = beside(partial(critical_speed, column), _fast(column, runs), _fast(column, base), np.divide)
        yield Row(f"critical velocity over that unchanged{words}: {what}{size}", found, *(() if words else paper))
    slow, fast = runs[runs.speed < FAST], runs[runs.speed >= FAST]
    for words, part in (("below", slow), ("above", fast)):
        if len(part):
            yield Row(f"change of the fraction that sticks, {words} {FAST:g} v_break: {what}{size}", average(part.more))
    yield Row(f"change of the growth efficiency, above {FAST:g} v_break: {what}{size}", average(fast.gain))


def _place(group):
    (axis, level), _ = group
    return list(AXES).index(axis), level


def figures(runs):
    """Changes of the fraction that sticks, and of the growth efficiency."""
    changed = runs[(runs.axis != BASE) & runs.more.notna() & (runs.grains == SMALL)]
    if len(changed):
        less = ", less that of the same pairs unchanged, with standard errors."
        yield "sticking", f"Fraction that sticks{less}", _changes(changed, "more", "change of $p_{stick}$")
        yield "growth", f"Growth efficiency{less}", _changes(changed, "gain", "change of growth efficiency")


@styled
def _changes(runs, column, label):
    """A panel for each axis: the mean of a column against the speed."""
    figure, axes = panels(2, 4, 3.3, 2.9)
    for place, (axis, title) in zip(axes.ravel(), AXES.items()):
        own = runs[runs.axis == axis]
        for level, colour in zip(sorted(own.level.unique()), COLOURS):
            part = own[own.level == level]
            bands = part.groupby(np.digitize(part.speed, SPEEDS[1:-1]))
            points(place, bands.speed.mean(), [average(band[column]) for _, band in bands], colour, level, line="-")
        place.axhline(0.0, color="0.6", lw=0.8, zorder=0)
        place.set(xscale="log", xlim=(SPEEDS[0], SPEEDS[-1]))
        plain_ticks(place, "x")
        place.set_title(title, fontsize=10)
        place.legend(frameon=False, fontsize=8, loc="upper left")
    for place in axes[-1]:
        place.set_xlabel("$v/v_{break}$")
    low, high = zip(*(place.get_ylim() for place in axes.ravel()))
    for place in axes.ravel():
        place.set_ylim(min(low), max(high))
    for place in axes[:, 0]:
        place.set_ylabel(label)
    letter(axes, "")
    return figure


STUDY = Study(
    title="What the atlas leaves out",
    question="Do drag, surface energy, spin, unlike radii, a second material, sintered necks, rolling or a missing "
    "spring change what becomes of a collision?",
    values={},
    key=("number", "axis", "level"),
    measured=MEASURED,
    pair=("number",),
    rows=rows,
    figures=figures,
    prepared=prepared,
)
