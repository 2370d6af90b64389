"""d_max against where d starts: the part of its scatter that comes from the aggregates' centres of mass."""

import numpy as np

from ....figures.panels import papers_star
from ....figures.style import styled
from ...definition import StudyFigure
from .. import paper
from .common import filling_text, is_papers_velocity, legend, letter, main_filling, panels, size_colours


@styled
def offset_figure(results):
    """d_max of every run against d(0) + 2 r at the velocity of the size fit, with the regression of each size
    and A24's value (its line)."""
    filling = results.by_filling[main_filling(results)]
    points, unit = filling.points, results.grain_radius
    chosen = np.flatnonzero(points.velocity == filling.size_fit.velocity)
    colours = size_colours(round(float(points.radius[k] / unit), 3) for k in chosen)
    line = paper.line(filling.factor) if is_papers_velocity(filling.size_fit.velocity) else None
    figure, axes = panels(1, 1, 6.2, 4.8)
    place = axes[0, 0]
    for k in chosen:
        radius, fix = round(float(points.radius[k] / unit), 3), filling.corrections[k]
        d_max = points.samples[k][0] / unit
        runs = results.runs(filling.factor, points.radius[k], points.velocity[k]).sort_values("seed")
        label = f"$R$ = {radius:g} $r$, {len(d_max)} seeds"
        _draw_size(place, runs.offset.to_numpy() / unit, d_max, fix, colours[radius], label)
        if line:
            papers_star(place, [0.0], [line[0] * radius - line[1]], "A24's line" if k == chosen[0] else None)
    place.axvline(0.0, color="0.8", linewidth=0.8, zorder=0)
    place.set_xlabel("offset of the centres of mass at the start, $d(0) + 2r$  [grain radii]")
    place.set_ylabel("$d_{max}$  [grain radii]")
    legend(place, fontsize=9)
    letter(axes, filling_text(filling.factor, filling.size_fit.velocity))
    return figure


def _draw_size(axes, offset, d_max, fix, colour, label):
    """The runs of one size, and their regression, read off at offset zero."""
    axes.plot(offset, d_max, "D", markersize=5, color=colour, label=label)
    if fix.slope is None:
        return
    reach = np.array([min(offset.min(), 0.0), max(offset.max(), 0.0)])
    axes.plot(reach, fix.corrected + fix.slope * reach, color=colour, linewidth=1.0)
    axes.errorbar(
        [0.0],
        [fix.corrected],
        yerr=[fix.corrected_error or 0.0],
        fmt="s",
        capsize=4,
        markersize=7,
        markerfacecolor="none",
        color=colour,
    )


FIGURES = (
    StudyFigure(
        "start_offset",
        "Largest compression against the chance offset of the centres of mass.",
        offset_figure,
    ),
)
