"""Parts of figures of many runs: panels with letters, colours of sizes, means over seeds with their errors."""

import numpy as np

from ..statistics import mean_and_error
from .style import new_figure

# What is ours is drawn in black, what is the paper's as dashed lines and open stars of this colour.
OURS, PAPER = "#111111", "#7b3fa0"
_SIZE_COLOURS = ("#2166ac", "#1b8a8f", "#e08214", "#8c5a2b", "#c62828")


def panels(rows, columns, width=5.2, height=4.2):
    """(figure, axes array (rows, columns))."""
    figure = new_figure(width * columns, height * rows, constrained_layout=True)
    return figure, figure.subplots(rows, columns, squeeze=False)


def size_colours(radii):
    """{radius [grain radii]: colour}: A24's 40 blue and 80 red, and every size of one colour in all figures; others lie
    between, or take the nearest end's."""
    places = np.linspace(40.0, 80.0, len(_SIZE_COLOURS))
    return {radius: _SIZE_COLOURS[int(np.argmin(np.abs(places - radius)))] for radius in sorted(set(radii))}


def letter(axes, text):
    """(a), (b), ... at the upper left of each of the axes, with `text` on the first."""
    flat = list(np.ravel(axes))
    for place, name in zip(flat, "abcdefgh"):
        place.set_title(f"({name})" if len(flat) > 1 else "", loc="left")
    flat[-1].set_title(text, loc="right", fontsize=10, color="0.3")


def legend(axes, **options):
    """Legend without a frame, where there is something to name."""
    if axes.get_legend_handles_labels()[0]:
        axes.legend(frameon=False, **options)


def scatter_of_seeds(axes, x, values, colour, label=None):
    """Small open diamonds for the runs at x, values (n,), and their mean with its standard error."""
    values = np.asarray(values, dtype=float)
    mean, error = mean_and_error(values)
    axes.plot(
        np.full(len(values), x), values, "D", markersize=4, markerfacecolor="none", color=colour, alpha=0.45, zorder=2
    )
    axes.errorbar(
        [x], [mean], yerr=[error or 0.0], fmt="D", color=colour, markersize=5.5, capsize=3, zorder=4, label=label
    )


def papers_star(axes, x, y, label=None, **options):
    """Open stars for a paper's values at x, y (floats or lists)."""
    axes.plot(x, y, "*", markersize=15, markerfacecolor="none", color=PAPER, label=label, **options)


def velocity_axis(axes, velocities):
    """Logarithmic axis of the collision velocity with plain numbers."""
    axes.set_xscale("log")
    low, high = min(velocities), max(velocities)
    axes.set_xlim(low / 1.12, high * 1.12)
    ticks = [
        t
        for t in (0.1, 0.2, 0.3, 0.5, 0.7, 1, 1.5, 2, 3, 4, 5, 7, 10, 15, 20, 30, 50, 100)
        if low / 1.12 <= t <= high * 1.12
    ]
    axes.set_xticks(ticks if len(ticks) > 1 else sorted({low, high}))
    axes.set_xticks([], minor=True)
    axes.xaxis.set_major_formatter(lambda value, _: f"{value:.3g}")
    axes.set_xlabel("collision velocity  [m/s]")
