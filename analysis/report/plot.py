"""A column of a table of runs against another, with error bars over pairs of aggregates."""

import textwrap
from collections.abc import Mapping
from dataclasses import dataclass
from numbers import Real

import numpy as np
import pandas

from ..arguments import Kind, one_of, takes, wrong
from ..measures.outcome import NEVER_MET, STICKING, UNDECIDED
from ..runs.format import CHANNELS, COMPRESSION
from ..runs.named import unknown
from ..runs.table import FOLDER
from ..studies.curve_figure import CurveFigure
from ..studies.definition import Quantity, Results
from ..studies.estimate import Fraction
from ..studies.runs import Runs, SeveralRuns, each
from .rows import at_end, differing, parameters, table, varied

WHATS = "sticking", "largest", "energy"
SEED, CHANNEL, LARGEST, KIND = "seed", "channel", "largest_fraction", "kind"
FILES = "file", "projectileFile"  # with the seed, what tells pairs of aggregates apart
OF_MAXIMUM = "d_max", "t_max"
APART = 5.0  # points between curves
LETTERS = 13  # of a title, an inch of the figure


class CannotPlot(ValueError):
    """What is asked for cannot be drawn from these runs; the message is one line."""


@dataclass(frozen=True)
class OfDecided:
    """How many of the decided runs of a Fraction ended so; the interval (95 %, exact) counts the undecided ones either way."""

    fraction: Fraction
    error = None

    @property
    def pairs(self):
        return self.fraction.pairs - self.fraction.undecided

    @property
    def value(self):
        return self.fraction.successes / self.pairs if self.pairs else np.nan

    def interval(self):
        return self.fraction.interval()


NAME = Kind("the name of a column", lambda name: isinstance(name, str) and name != "")


@takes(
    what=Kind(f"{', '.join(WHATS)}, or {NAME.must}", NAME.is_right),
    x=NAME,
    by=Kind(f"{NAME.must}, or ''", lambda name: name is None or isinstance(name, str)),
    where=Kind("{column: value}", lambda where: isinstance(where, Mapping)),
    logarithmic=one_of("x", "y", "xy", ""),
)
def plot(what, runs, x="velocity", by="", where=None, logarithmic=None):
    """matplotlib Figure of runs (a table(), or what that takes).

    what: "sticking" (fraction of the runs that stick, with exact 95 % intervals; of the decided ones: those that are undecided, or
    have not ended, widen the interval, counted either way, and are named above, as are those that never met, which are left out),
    "largest" (mass fraction of the largest piece), "energy" (change of every channel from the start to the end, over K(0), or of compressions the boundaries' work; kinetic: what is left), or any
    column. x: a column of numbers; by: a column that tells curves (panels, of "energy") apart; where: {column: value} of the runs
    that are drawn; logarithmic: axes, 'x', 'y', 'xy' or '' (None: x where it spans a decade). Bars but of "sticking" are standard
    errors of the mean over pairs of aggregates, which are told by their seed and their files; open points are single pairs. Runs of a
    kind that has no x, or nothing of what is drawn, are left out and counted above.

    CannotPlot (ValueError) where runs differ in parameters beside x, by, the seed and the files; UnknownName (KeyError) for a wrong
    column.
    """
    found = runs if isinstance(runs, pandas.DataFrame) else table(runs)
    if not found.index.is_unique:  # of tables put together
        found, found.attrs = found.reset_index(drop=True), found.attrs
    if by == x:
        raise CannotPlot(f"by = {by}: must be another column than x")
    _require_columns(found, what, [x, *([by] if by else []), *(where or {})])
    files = [name for name in FILES if name in found and found[name].notna().any()]
    drawn = Runs(found, SEED if SEED in found else FOLDER, files)
    for name, value in (where or {}).items():
        drawn = _only(drawn, name, value)
    asked, of_kinds = drawn.table, _of_kinds(drawn.table, [x, *_columns(what)])
    without = _without(of_kinds, what, x, by)
    drawn = drawn.of(of_kinds[~without.to_numpy().any(axis=1)])
    if not len(drawn.table):
        raise CannotPlot(f"no run has all of {', '.join(dict.fromkeys(name for name in (what, x, by) if name))}")
    _require_drawable(drawn.table, x, by)
    quantity = _quantity(what, drawn, [x, by] if by else [x])
    if not len(quantity.values):
        raise CannotPlot(f"{what}: no run has a value")
    figure = _curves(what, drawn.table, x, by, logarithmic).draw(Results(drawn.table, {quantity.name: quantity}))
    for axes in figure.axes:
        if axes.get_xlabel() == x:
            axes.set_xlabel(_with_unit(found, x))
    lines = textwrap.wrap(_about(drawn.table, what, asked, without), int(LETTERS * figure.get_figwidth()))
    figure.suptitle("\n".join(lines), fontsize=10)
    return figure


def _columns(what):
    """Columns of what is drawn."""
    return {"sticking": ["outcome"], "largest": [LARGEST], "energy": list(map(at_end, CHANNELS))}.get(what, [what])


def _of_kinds(found, columns):
    """The runs of the kinds that have values in all columns; all of them where no kind has."""
    having = found[columns].notna().groupby(found[KIND]).any().all(axis=1)
    kept = found[found[KIND].map(having)]
    return kept if len(kept) else found


def _without(found, what, x, by):
    """{what is said of them: whether runs (n,) can't be drawn} as a DataFrame: without a value, and where d_max is but a bound."""
    shown = () if what in ("sticking", "energy") else _columns(what)
    of = {f"without {name}": found[name].isna() for name in dict.fromkeys((x, by, *shown)) if name}
    for name in {what, x, by}.intersection(OF_MAXIMUM):
        of[f"whose {name} is only a bound"] = found.maximum_inside.eq(False)
    return pandas.DataFrame(of, found.index)


def _quantity(what, drawn, by):
    """Quantity of what is drawn."""
    if what == "sticking":
        collisions = drawn.of(drawn.table[drawn.table.outcome.notna() & ~_never_met(drawn.table)])
        try:
            values = collisions.fractions(lambda table: table.outcome == STICKING, by, _undecided)
        except SeveralRuns as error:
            raise CannotPlot(str(error)) from None
        return Quantity(what, "", each(values, lambda fraction, *_: OfDecided(fraction)))
    if what == "energy":
        changing = {c: at_end(c) for c in CHANNELS if c == "kinetic" or drawn.table[at_end(c)].any()}
        return Quantity(what, "", drawn.parts(changing, by, CHANNEL), "%", 0.01)
    column = LARGEST if what == "largest" else what
    _require_numbers(drawn.table, column)
    return Quantity(what, "", drawn.estimates(column, by))


def _curves(what, found, x, by, logarithmic):
    """CurveFigure of what is drawn."""
    if logarithmic is None:
        low, high = found[x].min(), found[x].max()
        logarithmic = "x" if low > 0 and high >= 10 * low else ""
    of_work = (found[KIND] == COMPRESSION.name).all()
    labels = {
        "sticking": "runs that stick, of the decided ones",
        "largest": "mass of the largest piece, of all",
        "energy": "change, of the boundaries' work  [%]" if of_work else "change (kinetic: end), of K(0)  [%]",
    }
    return CurveFigure(
        *(what, "", what, x),
        colour=CHANNEL if what == "energy" else by,
        panel=by if what == "energy" else "",
        logarithmic=logarithmic,
        y_label=labels.get(what) or _with_unit(found, what),
        limits=(-0.03, 1.03) if what in ("sticking", "largest") else None,
        line="-" if x in parameters(found) else "",
        apart=0.0 if what == "energy" else APART,
    )


def _require_columns(found, what, named):
    """Raise UnknownName for a name that is no column of a table, CannotPlot where it is none of table()."""
    if what not in (*WHATS, *found.columns):
        raise unknown("table of runs", what, (*WHATS, *found.columns))
    own = [SEED if SEED in found else FOLDER, "outcome", "ended", KIND]
    own += ["maximum_inside"] if {what, *named}.intersection(OF_MAXIMUM) else []
    for name in named:
        if name not in found:
            raise unknown("table of runs", name, found.columns)
    lacking = [name for name in dict.fromkeys((*_columns(what), *own)) if name not in found]
    if lacking:
        raise CannotPlot(f"table of runs: lacks {', '.join(lacking)}; must be as analysis.table() gives it")


def _only(drawn, name, value):
    """The Runs with a value in a column."""
    of_numbers = drawn.table[name].dtype.kind in "fiu"
    if of_numbers and not isinstance(value, Real) or not (of_numbers or np.isscalar(value)):
        raise wrong(f"where {name}", value, "a number" if of_numbers else "one value")
    left = drawn.where(**{name: value})
    if not len(left.table):
        there = ", ".join(map(str, drawn.table[name].unique()))
        raise CannotPlot(f"where {name} = {value}: no run is left; must be one of {there}")
    return left


def _require_drawable(found, x, by):
    _require_numbers(found, x)
    if found[KIND].nunique() > 1:
        raise CannotPlot(f"the runs are of the kinds {', '.join(found[KIND].unique())}: choose where {KIND}")
    others = [name for name in varied(found) if name not in (x, by, SEED, *FILES)]
    if others and x in parameters(found):
        raise CannotPlot(differing(found, others, "choose by or where"))


def _require_numbers(found, name):
    if found[name].dtype.kind not in "fiub":
        raise CannotPlot(f"{name}: holds words, or nothing; must be a column of numbers")


def _undecided(found):
    """Whether runs have no outcome that counts (n,): they say so, or have not ended."""
    return found.outcome.map(lambda text: str(text).startswith(UNDECIDED)) | ~found.ended.astype(bool)


def _never_met(found):
    return found.outcome == NEVER_MET


def _with_unit(found, name):
    unit = found.attrs.get("units", {}).get(name, "")
    return name + (f"  [{unit}]" if unit not in ("", "1") else "")


def _about(found, what, asked, without):
    """How many runs there are, and how many of them never met, have no outcome that counts, or are left out of those asked for: of
    other kinds, and by _without()."""
    missed, sticking = _never_met(found), what == "sticking"
    undecided = int((_undecided(found) & ~(missed & sticking)).sum())
    others = asked[KIND][~asked.index.isin(without.index)].value_counts()
    text = f"{len(found)} runs" + "".join(f", {number} of the kind {kind} left out" for kind, number in others.items())
    text += "".join(f", {own.sum()} {name} left out" for name, own in without.items() if own.any())
    text += f", {missed.sum()} {'that never met left out' if sticking else 'of them never met'}" if missed.any() else ""
    text += f", {undecided} of them undecided or not ended" if undecided else ""
    return text + (" (in the bars, counted either way)" if undecided and sticking else "")
