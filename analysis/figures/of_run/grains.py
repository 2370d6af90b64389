"""Snapshots of the grains, coloured by aggregate, as Fig. 3 of Arakawa et al. (2024, A24): fluffy aggregates whole, of dense
ones the half behind the plane z = 0."""

import numpy as np

from ...measures.of_run import maximum_of_run
from ...runs.format import COLLISION
from ..grain_colours import AGGREGATE_COLOURS
from ..sphere_raster import paint_spheres
from ..style import NANO, new_figure, run_title, styled

# More pixels than this across would only cost time: the figure is about 1,300 wide.
_PIXELS_ACROSS = 1500
_FLUFFY = 0.3  # filling factor below which one sees into aggregates, and a cut leaves pieces that look like fragments
_LARGEST_VIEW = 2.0  # half height of the view in aggregate sizes: fragments that flew farther are left outside


@styled
def grains_figure(run):
    """Figure of the grains at the start, at the largest compression and at the end (those of them that are
    different states), to one scale in grain radii; aggregates of a filling factor of 0.3 and more are cut along the plane z = 0
    through the collision axis. RunFolderError if there is no state."""
    run.start  # says so when there is no state
    unit = run.derived["grainRadius"]
    maximum = maximum_of_run(run)
    middle = [] if maximum is None else [run.states.nearest(maximum.time)]
    states = [run.states[i] for i in sorted({0, *middle, len(run.states) - 1})]
    window, whole = _window(states, unit), run.parameters.get("filling", 1.0) < _FLUFFY
    pixel = max((window[1] - window[0]) / _PIXELS_ACROSS, 0.02)
    panel = 8.6 * 0.88 * (window[3] - window[2]) / (window[1] - window[0])
    figure = new_figure(8.6, len(states) * (panel + 0.35) + 0.75, constrained_layout=True)
    axes = figure.subplots(len(states), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for place, state in zip(axes, states):
        _draw(place, state, unit, window, pixel, whole)
        place.set_ylabel("$y$  [grain radii]")
    axes[-1].set_xlabel("$x$  [grain radii]")
    figure.get_layout_engine().set(w_pad=0.1)
    figure.suptitle(
        run_title(run, "all grains" if whole else "grains behind the plane $z$ = 0"), fontsize=10, color="0.3"
    )
    return figure


FIGURE, KINDS = grains_figure, (COLLISION.name,)


def _window(states, unit):
    """(x0, x1, y0, y1) in grain radii that holds the grains of all states, centred, fragments far off
    aside."""
    start = states[0].position / unit
    across = np.abs(start[:, 1]).max() + 2.0
    reach = [np.abs(s.position[:, :2]).max(axis=0) / unit for s in states]
    half_y = min(max(r[1] for r in reach) + 2.0, _LARGEST_VIEW * across)
    half_x = min(max(r[0] for r in reach) + 2.0, _LARGEST_VIEW * (np.abs(start[:, 0]).max() + 2.0))
    plates = [x for state in states for x in _planes(state, unit, 0)]
    if plates:  # nothing is behind a plate
        every = np.concatenate([plates, *(state.position[:, 0] / unit for state in states)])
        return max(every.min() - 2.0, -half_x), min(every.max() + 2.0, half_x), -half_y, half_y
    return -half_x, half_x, -half_y, half_y


def _planes(state, unit, axis):
    """Where planes across an axis lie, in grain radii."""
    if state.plane_axis is None:
        return np.zeros(0)
    return state.plane_position[state.plane_axis == axis] / unit


def _draw(axes, state, unit, window, pixel, whole):
    shown = (state.position[:, 2] <= 0.0) | whole
    position = state.position[shown] / unit
    colour = np.array(AGGREGATE_COLOURS)[state.aggregate[shown]]
    fading = {"fading": window[3]} if whole else {}  # over all of its depth
    image = paint_spheres(position, state.radius[shown] / unit, colour, window, pixel, **fading)
    axes.imshow(image, extent=window, origin="lower", interpolation="antialiased")
    for draw, axis in ((axes.axvline, 0), (axes.axhline, 1)):
        for place in _planes(state, unit, axis):
            draw(place, color="0.3")
    axes.set_title(f"$t$ = {state.time * NANO:.1f} ns", loc="left")
