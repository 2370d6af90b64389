"""Snapshots of one collision for each T_vis: A22 Fig. 1."""

import numpy as np

from ....figures.sphere_raster import paint_spheres
from ....figures.style import AGGREGATE_COLOURS, styled
from ...definition import StudyFigure
from .. import paper
from .common import letter, one_run_each, own_times, panels, run_folder, time_label

MICRO = 1e6
PIXELS = 420  # across a panel
VIEW = 4.5  # half width of a panel in characteristic radii, and more at the end if
HELD = 0.95  # that fraction of the grains reaches farther: the rest is left outside


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
        half = least if states is early else max([least] + [_reach(state) / unit for state, _ in states])
        for place, (state, name) in zip(places, states):
            _draw(place, state, unit, half, name)
        for place in places[len(states) :]:
            place.set_axis_off()
    letter([place for row in axes for place in row if place.axison], "")
    return figure


def _reach(state):
    """Half width [m] of a square around the origin that holds HELD of the grains."""
    return float(np.quantile(np.abs(state.position[:, :2]).max(axis=1), HELD))


def _draw(place, state, unit, half, name):
    window, pixel = (-half, half, -half, half), 2 * half / PIXELS
    colour = np.array(AGGREGATE_COLOURS)[state.aggregate]
    image = paint_spheres(state.position / unit, state.radius / unit, colour, window, pixel, fading=half)
    place.imshow(image, extent=window, origin="lower", interpolation="antialiased")
    text = rf"{state.time * MICRO:.2f} $\mu$s, {name}"
    place.text(0.03, 0.97, text, transform=place.transAxes, va="top", fontsize=9)
    place.set_xticks([])
    place.set_yticks([])


FIGURES = (
    StudyFigure(
        "fig01_snapshots",
        "A22 Fig. 1: without drag at the paper's times (above), and at the end for every T_vis (below).",
        snapshots,
    ),
)
