"""d_max, delta_max and tau_max against size: A24 Figs. 5, 6, 7."""

import numpy as np

from ....figures.style import NANO, styled
from ....theory.andrews import Spheres, elastic_time, plastic_time, stress_if_rigid, young_if_elastic
from ...definition import StudyFigure
from .. import paper
from ..velocity_fit import effective, reduced_radius
from .common import (
    ELASTIC,
    OURS,
    PAPER,
    RIGID,
    filling_text,
    is_papers_velocity,
    legend,
    letter,
    of_main_filling,
    of_other_filling,
    panels,
    scatter_of_seeds,
)

_RED = "#c62828"


def size_points(results, filling):
    """(radius [grain radii], d_max (n,) [grain radii], t_max (n,) [s]) of the sizes at the velocity of the
    size fit."""
    points = filling.points
    for k in np.flatnonzero(points.velocity == filling.size_fit.velocity):
        d_max, t_max = points.samples[k]
        yield points.radius[k] / results.grain_radius, d_max / results.grain_radius, t_max


@styled
def size_figure(results, filling):
    """d_max against R with the line, and delta_max against R* where there is an offset: Figs. 5, 6."""
    fit, unit = filling.size_fit, results.grain_radius
    theirs = paper.line(filling.factor) if is_papers_velocity(fit.velocity) else None
    sizes = list(size_points(results, filling))
    figure, axes = panels(1, 2)
    left, right = axes[0]
    radii = np.array([0.0, 1.08 * max(max(radius for radius, *_ in sizes), 80.0 if theirs else 0.0)])
    for radius, d_max, _ in sizes:
        scatter_of_seeds(left, radius, d_max, _RED)
    if fit.reason is None:
        left.plot(
            radii,
            fit.values["c1"] * radii - fit.values["c2"],
            color=OURS,
            label=f"fit: $c_1$ = {fit.values['c1']:.4f}, $c_2$ = {fit.values['c2']:.3f}",
        )
    if theirs:
        left.plot(
            radii,
            theirs[0] * radii - theirs[1],
            "--",
            color=PAPER,
            label=f"A24: $c_1$ = {theirs[0]:.4f}, $c_2$ = {theirs[1]:.3f}",
        )
    left.set_xlabel("aggregate radius $R$  [grain radii]")
    left.set_ylabel("largest compression length $d_{max}$  [grain radii]")
    if filling.offset is not None:
        _draw_effective(right, filling, theirs, sizes, unit, radii)
    else:
        right.set_axis_off()
    for place in (left, right):
        place.set_xlim(0.0, None)
        place.set_ylim(min(0.0, place.get_ylim()[0]), None)
        legend(place, loc="upper left")
    letter(axes, filling_text(filling.factor, fit.velocity))
    return figure


def _draw_effective(axes, filling, theirs, sizes, unit, radii):
    offset = filling.offset / unit
    for radius, d_max, _ in sizes:
        scatter_of_seeds(axes, reduced_radius(radius, offset), d_max + 2.0 * offset, _RED)
    half = 0.5 * radii
    if filling.size_fit.reason is None:
        ratio = filling.size_fit.values["ratio"]
        axes.plot(
            half, ratio * half, color=OURS, label=f"fit: {ratio:.4f} $R^*$, $\\delta_{{offset}}$ = {offset:.3f} $r$"
        )
    if theirs:
        axes.plot(
            half,
            2.0 * theirs[0] * half,
            "--",
            color=PAPER,
            label=f"A24: {paper.RATIO[filling.factor]:g} $R^*$, $\\delta_{{offset}}$ = "
            f"{paper.OFFSET[filling.factor]:g} $r$",
        )
    axes.set_xlabel("reduced radius $R^*$  [grain radii]")
    axes.set_ylabel("largest compression $\\delta_{max}$  [grain radii]")


@styled
def time_figure(results, filling):
    """tau_max against R* with the elastic and the rigid-plastic limit of the ratio delta_max/R*: Fig. 7."""
    fit, unit = filling.size_fit, results.grain_radius
    figure, axes = panels(1, 1, 6.0, 4.6)
    place = axes[0, 0]
    largest = 0.0
    for radius, d_max, t_max in size_points(results, filling):
        tau = effective(d_max * unit, t_max, fit.velocity, filling.offset, unit)[1]
        half = reduced_radius(radius, filling.offset / unit)
        scatter_of_seeds(place, half, tau * NANO, _RED)
        largest = max(largest, half)
    line = np.array([0.0, 1.08 * largest])
    if fit.ratio is not None:
        _draw_limits(place, line, fit.ratio, fit.velocity, filling, results, unit, "our")
    if filling.factor in paper.RATIO and is_papers_velocity(fit.velocity):
        _draw_limits(place, line, paper.RATIO[filling.factor], fit.velocity, filling, results, unit, "A24's")
    place.set_xlim(0.0, None)
    place.set_ylim(0.0, None)
    place.set_xlabel("reduced radius $R^*$  [grain radii]")
    place.set_ylabel("time to the largest compression $\\tau_{max}$  [ns]")
    legend(place)
    letter(axes, filling_text(filling.factor, fit.velocity))
    return figure


def _draw_limits(axes, line, ratio, velocity, filling, results, unit, whose):
    density = filling.factor * results.grain_density
    young = young_if_elastic(ratio, velocity, density)
    sigma = stress_if_rigid(ratio, velocity, density)
    style = "--" if whose == "A24's" else "-"
    for time, colour, name in ((elastic_time, ELASTIC, "elastic"), (plastic_time, RIGID, "rigid plastic")):
        slope = float(time(velocity, Spheres(1.0, density, sigma, young)))
        axes.plot(
            line,
            slope * line * unit * NANO,
            style,
            color=colour,
            label=f"{name}, {whose} $\\delta_{{max}}/R^*$ = {ratio:.3g}",
        )


FIGURES = (
    StudyFigure("fig05_size", "A24 Fig. 5: largest compression against size.", of_main_filling(size_figure, False)),
    StudyFigure("fig06_size", "A24 Fig. 6: the same at the other filling.", of_other_filling(size_figure, False)),
    StudyFigure(
        "fig07_time", "A24 Fig. 7: time to the largest compression against size.", of_main_filling(time_figure)
    ),
)
