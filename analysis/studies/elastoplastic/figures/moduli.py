"""Pairs of yield stress and E* that give one largest compression: A24 Fig. 10."""

import numpy as np

from ....figures.panels import papers_star
from ....figures.style import styled
from ...definition import StudyFigure
from .. import paper
from ..velocity_fit import degenerate_curve
from .common import MEGA, OURS, PAPER, filling_text, legend, panels


@styled
def moduli_figure(results):
    """Pairs (sigma_plastic, E*) that give the measured delta_max/R*, with its error, and the best fits: Fig. 10. Our fit is that
    of joint_fit, with its 95 % limits; where E* has no upper one, an arrow."""
    fillings = list(results.by_filling.values())
    figure, axes = panels(1, len(fillings), 5.4, 4.6)
    for place, filling in zip(axes[0], fillings):
        density = filling.factor * results.grain_density
        _draw_ours(place, filling.size_fit, density)
        if filling.factor in paper.RATIO:
            _draw_papers(place, filling.factor, density)
        place.set_xlabel("yield stress $\\sigma_{plastic}$  [MPa]")
        place.set_ylabel("reduced Young's modulus $E^*$  [MPa]")
        place.set_yscale("log")
        place.set_xlim(0.0, None)
        if filling.joint.reason is None and np.isfinite(filling.joint.limits[1][0]):
            place.set_ylim(min(place.get_ylim()[0], 0.8 * filling.joint.limits[1][0] / MEGA), None)
        _tick(place)
        _draw_fit(place, filling.joint)
        legend(place, loc="upper right")
        place.set_title(filling_text(filling.factor), loc="right", fontsize=10, color="0.3")
    return figure


def _draw_ours(axes, fit, density):
    if fit.ratio is None:
        return
    ratio, error = fit.ratio, fit.errors["ratio"] or 0.0
    label = f"$\\delta_{{max}}/R^*$ = {ratio:.4f} $\\pm$ {error:.4f}"
    _draw_curve(axes, ratio, fit.velocity, density, OURS, "-", label)
    for other in (max(ratio - error, 0.5 * ratio), ratio + error):
        _draw_curve(axes, other, fit.velocity, density, "0.6", "-", None)


def _draw_papers(axes, factor, density):
    ratio = paper.RATIO[factor]
    _draw_curve(axes, ratio, paper.VELOCITY, density, PAPER, "--", f"A24: {ratio:g}")
    papers_star(axes, paper.YIELD_STRESS[factor] / MEGA, paper.YOUNG[factor] / MEGA, "A24's fit", zorder=5)


def _tick(axes):
    """Plain numbers at 1, 2, 5 times powers of ten, as many as the axis holds."""
    low, high = axes.get_ylim()
    steps = [f * 10.0**n for n in range(-3, 7) for f in (1, 2, 5)]
    axes.set_yticks([step for step in steps if low <= step <= high])
    axes.set_yticks([], minor=True)
    axes.set_ylim(low, high)
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")


def _draw_fit(axes, fit):
    """Best fit with its 95 % limits; an arrow where E* has no upper one."""
    if fit.reason or not np.isfinite(fit.values[0]):
        return
    (sigma, young, _), limits = fit.values, np.array(fit.limits[:2]) / MEGA
    sigma, young, top = sigma / MEGA, young / MEGA, axes.get_ylim()[1]
    place = min(young, 0.55 * top)
    label, colour = "fit to all runs, 95 % limits", "#c62828"
    across = [[sigma - limits[0, 0]], [min(limits[0, 1], axes.get_xlim()[1]) - sigma]]
    axes.errorbar([sigma], [place], xerr=across, fmt="*", markersize=13, color=colour, capsize=3, label=label, zorder=6)
    high = limits[1, 1]
    axes.vlines(sigma, limits[1, 0], min(high, 0.85 * top), color=colour, linewidth=1.5, zorder=5)
    axes.plot([sigma], [limits[1, 0]], "_", color=colour, markersize=9, zorder=5)
    if high < 0.85 * top:
        axes.plot([sigma], [high], "_", color=colour, markersize=9, zorder=5)
    else:
        options = {"arrowstyle": "-|>", "color": colour, "linewidth": 1.5}
        axes.annotate("", (sigma, top), (sigma, 0.6 * top), arrowprops=options, zorder=6)


def _draw_curve(axes, ratio, velocity, density, colour, style, label):
    sigma, young, elastic_from, elastic_young = degenerate_curve(ratio, velocity, density)
    seen = young < 30.0 * elastic_young
    axes.plot(sigma[seen] / MEGA, young[seen] / MEGA, style, color=colour, label=label, linewidth=1.6 if label else 0.8)
    axes.plot(
        [elastic_from / MEGA, 1.5 * elastic_from / MEGA], [elastic_young / MEGA] * 2, style, color=colour, linewidth=0.9
    )


FIGURES = (
    StudyFigure(
        "fig10_moduli",
        "A24 Fig. 10: pairs of yield stress and E* that give one largest compression.",
        moduli_figure,
    ),
)
