"""A column of a table of runs against another, with error bars over pairs of aggregates."""

import numpy as np
import pandas

from ..measures.outcome import NEVER_MET, STICKING, UNDECIDED
from ..printable import Refused, suggested
from ..report.rows import at_end, differing, parameters, table, varied
from ..runs.format import CHANNELS, COLOURS, COMPRESSION, same, value_text
from ..runs.table import FOLDER
from .estimates import ending, estimate, mean
from .figures import curves

WHATS = {"sticking": "outcome", "largest": "largest_fraction", "energy": at_end("kinetic")}  # and their columns
FILES = "file", "projectileFile"  # with the seed they distinguish pairs of aggregates
OF_MAXIMUM = {"d_max", "t_max"}


def plot(what, runs, x="velocity", by="", where=None, logarithmic=None, over="", bins=0):
    """Figure of many runs: a quantity against one of their columns, with standard errors over pairs of aggregates.

    Pairs differ in their seed and files; open points are single pairs. A fraction of n runs is (k + 1)/(n +
    2), with the binomial error. Left out are runs without a value, with a d_max that is only a bound, that never
    met, and of fractions those that are undecided or have not ended; the title counts them.

    Parameters
    ----------
    what : str
        "sticking" (fraction of the decided runs that stick), "largest" (mass fraction of the largest piece), "energy"
        (change of every channel over K(0), of compressions over the boundaries' work; kinetic: what is left), or a
        column.
    runs : pandas.DataFrame, path, pattern, RunFolder or list of these
        A table(), or what that takes.
    x, by : str
        Columns: of numbers, and that distinguishes curves (of "energy" panels).
    where : dict, optional
        {column: value} of the runs that are drawn.
    logarithmic : str, optional
        Axes: "x", "y", "xy" or "". By default x if it spans a decade.
    over : str
        Column over whose values is averaged, such as impact; a pair then counts by its mean.
    bins : int
        Number of bins of equal width of x, each drawn at the mean x of its runs; 0: every x for itself.

    Returns
    -------
    matplotlib.figure.Figure
        Refused (a ValueError) also if runs differ in parameters beside x, by, over, the seed and the files.
    """
    found = runs if isinstance(runs, pandas.DataFrame) else table(runs)
    attributes, where = found.attrs, where or {}
    found = found.reset_index(drop=True)  # of tables put together
    found.attrs = attributes
    for name in filter(None, (what, x, by, over, *where)):
        if name not in found and not (name == what and what in WHATS):
            names = (*WHATS, *found) if name == what else found
            raise Refused(f"table of runs: no column {name}{suggested(name, names)}")
    for name, value in where.items():
        found = _only(found, name, value)
    number, column = len(found), WHATS.get(what, what)
    found = _complete(found, what, [name for name in (column, x, by) if name])
    if not len(found):
        raise Refused(f"no run has all of {', '.join(filter(None, (what, x, by)))}")
    for name in {x, column} - {"outcome"}:
        if found[name].dtype.kind not in "fiub":
            raise Refused(f"{name}: holds words, or nothing; must be a column of numbers")
    seed = "seed" if "seed" in found else FOLDER
    _require_alike(found, (x, by, over, seed, *FILES), x)
    files = [name for name in FILES if name in found and found[name].notna().any()]
    found = found.assign(pair=found[[seed, *files]].astype(str).agg("|".join, axis=1))
    for name in filter(None, (x, by)):
        found[name] = found[name].map(lambda value: float(value_text(value)) if isinstance(value, float) else value)
    if logarithmic is None:
        logarithmic = "x" if found[x].min() > 0 and found[x].max() >= 10 * found[x].min() else ""
    if bins:
        found[x] = found[x].groupby(_bins(found[x], bins, "x" in logarithmic)).transform("mean")
    try:
        figure = _draw(found.sort_values([name for name in (by, x) if name]), what, x, by, logarithmic, over)
    except ValueError as error:  # a pair with several runs
        raise Refused(f"{what}: {error}") from None
    if figure is None:
        raise Refused(f"{what}: no run has a value")
    title = f"runs: {len(found)}, pairs: {found.pair.nunique()}"
    title += f", left out: {number - len(found)}" if len(found) < number else ""
    figure.suptitle(title, fontsize=10)
    return figure


def _bins(values, number, logarithmic):
    """Number of the bin of each value, of equal widths on the axis."""
    place = np.log(values) if logarithmic else values
    return pandas.cut(place, number, labels=False)


def _draw(found, what, x, by, logarithmic, over):
    """The Figure; None if no run has a value."""
    units = found.attrs.get("units", {})
    with_unit = lambda name: name + (f"  [{units[name]}]" if units.get(name, "") not in ("", "1") else "")
    how = {"log": logarithmic, "line": "-" if x in parameters(found) else "", "x_label": with_unit(x)}
    words = [f"{by} {value_text(value)}" for value in found[by]] if by else ""
    if what == "energy":
        of_work = (found["kind"] == COMPRESSION.name).all()
        changing = [c for c in CHANNELS if c == "kinetic" or found[at_end(c)].any()]
        parts = [found.assign(value=100 * found[at_end(c)], channel=c, words=words) for c in changing]
        how |= {"panel": "words" if by else "", "colour": "channel", "palette": COLOURS}
        label = "change, of the boundaries' work  [%]" if of_work else "change (kinetic: end), of K(0)  [%]"
        return curves(pandas.concat(parts), lambda own: estimate(mean("value"), own), x, y_label=label, **how)
    found, how["colour"] = found.assign(words=words), "words" if by else ""
    if what == "sticking":
        label, sticks = "fraction of runs that stick", lambda own: own.outcome.eq(STICKING)
        of = lambda own: estimate(mean(sticks), own) if over else ending(own, STICKING)
    else:
        column = WHATS.get(what, what)
        of, label = lambda own: estimate(mean(column), own), with_unit(column)
    limits = (-0.03, 1.03) if what in WHATS else None
    return curves(found, of, x, limits=limits, y_label=label, **how)


def _only(found, name, value):
    """The runs with a value in a column."""
    kept = found[name].map(lambda own: same(own, value))
    if not kept.any():
        there = ", ".join(map(str, found[name].unique()))
        raise Refused(f"where {name} = {value}: no run is left; must be one of {there}")
    return found[kept]


def _complete(found, what, columns):
    """The runs that have all that is drawn."""
    kept = found[columns].notna().all(axis=1)
    if OF_MAXIMUM & {*columns}:
        kept &= found.maximum_inside.eq(True)
    if "outcome" in found:
        kept &= found.outcome.ne(NEVER_MET)
    if what == "sticking":
        kept &= found.ended.astype(bool) & found.outcome.ne(UNDECIDED)
    return found[kept]


def _require_alike(found, distinguished, x):
    """Refused for runs of several kinds, and for those that differ in other parameters."""
    if found["kind"].nunique() > 1:
        raise Refused(f"the runs are of the kinds {', '.join(found['kind'].unique())}: choose where kind")
    others = [name for name in varied(found) if name not in distinguished]
    if others and x in parameters(found):
        raise Refused(differing(found, others, "choose by, over or where"))
