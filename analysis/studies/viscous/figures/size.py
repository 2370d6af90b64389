"""What the size of the aggregates changes: v_fra and growth efficiency."""

import numpy as np

from ....figures.style import styled
from ...definition import StudyFigure
from .. import paper
from ..size_dependence import EXPONENTS, extrapolation_weight
from .common import PAPER, comparable, legend, letter, panels, threshold_points, time_colours, time_label

SHOWN = (50.0, 101.0)  # m/s: around v_fra


@styled
def size_figure(results):
    """v_fra against the size of the aggregates, for every T_vis, and against T_vis, for every size; over the same offsets."""
    results, offsets = comparable(results)
    known = [growth for growth in results.growth.values() if growth.v_fra is not None]
    if not known:
        return None
    figure, axes = panels(1, 2, 4.8, 4.2)
    colours = time_colours(results.table)
    for time, colour in colours.items():
        own = sorted((g for g in known if g.viscous_time == time), key=lambda growth: growth.grains)
        if own:
            threshold_points(axes[0, 0], [g.grains for g in own], own, colour, time_label(time))
    for i, grains in enumerate(results.sizes):
        own = [growth for growth in results.of_size(grains) if growth.v_fra is not None]
        if own:
            shade = str(0.7 - 0.6 * (i + 1) / len(results.sizes))
            x = [g.viscous_time * 1e12 for g in own]
            threshold_points(axes[0, 1], x, own, shade, f"{grains} grains")
    axes[0, 0].plot(
        [paper.GRAINS] * 2, paper.V_FRA, color=PAPER, lw=4, alpha=0.5, label="A22" + (", 13 offsets" if offsets else "")
    )
    axes[0, 0].set_xscale("log")
    axes[0, 0].set_xlabel("grains of an aggregate")
    axes[0, 1].set_xlabel("$T_{vis}$  [ps]")
    axes[0, 0].set_ylabel("$v_{fra}$  [m/s]")
    for place in axes[0]:
        legend(place, fontsize=8)
    letter(axes, offsets)
    return figure


@styled
def size_growth_figure(results):
    """<f_gro> (above) and f_gro at B_off = 0 (below) against N^-1/2 at the velocities around v_fra, with lines through the two
    smallest sizes to endless aggregates; over the same offsets; open where the error is not known."""
    every, (results, offsets) = results, comparable(results)
    velocities = sorted({round(v, 6) for growth in results.growth.values() for v in growth.velocities})
    velocities = [v for v in velocities if SHOWN[0] < v < SHOWN[1]]
    if len(results.sizes) < 2 or not velocities:
        return None
    figure, axes = panels(2, len(velocities), 3.4, 3.4)
    for row, curves, limit in ((axes[0], results.growth, 0.0), (axes[1], every.head_on, 1.0)):
        for place, velocity in zip(row, velocities):
            for time, colour in time_colours(every.table).items():
                _points_of_sizes(place, curves, time, velocity, colour)
            place.axhline(limit, color="0.6", lw=0.8)
            place.axvline(paper.GRAINS**-0.5, color=PAPER, lw=4, alpha=0.3)
            place.set_xlim(left=0.0)
    for place, velocity in zip(axes[0], velocities):
        place.set_title(f"{velocity:.3g} m/s", fontsize=10)
    for place in axes[1]:
        place.set_xlabel("$N^{-1/2}$")
    axes[0, 0].set_ylabel(r"$\langle f_{gro} \rangle$" + (f", {offsets}" if offsets else ""))
    axes[1, 0].set_ylabel("$f_{gro}$ at $B_{off}$ = 0")
    legend(axes[1, 0], fontsize=8, loc="lower left")
    return figure


def _points_of_sizes(place, curves, time, velocity, colour):
    """One T_vis of {(grains, T_vis): Curve} at one velocity: a point each size, and the line through the first two."""
    sizes = sorted({grains for grains, _ in curves})
    found = []
    for grains in sizes:
        at = curves[grains, time].at(velocity) if (grains, time) in curves else None
        if at is not None:
            found.append((grains, *at))
    if not found:
        return
    grains, mean, error = zip(*found)
    x, known = np.array(grains, dtype=float) ** -EXPONENTS[0], np.array([own is not None for own in error])
    for own, fill, label in ((known, colour, time_label(time)), (~known, "white", None)):
        values = (x[own], np.array(mean)[own], np.array([each or 0.0 for each in error])[own])
        place.errorbar(*values, fmt="o", color=colour, mfc=fill, capsize=3, label=label)
    if [*grains[:2]] == sizes[:2]:
        endless = mean[1] + extrapolation_weight(*grains[:2], np.inf, EXPONENTS[0]) * (mean[1] - mean[0])
        place.plot([x[0], 0.0], [mean[0], endless], "--", color=colour, lw=0.9)


FIGURES = (
    StudyFigure("size", "v_fra against size and T_vis.", size_figure),
    StudyFigure(
        "size_growth",
        "Growth efficiency against N^-1/2, mean over B_off (above) and head-on (below).",
        size_growth_figure,
    ),
)
