"""Compression of both kinds of aggregates."""

import numpy as np

from ...figures.panels import legend, letter, panels, velocity_axis
from ...figures.style import styled
from ...statistics import mean_and_error
from ..definition import StudyFigure
from .study import KINDS

_COLOURS = {0: "#2166ac", 1: "#c62828"}
_MARKERS = ("o", "s", "^", "D")


@styled
def compression_figure(results):
    """Compression from the first touch and its time against velocity, of both kinds at every filling: single pairs, and their
    means with errors."""
    table = results.table
    figure, axes = panels(1, 2, 4.8, 4.2)
    shown = (table.compression / table.grainRadius, 1e9 * table.t_max)
    for marker, (nominal, of_filling) in zip(_MARKERS, table.groupby(table.nominal.round(6))):
        for kind, runs in of_filling.groupby("compressed"):
            for place, values in zip(axes[0], shown):
                _draw(place, runs, values[runs.index], _COLOURS[kind], marker, f"{KINDS[kind]}, {nominal:g}")
    for place in axes[0]:
        velocity_axis(place, table.velocity)
    axes[0, 0].set_ylabel("compression from the first touch  [r]")
    axes[0, 1].set_ylabel("its time after the first touch  [ns]")
    legend(axes[0, 0], fontsize=8)
    letter(axes, "")
    return figure


def _draw(place, runs, values, colour, marker, label):
    place.plot(runs.velocity, values, marker, color=colour, alpha=0.3, markersize=3)
    velocities = np.unique(runs.velocity.round(6))
    means = [mean_and_error(values[runs.velocity.round(6) == v]) for v in velocities]
    place.errorbar(
        velocities,
        [mean for mean, _ in means],
        [error or 0.0 for _, error in means],
        fmt=marker + "-",
        color=colour,
        capsize=3,
        label=label,
    )


FIGURES = (
    StudyFigure(
        "compression",
        "Largest compression from the first touch on and its time, CPE and compressed.",
        compression_figure,
    ),
)
