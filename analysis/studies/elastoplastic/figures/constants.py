"""Yield stress and coordination number beside those of other aggregates: A24 Fig. 11."""

import numpy as np

from ....figures.panels import papers_star
from ....figures.style import styled
from ....theory.aggregates import bcca_coordination, bcca_strength, cpe_coordination
from ...definition import StudyFigure
from .. import paper
from .common import MEGA, OURS, PAPER, legend, letter, panels

_RED = "#c62828"


@styled
def strength_figure(results):
    """(a) sigma_plastic and the quasistatic strength of compressed BCCA aggregates (eq 44), (b) coordination
    numbers (eqs 39, 45) and the measured ones inside the aggregates."""
    figure, axes = panels(1, 2)
    left, right = axes[0]
    phi = np.linspace(0.1, 0.6, 200)
    _draw_strength(left, phi, results)
    _draw_coordination(right, phi, results)
    for place in axes[0]:
        place.set_xlabel("filling factor")
        legend(place, loc="upper left", fontsize=9)
    left.set_ylim(None, left.get_ylim()[1] * 8.0)
    letter(axes, "")
    return figure


def _draw_strength(axes, phi, results):
    axes.semilogy(phi, bcca_strength(phi) / MEGA, color=OURS, label="compressed BCCA, quasistatic (eq 44)")
    theirs = [value / MEGA for value in paper.YIELD_STRESS.values()]
    papers_star(axes, list(paper.YIELD_STRESS), theirs, "A24, CPE, collisions", linestyle="none")
    label = "here, CPE, collisions"
    for factor, filling in results.by_filling.items():
        fit = filling.velocity_fit
        if fit.reason or not np.isfinite(fit.values[0]):
            continue
        error = None if fit.errors[0] is None else [fit.errors[0] / MEGA]
        axes.errorbar(
            [factor], [fit.values[0] / MEGA], yerr=error, fmt="*", markersize=11, color=_RED, capsize=3, label=label
        )
        label = None
    axes.set_ylabel("yield stress  [MPa]")


def _draw_coordination(axes, phi, results):
    fillings = list(results.by_filling)
    cpe = cpe_coordination(phi, results.grain_radius, results.overlap)
    axes.plot(phi, bcca_coordination(phi), color=OURS, label="compressed BCCA (eq 45)")
    axes.plot(phi, cpe, color=PAPER, linestyle="--", label="CPE (eq 39)")
    inner = [filling.coordination[0] for filling in results.by_filling.values()]
    whole = [results.runs(factor).coordination.mean() for factor in fillings]
    axes.plot(fillings, inner, "D", color=_RED, markersize=6, label="measured, 2 $r$ below the surface")
    axes.plot(fillings, whole, "o", markerfacecolor="none", color=_RED, markersize=7, label="measured, all grains")
    axes.set_ylabel("coordination number")
    axes.set_ylim(0.0, 12.0)


FIGURES = (
    StudyFigure(
        "fig11_strength",
        "A24 Fig. 11: yield stress and coordination number beside other aggregates.",
        strength_figure,
    ),
)
