"""Snapshots of one collision for each T_vis: A22 Fig. 1."""

from ....figures.collision_view import draw_view, reach
from ....figures.style import styled
from ...definition import StudyFigure
from .. import paper
from .common import letter, one_run_each, own_times, panels, run_folder, time_label

VIEW = 4.5  # half width of a panel in characteristic radii, and more at the end, where grains are farther


@styled
def snapshots(results):
    """Grains without drag at A22's times (own_times), and at the end for every T_vis, to one scale a row: Fig. 1, seen along z."""
    shown = one_run_each(results)
    if not shown:
        return None
    first = run_folder(shown[0][1])
    chosen = sorted({first.states.nearest(time) for time in own_times(paper.SNAPSHOTS, shown[0][1])})
    early = [(first.states[k], time_label(shown[0][0])) for k in chosen]
    late = [(run_folder(row).last, time_label(time)) for time, row in shown]
    columns = max(len(early), len(late))
    figure, axes = panels(2, columns, 3.3, 3.4)
    unit = first.derived["grainRadius"]
    least = VIEW * shown[0][1].characteristic_radius / unit
    for places, states in zip(axes, (early, late)):
        half = least if states is early else max([least] + [reach(state) / unit for state, _ in states])
        for place, (state, name) in zip(places, states):
            draw_view(place, state, unit, half, name)
        for place in places[len(states) :]:
            place.set_axis_off()
    letter([place for row in axes for place in row if place.axison], "")
    return figure


FIGURES = (
    StudyFigure(
        "fig01_snapshots",
        "A22 Fig. 1: without drag at the paper's times (above), and at the end for every T_vis (below).",
        snapshots,
    ),
)
