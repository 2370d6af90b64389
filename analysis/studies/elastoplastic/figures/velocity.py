"""d_max and t_max against velocity: A24 Figs. 8, 9; each curve with its own delta_offset."""

import numpy as np

from ....figures.style import NANO, styled
from ....theory.andrews import stress_if_rigid, young_if_elastic
from ...definition import StudyFigure
from .. import paper
from ..velocity_fit import predicted
from .common import (
    ELASTIC,
    MEGA,
    OURS,
    PAPER,
    RIGID,
    filling_text,
    fit_text,
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
    """d_max and t_max of all runs against velocity, the best fits, and the limits that give the d_max of our size fit (or
    A24's) at A24's velocity: Figs. 8, 9. Against the logarithm of the velocity, d_max in proportion to it, since it comes
    near 0 where it is smaller than twice delta_offset."""
    points, unit = filling.points, results.grain_radius
    radii = sorted({round(float(radius / unit), 3) for radius in points.radius})
    shown = [radius for radius in radii if np.sum(np.isclose(points.radius / unit, radius)) > 1] or radii
    colours = size_colours(shown)
    figure, axes = panels(1, 2, 5.8, 5.0)
    left, right = axes[0]
    named = set()
    for k in range(len(points)):
        radius = round(float(points.radius[k] / unit), 3)
        if radius not in colours:
            continue
        d, t = points.samples[k]
        label = None if radius in named else f"$R$ = {radius:g} $r$"
        named.add(radius)
        scatter_of_seeds(left, points.velocity[k], d / unit / points.velocity[k], colours[radius], label)
        scatter_of_seeds(right, points.velocity[k], t * NANO, colours[radius])
    v = np.geomspace(points.velocity.min() / 1.1, points.velocity.max() * 1.1, 120)
    for radius in (min(shown), max(shown)) if len(shown) > 1 else shown:
        for moduli, offset, colour, style, label in _models(results, filling):
            density = filling.factor * results.grain_density
            d, t = predicted(v, radius * unit, unit, density, *moduli, offset)
            named_now = label if radius == max(shown) else None
            left.plot(v, d / unit / v, style, color=colour, linewidth=1.4, label=named_now)
            right.plot(v, t * NANO, style, color=colour, linewidth=1.4)
    velocity_axis(left, points.velocity)
    velocity_axis(right, points.velocity)
    low, high = left.get_ylim()
    left.set_ylim(low, high + 0.45 * (high - low))
    right.set_ylim(0.0, None)
    left.set_ylabel("$d_{max}$ over velocity  [grain radii per m/s]")
    right.set_ylabel("time of the largest compression $t_{max}$  [ns]")
    legend(left, fontsize=8, loc="upper left")
    letter(axes, filling_text(filling.factor))
    return figure


def _models(results, filling):
    """(moduli [Pa], offset [m], colour, style, label) of each model."""
    factor, unit = filling.factor, results.grain_radius
    density, joint = factor * results.grain_density, filling.joint
    if joint.reason is None:
        *moduli, offset = joint.values
        yield moduli, offset * unit, OURS, "-", f"fit to all runs: {fit_text(joint.values, joint.limits)}"
    if factor in paper.YOUNG:
        moduli, offset = (paper.YIELD_STRESS[factor], paper.YOUNG[factor]), paper.OFFSET[factor]
        label = f"A24: {moduli[0] / MEGA:g}, {moduli[1] / MEGA:g} MPa, {offset:g} $r$"
        yield moduli, offset * unit, PAPER, "--", label
    ratio, anchor = filling.size_fit.ratio, filling.size_fit.velocity
    if ratio is None:
        ratio, anchor = paper.RATIO.get(factor), paper.VELOCITY
    if ratio is not None:
        name = f"$\\delta_{{max}}/R^*$ = {ratio:.3g}, {filling.offset / unit:.2f} $r$"
        yield (np.inf, young_if_elastic(ratio, anchor, density)), filling.offset, ELASTIC, ":", f"elastic, {name}"
        yield (stress_if_rigid(ratio, anchor, density), np.inf), filling.offset, RIGID, "-.", f"rigid plastic, {name}"


FIGURES = (
    StudyFigure(
        "fig08_velocity",
        "A24 Fig. 8: largest compression and its time against velocity.",
        of_main_filling(velocity_figure),
    ),
    StudyFigure("fig09_velocity", "A24 Fig. 9: the same at the other filling.", of_other_filling(velocity_figure)),
)
