"""The figures of studies: curves of estimates beside what a paper has, and states of collisions."""

from pathlib import Path

import numpy as np
from matplotlib.ticker import LogLocator, NullFormatter

from ..figures.collision import draw_view, reach
from ..figures.style import legend, letter, panels, styled
from ..runs.files import read_arrays
from ..runs.folder import State, open_run

COLOURS = ("#2166ac", "#e08214", "#1b8a8f", "#c62828", "#8c5a2b", "#d16ba5", "#111111")  # none the paper's
MARKERS = "osD^vP*"
HELD = 0.99  # of the grains: what flies farther than all but the last hundredth leaves a panel


@styled
def curves(
    runs,
    of,
    x,
    colour="",
    panel="",
    log="",
    paper=None,
    level=None,
    limits=None,
    line="-",
    x_label="",
    y_label="",
    palette=None,
):
    """Figure of estimates against a column of the table of runs, with standard errors; None where no point has a value.

    Parameters
    ----------
    runs : DataFrame
        With the column `pair`.
    of : callable
        From the runs of one point to its Estimate.
    x : str
        Column of the abscissa.
    colour, panel : str
        Columns of words that tell curves and panels apart, as the legend and titles show them; '': one of all.
    log : str
        Logarithmic axes: '', 'x', 'y' or 'xy'.
    paper : callable, optional
        (axes, the panel's word) -> None: draws what the paper has, in figures.style.PAPER.
    level : float, optional
        Where a thin line is drawn.
    limits : tuple, optional
        Of the ordinate, both.
    line : str
        '' where points are not joined.
    palette : dict, optional
        {word of `colour`: colour}.
    """
    by = [name for name in (panel, colour, x) if name]
    found = {key if isinstance(key, tuple) else (key,): of(own) for key, own in runs.groupby(by if len(by) > 1 else x)}
    found = {key: own for key, own in found.items() if np.isfinite(own.value) and not ("y" in log and own.value <= 0)}
    if not found:
        return None
    words = lambda name: list(dict.fromkeys(runs[name])) if name else [""]
    shown = [word for word in words(panel) if not panel or any(key[0] == word for key in found)]
    columns = min(len(shown), 3 if len(shown) > 4 else 4)
    figure, axes = panels(-(-len(shown) // columns), columns, 4.4, 3.8)
    flat = axes.ravel()
    for place in flat[len(shown) :]:
        place.set_axis_off()
    used = flat[: len(shown)]
    for place, word in zip(used, shown):
        for k, name in enumerate(words(colour)):
            head = tuple(own for own, named in ((word, panel), (name, colour)) if named)
            own = {key[-1]: point for key, point in found.items() if key[:-1] == head}
            if own:
                shade = palette[name] if palette else COLOURS[k % 7]
                points(place, list(own), list(own.values()), shade, name or None, MARKERS[k % 7], line)
        for name in log:
            getattr(place, f"set_{name}scale")("log")
        if level is not None:
            place.axhline(level, color="0.6", lw=0.8, zorder=0)
        if paper:
            paper(place, word)
        place.set_title(word, fontsize=10)
        place.set_xlabel(x_label or x)
    low, high = zip(*(place.get_ylim() for place in used))
    left, right = zip(*(place.get_xlim() for place in used))
    for place in used:
        place.set(xlim=(min(left), max(right)), ylim=limits or (min(low), max(high)))
        plain_ticks(place, log)
    for row in axes:
        row[0].set_ylabel(y_label)
    named = lambda place: len(place.get_legend_handles_labels()[1])
    fullest = max(flat, key=named)
    if named(fullest) > 1:
        legend(fullest, fontsize=8)
    letter(used, "")
    return figure


def points(axes, x, found, colour, label=None, marker="o", line=""):
    """Draw Estimates at x (K,) with their standard errors; open where an error is not known."""
    value, bars = np.array([own.value for own in found]), [own.error or 0.0 for own in found]
    known = np.array([own.error is not None for own in found])
    look = {"fmt": marker, "color": colour, "mfc": "white", "ms": 5, "capsize": 3}
    axes.errorbar(x, value, bars, label=label, **look)
    axes.plot(x, value, linestyle=line or "none", color=colour, lw=1.2)
    axes.plot(np.asarray(x)[known], value[known], marker, color=colour, ms=5, zorder=3)


def plain_ticks(axes, log):
    """Plain numbers at logarithmic axes, at 1, 2 and 5 where one spans less than two decades."""
    for axis in (getattr(axes, f"{name}axis") for name in log):
        low, high = axis.get_view_interval()
        axis.set_major_locator(LogLocator(subs=(1, 2, 5) if high < 50 * low else (1,)))
        axis.set_major_formatter(lambda number, _: f"{number:g}")
        axis.set_minor_formatter(NullFormatter())


@styled
def snapshots(runs, folder, title):
    """Figure of the runs of which a folder keeps states (RUN.npz), a row of panels each with its title(row of the
    table), or None: their states at these times where run folders are at hand, else those that are kept. Every panel
    has its own scale."""
    files = {file.stem: file for file in sorted(Path(folder).glob("*.npz"))}
    rows = [row for row in runs.itertuples() if row.run in files]
    if not rows:
        return None
    shown = [_states(row, files[row.run]) for row in rows]
    figure, axes = panels(len(rows), max(map(len, shown)), 2.7, 2.75)
    for places, row, states in zip(axes, rows, shown):
        for place, state in zip(places, states):
            state.position = state.position - state.position.mean(axis=0)
            half = 1.05 * reach(state, HELD) / row.grain_radius
            draw_view(place, state, row.grain_radius, half)
            bar = max(n * 10**k for n in (1, 2, 5) for k in range(5) if n * 10**k <= max(0.6 * half, 1))
            place.plot([-0.92 * half, -0.92 * half + bar], [-0.92 * half] * 2, color="0.1", lw=2.5)
            place.text(-0.92 * half, -0.88 * half, f"{bar:g} $r$", fontsize=8, va="bottom")
        for place in places[len(states) :]:
            place.set_axis_off()
        places[0].set_title(title(row), fontsize=9, loc="left")
    return figure


def _states(row, file):
    kept = read_arrays(file, ("time", "unit", "position", "radius", "aggregate"))
    if isinstance(row.folder, str):
        states = open_run(row.folder).states
        return [states[k] for k in sorted({states.nearest(time) for time in kept["time"]})]
    grains = {"radius": kept["radius"].astype(float), "aggregate": kept["aggregate"].astype(int)}
    positions = kept["position"] * float(kept["unit"])
    return [State(time, position=position, **grains) for time, position in zip(kept["time"], positions)]
