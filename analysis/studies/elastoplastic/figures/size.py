"""d_max and t_max against size: A24 Figs. 5, 6, 7. What was measured is plotted, and each curve has its own delta_offset:
delta_max and tau_max of two papers with two offsets don't belong on one axis."""

import numpy as np

from ....figures.style import NANO, styled
from ....theory.andrews import stress_if_rigid, young_if_elastic
from ...definition import StudyFigure
from .. import paper
from ..beside_model import papers_model
from ..lines import paper_line_at
from ..velocity_fit import predicted
from .common import (
    ELASTIC,
    FILLING_COLOURS,
    MEGA,
    OURS,
    PAPER,
    RIGID,
    filling_text,
    fit_text,
    is_papers_velocity,
    legend,
    letter,
    of_main_filling,
    of_other_filling,
    panels,
    scatter_of_seeds,
    size_colours,
)


def size_points(results, filling):
    """(radius [grain radii], d_max (n,) [grain radii], t_max (n,) [s]) of the sizes at the velocity of the size fit."""
    points = filling.points
    for k in np.flatnonzero(points.velocity == filling.size_fit.velocity):
        d_max, t_max = points.samples[k]
        yield points.radius[k] / results.grain_radius, d_max / results.grain_radius, t_max


@styled
def size_figure(results, filling):
    """(a) d_max against R with both lines, (b) the same less A24's line, with the error that line should have: Figs. 5, 6."""
    fit = filling.size_fit
    theirs = paper.line(filling.factor) if is_papers_velocity(fit.velocity) else None
    sizes = list(size_points(results, filling))
    figure, axes = panels(1, 2)
    left, right = axes[0]
    radii = np.linspace(0.0, 1.08 * max(max(radius for radius, *_ in sizes), 80.0 if theirs else 0.0), 60)
    colours = size_colours(radius for radius, *_ in sizes)
    for radius, d_max, _ in sizes:
        scatter_of_seeds(left, radius, d_max, colours[radius])
    if fit.reason is None:
        label = f"fit: $c_1$ = {fit.values['c1']:.4f}, $c_2$ = {fit.values['c2']:.3f}"
        left.plot(radii, fit.values["c1"] * radii - fit.values["c2"], color=OURS, label=label)
    if theirs:
        label = f"A24: $c_1$ = {theirs[0]:.4f}, $c_2$ = {theirs[1]:.3f}"
        left.plot(radii, theirs[0] * radii - theirs[1], "--", color=PAPER, label=label)
        _draw_difference(right, filling, theirs, sizes, radii[radii > 30.0], colours)
    else:
        right.set_axis_off()
    left.set_ylabel("largest compression length $d_{max}$  [grain radii]")
    left.set_xlim(0.0, None)
    left.set_ylim(min(0.0, left.get_ylim()[0]), None)
    for place in (left, right):
        place.set_xlabel("aggregate radius $R$  [grain radii]")
        legend(place, loc="upper left", fontsize=9)
    letter(axes, filling_text(filling.factor, fit.velocity))
    return figure


def _draw_difference(axes, filling, theirs, sizes, radii, colours):
    """d_max less A24's line."""
    for radius, d_max, _ in sizes:
        scatter_of_seeds(axes, radius, d_max - (theirs[0] * radius - theirs[1]), colours[radius])
    error = paper_line_at(filling, radii)[1]
    axes.axhline(0.0, color=PAPER, linestyle="--", label="A24's line")
    if error is not None:
        axes.fill_between(
            radii, -error, error, color=PAPER, alpha=0.15, linewidth=0, label="its error, with our scatter"
        )
    if filling.size_fit.reason is None:
        own = filling.size_fit.values
        axes.plot(radii, (own["c1"] - theirs[0]) * radii - own["c2"] + theirs[1], color=OURS, label="fit")
    for each in filling.adjusted:
        value = each.adjusted - (theirs[0] * each.radius - theirs[1])
        label = "adjusted for the zones that meet" if each is filling.adjusted[0] else None
        options = {"fmt": "s", "capsize": 3, "markerfacecolor": "none", "color": OURS, "label": label}
        axes.errorbar([each.radius + 1.2], [value], yerr=[each.adjusted_error], **options)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.35 * (high - low))
    axes.set_ylabel("$d_{max}$ less A24's line  [grain radii]")


@styled
def time_figure(results, filling):
    """(a) t_max against R with fits and limits, each with the delta_offset that belongs to it: Fig. 7; (b) t_max less A24's
    fitted model, every filling that A24 fits."""
    fit, unit = filling.size_fit, results.grain_radius
    figure, axes = panels(1, 2, 5.6, 4.6)
    place = axes[0, 0]
    sizes = list(size_points(results, filling))
    colours = size_colours(radius for radius, *_ in sizes)
    for radius, _, t_max in sizes:
        scatter_of_seeds(place, radius, t_max * NANO, colours[radius])
    radii = np.linspace(0.0, 1.08 * max(radius for radius, *_ in sizes), 30)
    for moduli, offset, colour, style, label in _models(results, filling):
        density = filling.factor * results.grain_density
        _, t = predicted(fit.velocity, radii * unit, unit, density, *moduli, offset)
        place.plot(radii, t * NANO, style, color=colour, label=label)
    place.set_xlim(0.0, None)
    place.set_ylim(0.0, None)
    place.set_xlabel("aggregate radius $R$  [grain radii]")
    place.set_ylabel("time of the largest compression $t_{max}$  [ns]")
    legend(place, fontsize=8)
    _draw_lateness(axes[0, 1], results)
    letter(axes, f"{fit.velocity:.4g} m/s")
    place.set_title(filling_text(filling.factor), loc="right", fontsize=10, color="0.3")
    return figure


def _draw_lateness(axes, results):
    """t_max less A24's model against R, and the same adjusted for the zones that meet."""
    axes.axhline(0.0, color=PAPER, linestyle="--", label="A24's model")
    factors = [factor for factor in results.by_filling if factor in paper.YOUNG]
    for shift, factor, colour in zip((-0.5, 0.5), factors, FILLING_COLOURS):
        filling = results.by_filling[factor]
        for number, (radius, _, t_max) in enumerate(size_points(results, filling)):
            later = (t_max - papers_model(results, filling, radius, filling.size_fit.velocity)[1]) * NANO
            scatter_of_seeds(axes, radius + shift, later, colour, None if number else f"filling {factor:g}")
        for number, each in enumerate(filling.zone_times[1]):
            model = papers_model(results, filling, each.radius, filling.size_fit.velocity)[1] * NANO
            options = {"fmt": "s", "capsize": 3, "markerfacecolor": "none", "color": colour}
            label = None if number else f"filling {factor:g}, adjusted for the zones that meet"
            place = [each.radius + shift + 1.5], [each.adjusted - model]
            axes.errorbar(*place, yerr=[each.adjusted_error], label=label, **options)
    low, high = axes.get_ylim()
    axes.set_ylim(low, high + 0.3 * (high - low))
    axes.set_xlabel("aggregate radius $R$  [grain radii]")
    axes.set_ylabel("$t_{max}$ less A24's model  [ns]")
    legend(axes, loc="upper left", fontsize=8.5)


def _models(results, filling):
    """(moduli [Pa], offset [m], colour, style, label)."""
    fit, unit, factor = filling.size_fit, results.grain_radius, filling.factor
    density = factor * results.grain_density
    if filling.joint.reason is None:
        *moduli, offset = filling.joint.values
        text = fit_text(filling.joint.values, filling.joint.limits)
        yield moduli, offset * unit, OURS, "-", f"our fit to all runs: {text}"
    if factor in paper.YOUNG and is_papers_velocity(fit.velocity):
        moduli, offset = (paper.YIELD_STRESS[factor], paper.YOUNG[factor]), paper.OFFSET[factor]
        text = f"A24's fit: {moduli[0] / MEGA:g}, {moduli[1] / MEGA:g} MPa, {offset:g} $r$"
        yield moduli, offset * unit, PAPER, "--", text
    ratios = [(fit.ratio, filling.offset, "-", "our")]
    if factor in paper.RATIO and is_papers_velocity(fit.velocity):
        ratios.append((paper.RATIO[factor], paper.OFFSET[factor] * unit, ":", "A24's"))
    for ratio, offset, style, whose in ratios:
        if ratio is not None and offset is not None:
            name = f"{whose} $\\delta_{{max}}/R^*$ = {ratio:.3g}, {offset / unit:.2f} $r$"
            yield (np.inf, young_if_elastic(ratio, fit.velocity, density)), offset, ELASTIC, style, f"elastic, {name}"
            sigma = stress_if_rigid(ratio, fit.velocity, density)
            yield (sigma, np.inf), offset, RIGID, style, f"rigid plastic, {name}"


FIGURES = (
    StudyFigure("fig05_size", "A24 Fig. 5: largest compression against size.", of_main_filling(size_figure, False)),
    StudyFigure("fig06_size", "A24 Fig. 6: the same at the other filling.", of_other_filling(size_figure, False)),
    StudyFigure(
        "fig07_time", "A24 Fig. 7: time of the largest compression against size.", of_main_filling(time_figure)
    ),
)
