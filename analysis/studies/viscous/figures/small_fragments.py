"""What drag changes: growth efficiency with and without half of the small fragments' mass."""

from ....figures.style import styled
from ...definition import StudyFigure
from ..results import SMALL
from .common import draw_curve, legend, letter, panels, size_label, time_colours, time_label, velocity_axis


@styled
def remnants_figure(results):
    """<f_gro> of every size (above), and with half of the mass of small fragments (below), against velocity for every T_vis."""
    if not results.sizes:
        return None
    figure, axes = panels(2, len(results.sizes), 4.4, 3.4)
    colours = time_colours(results.table)
    for row, curves in zip(axes, (results.growth, results.remnants)):
        for place, grains in zip(row, results.sizes):
            for growth in results.of_size(grains):
                curve = curves[grains, growth.viscous_time]
                draw_curve(place, curve, colours[curve.viscous_time], time_label(curve.viscous_time))
            place.axhline(0.0, color="0.6", lw=0.8)
            velocity_axis(place, results.table.velocity)
            place.text(0.03, 0.05, size_label(grains, results.of_size(grains)), transform=place.transAxes)
    axes[0, 0].set_ylabel(r"$\langle f_{gro} \rangle$")
    axes[1, 0].set_ylabel(r"$\langle f_{gro} + M_{small}/2M \rangle$")
    legend(axes[0, 0], fontsize=8)
    letter(axes, "")
    return figure


FIGURES = (
    StudyFigure(
        "small_fragments",
        f"Growth efficiency with half the mass of fragments of {SMALL} grains or fewer: what drag changes, and what not.",
        remnants_figure,
    ),
)
