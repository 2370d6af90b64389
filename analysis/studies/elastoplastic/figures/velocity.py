"""delta_max and tau_max against velocity: A24 Figs. 8, 9."""

import numpy as np

from ....figures.style import NANO, styled
from ....theory.andrews import (
    Spheres,
    elastic_compression,
    elastic_time,
    largest_compression,
    plastic_compression,
    plastic_time,
    stress_if_rigid,
    time_of_largest_compression,
    young_if_elastic,
)
from ...definition import StudyFigure
from .. import paper
from ..velocity_fit import effective, reduced_radius
from .common import (
    ELASTIC,
    MEGA,
    OURS,
    PAPER,
    RIGID,
    filling_text,
    legend,
    letter,
    of_main_filling,
    of_other_filling,
    panels,
    scatter_of_seeds,
    size_colours,
    velocity_axis,
)


@styled
def velocity_figure(results, filling):
    """delta_max/r and tau_max of all runs against velocity, the best fits, and the limits that give the same
    delta_max as our fit (or A24's) at A24's velocity: Figs. 8, 9."""
    points, unit = filling.points, results.grain_radius
    radii = sorted({round(float(radius / unit), 3) for radius in points.radius})
    shown = [radius for radius in radii if np.sum(np.isclose(points.radius / unit, radius)) > 1] or radii
    colours = size_colours(shown)
    figure, axes = panels(1, 2, 5.6, 4.8)
    left, right = axes[0]
    named = set()
    for k in range(len(points)):
        radius = round(float(points.radius[k] / unit), 3)
        if radius not in colours:
            continue
        delta, tau = effective(*points.samples[k], points.velocity[k], filling.offset, unit)
        label = None if radius in named else f"$R$ = {radius:g} $r$"
        named.add(radius)
        scatter_of_seeds(left, points.velocity[k], delta / unit, colours[radius], label)
        scatter_of_seeds(right, points.velocity[k], tau * NANO, colours[radius])
    v = np.geomspace(points.velocity.min() / 1.1, points.velocity.max() * 1.1, 120)
    for radius in (min(shown), max(shown)) if len(shown) > 1 else shown:
        _draw_models(left, right, v, results, filling, radius, radius == max(shown))
    velocity_axis(left, points.velocity)
    velocity_axis(right, points.velocity)
    means = (points.d_max + 2.0 * filling.offset) / unit
    if np.any(means > 0):
        left.set_yscale("log")
        left.set_ylim(0.5 * means[means > 0].min(), 2.0 * means.max())
        low, high = left.get_ylim()
        left.set_yticks([t for t in (0.05, 0.1, 0.2, 0.5, 1, 2, 3, 5, 10, 20, 50) if low <= t <= high])
        left.set_yticks([], minor=True)
        left.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    right.set_ylim(0.0, None)
    left.set_ylabel("largest compression $\\delta_{max}$  [grain radii]")
    right.set_ylabel("time to it $\\tau_{max}$  [ns]")
    legend(left, fontsize=8)
    letter(axes, filling_text(filling.factor))
    return figure


def _draw_models(left, right, v, results, filling, radius, named):
    """Curves of both panels for one size; their labels only once."""
    half = reduced_radius(radius * results.grain_radius, filling.offset)
    for delta, tau, colour, style, label in _curves(v, results, filling, half):
        left.plot(v, delta / results.grain_radius, style, color=colour, linewidth=1.4, label=label if named else None)
        right.plot(v, tau * NANO, style, color=colour, linewidth=1.4)


def _curves(v, results, filling, half):
    """(delta_max [m], tau_max [s], colour, style, label) of each model at velocities v and R* = half [m]."""
    density, fit = filling.factor * results.grain_density, filling.velocity_fit
    if fit.reason is None:
        label = f"fit: {fit.values[0] / MEGA:.3g}, {fit.values[1] / MEGA:.3g} MPa"
        yield *_motion(v, Spheres(half, density, *fit.values)), OURS, "-", label
    if filling.factor in paper.YOUNG:
        theirs = paper.YIELD_STRESS[filling.factor], paper.YOUNG[filling.factor]
        label = f"A24: {theirs[0] / MEGA:g}, {theirs[1] / MEGA:g} MPa"
        yield *_motion(v, Spheres(half, density, *theirs)), PAPER, "--", label
    ratio, anchor = filling.size_fit.ratio, filling.size_fit.velocity
    if ratio is None:
        ratio, anchor = paper.RATIO.get(filling.factor), paper.VELOCITY
    if ratio is not None:
        limit = Spheres(
            half, density, stress_if_rigid(ratio, anchor, density), young_if_elastic(ratio, anchor, density)
        )
        yield elastic_compression(v, limit), elastic_time(v, limit), ELASTIC, ":", "elastic"
        rigid_time = np.broadcast_to(plastic_time(v, limit), v.shape)
        yield plastic_compression(v, limit), rigid_time, RIGID, "-.", "rigid plastic"


def _motion(v, spheres):
    return largest_compression(v, spheres), time_of_largest_compression(v, spheres)


FIGURES = (
    StudyFigure(
        "fig08_velocity",
        "A24 Fig. 8: largest compression and its time against velocity.",
        of_main_filling(velocity_figure),
    ),
    StudyFigure("fig09_velocity", "A24 Fig. 9: the same at the other filling.", of_other_filling(velocity_figure)),
)
