"""Dissipated energy against filling factor: K13 Figs 8, 10."""

import numpy as np

from ....figures.style import styled
from ....runs.format import COLOURS, LABELS
from ....runs.table import run_folder
from ...definition import StudyFigure
from ..channel_sections import LABELS as OWN_LABELS
from ..curve import compressing
from ..measure import LOST_CHANNELS
from ..results import family
from .common import legend, letter, panels

_STYLES = ("-", "--", ":")


def _draw_energy(axes, row, style="-"):
    """Each channel is named once, whichever line has it."""
    history = run_folder(row).history
    named = set(axes.get_legend_handles_labels()[1])
    part = compressing(history)
    for channel in LOST_CHANNELS:
        lost = history[channel][part] - history[channel][0]
        if lost.max() > 0:
            shown = lost > 0
            text = OWN_LABELS.get(channel, LABELS[channel])
            label = None if text in named else text
            axes.plot(history["filling"][part][shown], lost[shown], style, color=COLOURS[channel], label=label)
    axes.set_xscale("log")
    axes.set_yscale("log")
    axes.set_xlabel("filling factor $\\phi$")
    axes.set_ylabel("dissipated energy  [J]")
    axes.set_ylim(1e-6 * axes.get_ylim()[1], None)


@styled
def damping_figure(results):
    """Without damping (solid) and with it (dashed), of one cluster."""
    groups = family(results, "linearDamping") or (results.main,)
    figure, axes = panels(1, 1, 6.4, 4.8)
    for group, style in zip(groups, _STYLES):
        _draw_energy(axes[0, 0], next(group.table.itertuples()), style)
    styles = {"-": "solid", "--": "dashed", ":": "dotted"}
    texts = [f"$k_n$ = {group.parameters['linearDamping']:g} {styles[s]}" for group, s in zip(groups, _STYLES)]
    legend(axes[0, 0], loc="upper left", fontsize=8)
    letter(axes, ", ".join(texts))
    return figure


@styled
def rolling_figure(results):
    """A panel for each xi_crit, of one cluster."""
    groups = family(results, "criticalRolling")[::-1][:4]
    if not groups:
        return None
    figure, axes = panels(1, len(groups), 4.6, 4.2)
    for place, group in zip(axes[0], groups):
        _draw_energy(place, next(group.table.itertuples()))
        place.text(
            0.96,
            0.04,
            f"$\\xi_{{crit}}$ = {group.parameters['criticalRolling'] * 1e10:.3g} Å",
            ha="right",
            transform=place.transAxes,
        )
    top = max(place.get_ylim()[1] for place in axes[0])
    for place in np.ravel(axes):
        place.set_ylim(1e-6 * top, top)
    legend(axes[0, 0], loc="upper left", fontsize=8)
    letter(axes, "")
    return figure


FIGURES = (
    StudyFigure("fig08_energy", "K13 Fig. 8: dissipated energy with and without damping.", damping_figure),
    StudyFigure("fig10_energy", "K13 Fig. 10: dissipated energy for different xi_crit.", rolling_figure),
)
