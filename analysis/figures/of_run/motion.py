"""Compression length and mutual velocity against time, as Fig. 4 of Arakawa et al. (2024, A24)."""

import numpy as np

from ...measures.of_run import are_equal, maximum_of_run
from ...runs.files import RunFolderError
from ...runs.format import COLLISION, HISTORY_FILE
from ..style import NANO, new_figure, run_title, styled


@styled
def motion_figure(run):
    """Figure of d (in grain radii) and v (m/s) against time (ns), with the largest compression marked (A24
    eqs 10-13)."""
    history, grain_radius = run.history, run.derived["grainRadius"]
    maximum = maximum_of_run(run)
    if maximum is None:
        raise RunFolderError(f"{run.path / HISTORY_FILE}: d and v have no value at any time: all grains on one side")
    time = history["time"] * NANO
    figure = new_figure(7.0, 6.6, constrained_layout=True)
    upper, lower = figure.subplots(2, 1, sharex=True)
    upper.plot(time, history["d"] / grain_radius, color="#c62828")
    lower.plot(time, history["v"], color="#c62828")
    for axes in (upper, lower):
        axes.axhline(0.0, color="0.75", linewidth=0.8, zorder=0)
        axes.axvline(maximum.time * NANO, color="0.45", linewidth=1.0, linestyle=(0, (4, 3)), zorder=0)
    _mark(upper, maximum, grain_radius, history["d"])
    upper.set_ylabel("compression length $d$  [grain radii]")
    lower.set_ylabel("mutual velocity $v$  [m/s]")
    lower.set_xlabel("time $t$  [ns]")
    lower.set_xlim(time[0], time[-1] if time.size > 1 else time[0] + 1.0)
    for axes, letter in ((upper, "a"), (lower, "b")):
        axes.set_title(f"({letter})", loc="left")
    upper.set_title(run_title(run), loc="right", fontsize=10, color="0.3")
    return figure


FIGURE, KINDS, HAS_MEANING = motion_figure, (COLLISION.name,), are_equal


def _mark(axes, maximum, grain_radius, d):
    top = maximum.length / grain_radius
    axes.plot([maximum.time * NANO], [top], "o", color="black", markersize=5, zorder=3)
    low = np.nanmin(d) / grain_radius
    # Room above the curve for the label, which would otherwise lie on it.
    axes.set_ylim(low - 0.06 * (top - low), top + 0.28 * (top - low) if top > low else top + 1.0)
    bound = "" if maximum.inside else " (largest so far)"
    late = maximum.time * NANO > 0.6 * axes.dataLim.x1
    axes.annotate(
        f"$d_{{max}}$ = {top:.3f} $r$ at {maximum.time * NANO:.1f} ns{bound}",
        (maximum.time * NANO, top),
        xytext=(-6 if late else 6, 9),
        textcoords="offset points",
        ha="right" if late else "left",
        va="bottom",
    )
