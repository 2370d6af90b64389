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
    """Pairs (sigma_plastic, E*) that give the measured delta_max/R*, with its error, and the best fits: Fig. 10."""
    fillings = list(results.by_filling.values())
    figure, axes = panels(1, len(fillings), 5.4, 4.6)
    for place, filling in zip(axes[0], fillings):
        density = filling.factor * results.grain_density
        _draw_ours(place, filling.size_fit, density)
        if filling.factor in paper.RATIO:
            _draw_papers(place, filling.factor, density)
        _draw_fit(place, filling.velocity_fit)
        place.set_xlabel("yield stress $\\sigma_{plastic}$  [MPa]")
        place.set_ylabel("reduced Young's modulus $E^*$  [MPa]")
        place.set_yscale("log")
        place.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        place.set_xlim(0.0, None)
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


def _draw_fit(axes, fit):
    if fit.reason or not np.all(np.isfinite(fit.values)):
        return
    sigma, young = (value / MEGA for value in fit.values)
    bars = [None if e is None else [e / MEGA] for e in fit.errors]
    axes.errorbar(
        [sigma],
        [young],
        xerr=bars[0],
        yerr=bars[1],
        fmt="*",
        markersize=13,
        color="#c62828",
        capsize=3,
        label="fit to all velocities",
        zorder=6,
    )


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
