"""A column of a table of runs against another, with error bars over pairs of aggregates."""

import textwrap

import numpy as np
import pandas
from matplotlib import colormaps
from matplotlib.transforms import offset_copy
from scipy.stats import binomtest

from ..figures.style import legend, letter, panels, plain_ticks, styled
from ..measures.outcome import NEVER_MET, STICKING, UNDECIDED
from ..printable import suggested
from ..runs.format import CHANNELS, COLOURS, COMPRESSION
from ..runs.table import FOLDER
from .rows import at_end, differing, parameters, table, varied

LARGEST = "largest_fraction"
WHATS = {"sticking": ["outcome"], "largest": [LARGEST], "energy": [at_end(channel) for channel in CHANNELS]}
FILES = "file", "projectileFile"  # with the seed they distinguish pairs of aggregates
OF_MAXIMUM = {"d_max", "t_max"}
CURVES = ("#2166ac", "#1b8a8f", "#e08214", "#c62828", "#8c5a2b", "#d16ba5", "#111111")
MARKERS, LINES = "osD^vP", ("-", "--", "-.", ":")
APART, MOST_APART = 5.0, 20.0  # points between two curves, and between the first and the last
LETTERS = 13  # of a title, an inch of the figure


class CannotPlot(ValueError):
    """These runs cannot be drawn so; the message is one line."""


def exact_interval(successes, trials, confidence=0.95):
    """(low, high): the exact interval of a probability from independent trials (Clopper & Pearson 1934).

    >>> [round(bound, 4) for bound in exact_interval(5, 10)], exact_interval(0, 10)[0], exact_interval(10, 10)[1]
    ([0.1871, 0.8129], 0.0, 1.0)
    """
    interval = binomtest(int(successes), int(trials)).proportion_ci(confidence, method="exact")
    return float(interval.low), float(interval.high)


def plot(what, runs, x="velocity", by="", where=None, logarithmic=None):
    """Figure of many runs: a quantity against one of their columns, with error bars over pairs of aggregates.

    Pairs are told apart by their seed and files. Bars are standard errors of the mean over pairs; open points are
    single pairs. Of "sticking" they are exact 95 % intervals that count undecided runs, and those that have not
    ended, either way, and points are fractions of the decided runs; runs that never met are left out. So are runs
    without a value, or with a d_max that is only a bound; the title counts them.

    Parameters
    ----------
    what : str
        "sticking" (fraction of the runs that stick), "largest" (mass fraction of the largest piece), "energy" (change
        of every channel over K(0), of compressions over the boundaries' work; kinetic: what is left), or a column.
    runs : pandas.DataFrame, path, pattern, RunFolder or list of these
        A table(), or what that takes.
    x : str
        Column of numbers.
    by : str
        Column that distinguishes curves (of "energy" panels).
    where : dict, optional
        {column: value} of the runs that are drawn.
    logarithmic : str, optional
        Axes: "x", "y", "xy" or "". By default x if it spans a decade.

    Returns
    -------
    matplotlib.figure.Figure

    Raises
    ------
    CannotPlot
        A ValueError, also if runs differ in parameters beside x, by, the seed and the files.
    """
    found = runs if isinstance(runs, pandas.DataFrame) else table(runs)
    units, attributes = found.attrs.get("units", {}), found.attrs
    found = found.reset_index(drop=True)  # of tables put together
    found.attrs = attributes
    seed = "seed" if "seed" in found else FOLDER
    _require_columns(found, what, x, by, where or {}, seed)
    for name, value in (where or {}).items():
        found = _only(found, name, value)
    wanted, found = found, _complete(found, what, x, by)
    _require_drawable(found, what, x, by, seed)
    undecided = int(_undecided(found).sum())
    title = f"{len(found)} runs" + (f", {len(wanted) - len(found)} left out" if len(found) < len(wanted) else "")
    title += f", {undecided} undecided or not ended" if undecided else ""
    files = [name for name in FILES if name in found and found[name].notna().any()]
    found = found.assign(pair=found[[seed, *files]].astype(str).agg("|".join, axis=1))
    for name in filter(None, (x, by)):
        found[name] = found[name].map(_rounded)
    figure = _draw(found, what, x, by, _logarithmic(found, x, logarithmic), units)
    figure.suptitle("\n".join(textwrap.wrap(title, int(LETTERS * figure.get_figwidth()))), fontsize=10)
    return figure


def _require_columns(found, what, x, by, where, seed):
    if by == x:
        raise CannotPlot(f"by = {by}: must be another column than x")
    for name in (what, x, *([by] if by else []), *where):
        if name not in found and not (name == what and what in WHATS):
            names = (*WHATS, *found) if name == what else found
            raise CannotPlot(f"table of runs: no column {name}{suggested(name, names)}")
    own = [seed, "outcome", "ended", "kind"] + ["maximum_inside"] * bool(OF_MAXIMUM & {what, x, by})
    missing = [name for name in dict.fromkeys((*WHATS.get(what, ()), *own)) if name not in found]
    if missing:
        raise CannotPlot(f"table of runs: lacks {', '.join(missing)}; must be as analysis.table() gives it")


def _only(found, name, value):
    """The runs with a value in a column."""
    column = found[name]
    if column.dtype.kind in "fiu":
        if isinstance(value, str):
            raise CannotPlot(f"where {name} = {value}: must be a number")
        same = column.map(_rounded) == _rounded(float(value))
    else:
        same = column == value
    if not same.any():
        raise CannotPlot(
            f"where {name} = {value}: no run is left; must be one of {', '.join(map(str, column.unique()))}"
        )
    return found[same]


def _complete(found, what, x, by):
    """The runs that have all that is drawn."""
    kept = found[[x, *([by] if by else []), *WHATS.get(what, [what])]].notna().all(axis=1)
    if OF_MAXIMUM & {what, x, by}:
        kept &= found.maximum_inside.eq(True)
    if what == "sticking":
        kept &= found.outcome != NEVER_MET
    return found[kept]


def _require_drawable(found, what, x, by, seed):
    if not len(found):
        raise CannotPlot(f"no run has all of {', '.join(dict.fromkeys(filter(None, (what, x, by))))}")
    for name in [x, *([] if what in ("sticking", "energy") else WHATS.get(what, [what]))]:
        if found[name].dtype.kind not in "fiub":
            raise CannotPlot(f"{name}: holds words, or nothing; must be a column of numbers")
    if found["kind"].nunique() > 1:
        raise CannotPlot(f"the runs are of the kinds {', '.join(found['kind'].unique())}: choose where kind")
    others = [name for name in varied(found) if name not in (x, by, seed, *FILES)]
    if others and x in parameters(found):
        raise CannotPlot(differing(found, others, "choose by or where"))


def _undecided(found):
    """Whether runs have no outcome that counts (n,): they are undecided, or have not ended."""
    return found.outcome.map(lambda text: str(text).startswith(UNDECIDED)) | ~found.ended.astype(bool)


def _rounded(value):
    """Numbers that differ by rounding alone are one value of x."""
    return float(f"{value:.9g}") if isinstance(value, float) else value


def _logarithmic(found, x, wanted):
    if wanted in ("x", "y", "xy", ""):
        return wanted
    if wanted is not None:
        raise CannotPlot(f"logarithmic = {wanted}: must be x, y, xy or ''")
    low, high = found[x].min(), found[x].max()
    return "x" if low > 0 and high >= 10 * low else ""


def _sticking(found, x):
    """DataFrame by x of the fractions of the decided runs that stick, with exact intervals."""
    rows = {}
    for value, own in found.groupby(x):
        twice = own.pair.duplicated(keep=False)
        if twice.any():
            raise CannotPlot(f"{x} = {value}: a pair of aggregates has {twice.sum()} runs; must have one")
        undecided = _undecided(own)
        sticks, decided = int((own.outcome.eq(STICKING) & ~undecided).sum()), int((~undecided).sum())
        fraction = sticks / decided if decided else np.nan
        low, high = exact_interval(sticks, len(own))[0], exact_interval(sticks + undecided.sum(), len(own))[1]
        rows[value] = fraction, fraction - low, high - fraction, decided
    return _points(rows.values(), rows)


def _means(found, column, x, unit=1.0):
    """DataFrame by x of the means over pairs of a column, in a unit, with standard errors."""
    pairs = found.dropna(subset=[column]).groupby([x, "pair"])[column].mean().groupby(level=x)
    error = pairs.std() / np.sqrt(pairs.size()) / unit  # NaN for one pair
    return _points(zip(pairs.mean() / unit, error, error, pairs.size()), pairs.groups)


def _points(rows, x):
    return pandas.DataFrame(list(rows), list(x), ["value", "below", "above", "pairs"]).sort_index()


@styled
def _draw(found, what, x, by, logarithmic, units):
    """The Figure: one panel, or of energies one for each value of `by`."""
    parts = [("", found)]
    if what == "energy" and by:
        parts = [(f"{by} {_short(value)}, ", found[found[by] == value]) for value in sorted(found[by].unique())]
    columns = min(3, len(parts))
    figure, axes = panels(-(-len(parts) // columns), columns, 4.4, 3.8)
    places = axes.ravel()[: len(parts)]
    for place, (title, own) in zip(places, parts):
        curves = _energies(own, x) if what == "energy" else _curves(own, what, x, by)
        if not any(len(points) for *_, points in curves):
            raise CannotPlot(f"{what}: no run has a value")
        _draw_curves(place, curves, x in parameters(found), apart=what != "energy")
        if what == "energy" or not by:
            place.set_title(title + _pairs_text([n for *_, points in curves for n in points.pairs]), fontsize=10)
        for name in logarithmic:
            getattr(place, f"set_{name}scale")("log")
            plain_ticks(getattr(place, f"{name}axis"))
        place.set_xlabel(_with_unit(units, x))
        place.set_ylabel(_y_label(found, what, units))
        legend(place, fontsize=8)
    low, high = zip(*(place.get_ylim() for place in places))
    for place in places:
        place.set_ylim((-0.03, 1.03) if what in ("sticking", "largest") else (min(low), max(high)))
    for place in axes.ravel()[len(parts) :]:
        place.set_axis_off()
    letter(places, "")
    return figure


def _energies(found, x):
    """[(channel, colour, points in %)] of the channels that change."""
    changing = [channel for channel in CHANNELS if channel == "kinetic" or found[at_end(channel)].any()]
    return [(channel, COLOURS[channel], _means(found, at_end(channel), x, 0.01)) for channel in changing]


def _curves(found, what, x, by):
    """[(label, colour, points)] for each value of `by`, or of all runs."""
    measure = lambda own: _sticking(own, x) if what == "sticking" else _means(own, *WHATS.get(what, [what]), x)
    if not by:
        return [(None, CURVES[-1], measure(found))]
    values = sorted(found[by].unique())
    colours = CURVES if len(values) <= len(CURVES) else colormaps["plasma"](np.linspace(0.0, 0.85, len(values)))
    curves = [(value, colour, measure(found[found[by] == value])) for value, colour in zip(values, colours)]
    return [(f"{by} {_short(value)}, {_pairs_text(own.pairs)}", colour, own) for value, colour, own in curves]


def _draw_curves(axes, curves, joined, apart):
    """Curves, apart: beside each other and with different dashes, so that none hides an equal one."""
    for k, (label, colour, points) in enumerate(curves):
        aside = min(APART, MOST_APART / len(curves)) * (k - (len(curves) - 1) / 2) if apart else 0.0
        dashes = LINES[k % len(LINES)] if apart else "-"
        _draw_curve(axes, points, colour, label, MARKERS[k % len(MARKERS)], dashes if joined else "none", aside)


def _draw_curve(axes, points, colour, label, marker, line, aside):
    """Points with bars, open where the error is not known, moved by `aside` [points] so that none hides an equal
    one."""
    at, value = points.index.to_numpy(dtype=float), points.value.to_numpy()
    bars = points[["below", "above"]].to_numpy().T
    known = np.isfinite(bars).all(axis=0)
    bars = np.where(known, bars, 0.0)
    moved = {"transform": offset_copy(axes.transData, axes.figure, aside, units="points"), "color": colour}
    # Limits as if not moved: matplotlib 3.10.9 leaves out what is.
    for ends in (value - bars[0], value + bars[1]):
        axes.update_datalim(np.column_stack([at, ends])[np.isfinite(value)])
    axes.plot(at, value, linestyle=line, lw=1.2, **moved)
    axes.errorbar(at, value, bars, fmt=marker, capsize=3, markersize=5, mfc="white", label=label, **moved)
    axes.plot(at[known], value[known], marker, markersize=5, zorder=3, **moved)


def _pairs_text(numbers):
    """'4 pairs' or '2 to 4 pairs'."""
    fewest, most = min(numbers, default=0), max(numbers, default=0)
    return (f"{fewest:g} to " if fewest != most else "") + f"{most:g} pair{'s' * (most != 1)}"


def _short(value):
    return f"{value:g}" if isinstance(value, float) else str(value)


def _with_unit(units, name):
    unit = units.get(name, "")
    return name + (f"  [{unit}]" if unit not in ("", "1") else "")


def _y_label(found, what, units):
    of_work = (found["kind"] == COMPRESSION.name).all()
    return {
        "sticking": "runs that stick, of the decided ones",
        "largest": "mass of the largest piece, of all",
        "energy": "change, of the boundaries' work  [%]" if of_work else "change (kinetic: end), of K(0)  [%]",
    }.get(what) or _with_unit(units, what)
