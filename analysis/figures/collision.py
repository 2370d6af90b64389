"""Figures of one collision: motion, grains and contact forces, as those of Arakawa et al. (2024, A24)."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from ..runs.files import RunFolderError
from ..runs.format import HISTORY_FILE
from ..runs.measured import maximum_of_run
from .grain_colours import AGGREGATE_COLOURS
from .sphere_raster import paint_spheres
from .style import NANO, new_figure, run_title, styled

# ---- motion ----


@styled
def motion_figure(run):
    """Figure of d (in grain radii) and v (m/s) against time (ns), with d_max marked, as A24 Fig. 4."""
    history, grain_radius = run.history, run.derived["grainRadius"]
    maximum = maximum_of_run(run)
    if maximum is None:
        raise RunFolderError(f"{run.path / HISTORY_FILE}: d and v have no value at any time: all grains on one side")
    time = history["time"] * NANO
    figure = new_figure(7.0, 6.6, constrained_layout=True)
    upper, lower = figure.subplots(2, 1, sharex=True)
    upper.plot(time, history["d"] / grain_radius, color="#c62828")
    lower.plot(time, history["v"], color="#c62828")
    for axes in (upper, lower):
        axes.axhline(0.0, color="0.75", linewidth=0.8, zorder=0)
        axes.axvline(maximum.time * NANO, color="0.45", linewidth=1.0, linestyle=(0, (4, 3)), zorder=0)
    _mark(upper, maximum, grain_radius, history["d"] / grain_radius)
    upper.set_ylabel("compression length $d$  [grain radii]")
    lower.set_ylabel("mutual velocity $v$  [m/s]")
    lower.set_xlabel("time $t$  [ns]")
    lower.set_xlim(time[0], time[-1] if time.size > 1 else time[0] + 1.0)
    for axes, letter in ((upper, "a"), (lower, "b")):
        axes.set_title(f"({letter})", loc="left")
    upper.set_title(run_title(run), loc="right", fontsize=10, color="0.3")
    return figure


def _mark(axes, maximum, grain_radius, d):
    """A point and its numbers at the largest compression; d in grain radii."""
    length, time = maximum.length / grain_radius, maximum.time * NANO
    axes.plot([time], [length], "o", color="black", markersize=5, zorder=3)
    low, top = np.nanmin(d), max(length, np.nanmax(d))
    # Room above the curve for the label, which would otherwise lie on it.
    axes.set_ylim(low - 0.06 * (top - low), top + 0.28 * (top - low) if top > low else top + 1.0)
    late = time > 0.6 * axes.dataLim.x1
    bound = "" if maximum.inside else " (largest so far)"
    axes.annotate(
        f"$d_{{max}}$ = {length:.3f} $r$ at {time:.1f} ns{bound}",
        (time, length),
        xytext=(-6 if late else 6, 9),
        textcoords="offset points",
        ha="right" if late else "left",
        va="bottom",
    )


# ---- grains ----

_PIXELS_ACROSS = 1500  # more would only cost time: the figure is about 1,300 wide
_FLUFFY = 0.3  # filling factor below which one sees into aggregates, and a cut leaves pieces that look like fragments
_LARGEST_VIEW = 2.0  # half height of the view in aggregate sizes: fragments that flew farther are left outside


@styled
def grains_figure(run):
    """Figure of the grains at the start, the largest compression and the end, in grain radii, as A24 Fig. 3.

    Aggregates of a filling factor of 0.3 and more are cut along the plane z = 0 through the collision axis.
    """
    run.start  # RunFolderError without a state
    unit = run.derived["grainRadius"]
    maximum = maximum_of_run(run)
    middle = [] if maximum is None else [run.states.nearest(maximum.time)]
    states = [run.states[i] for i in sorted({0, *middle, len(run.states) - 1})]
    window, whole = _view(states, unit), run.parameters.get("filling", 1.0) < _FLUFFY
    pixel = max((window[1] - window[0]) / _PIXELS_ACROSS, 0.02)
    panel = 8.6 * 0.88 * (window[3] - window[2]) / (window[1] - window[0])
    figure = new_figure(8.6, len(states) * (panel + 0.35) + 0.75, constrained_layout=True)
    axes = figure.subplots(len(states), 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for place, state in zip(axes, states):
        _draw_grains(place, state, unit, window, pixel, whole)
        place.set_ylabel("$y$  [grain radii]")
    axes[-1].set_xlabel("$x$  [grain radii]")
    figure.get_layout_engine().set(w_pad=0.1)
    shown = "all grains" if whole else "grains behind the plane $z$ = 0"
    figure.suptitle(run_title(run, shown), fontsize=10, color="0.3")
    return figure


def _view(states, unit):
    """(x0, x1, y0, y1) in grain radii that holds the grains of all states, centred, fragments far off aside."""
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


def _draw_grains(axes, state, unit, window, pixel, whole):
    shown = (state.position[:, 2] <= 0.0) | whole
    colour = np.array(AGGREGATE_COLOURS)[state.aggregate[shown]]
    fading = {"fading": window[3]} if whole else {}  # over all of its depth
    image = paint_spheres(state.position[shown] / unit, state.radius[shown] / unit, colour, window, pixel, **fading)
    axes.imshow(image, extent=window, origin="lower", interpolation="antialiased")
    for draw, axis in ((axes.axvline, 0), (axes.axhline, 1)):
        for place in _planes(state, unit, axis):
            draw(place, color="0.3")
    axes.set_title(f"$t$ = {state.time * NANO:.1f} ns", loc="left")


PIXELS = 420  # across a view
MICRO = 1e6


def reach(state, held):
    """Half width [m] of a square around the origin that holds this fraction of a state's grains."""
    return float(np.quantile(np.abs(state.position[:, :2]).max(axis=1), held))


def draw_view(axes, state, unit, half):
    """A state along z in a square around the origin of half width `half`, in units of `unit` [m], with its time."""
    window, pixel = (-half, half, -half, half), 2 * half / PIXELS
    colour = np.array(AGGREGATE_COLOURS)[state.aggregate]
    image = paint_spheres(state.position / unit, state.radius / unit, colour, window, pixel, fading=half)
    axes.imshow(image, extent=window, origin="lower", interpolation="antialiased")
    axes.text(0.03, 0.97, rf"{state.time * MICRO:.2f} $\mu$s", transform=axes.transAxes, va="top", fontsize=9)
    axes.set_xticks([])
    axes.set_yticks([])
    axes.spines[:].set_visible(True)
    axes.spines[:].set_color("0.75")


# ---- forces ----

_STRONG = 0.2  # of F_c, A24 Fig. 13
_HALF_SLAB = 2.0  # in grain radii: thin enough to see single chains, thick enough to hold them
_TIMES = (5 / 6, 1.0, 7 / 6, 4 / 3)  # of t_max: A24 shows 250, 300, 350 and 400 ns beside a t_max of 300 ns
_FORCES = {  # colour, width, text
    "other": ("#8f8f8f", 0.5, "weaker"),
    "tension": ("#00e5ff", 1.3, "tension, $F < -0.2\\,F_c$"),
    "compression": ("#ff2bd6", 1.3, "compression, $F > 0.2\\,F_c$"),
}


@styled
def forces_figure(run):
    """Figure of the contacts as lines between grain centres at up to four states around the largest compression, as A24
    Fig. 13: for grains with |z| <= 2 grain radii, magenta F > 0.2 F_c, cyan F < -0.2 F_c, grey others."""
    run.start  # RunFolderError without a state
    unit = run.derived["grainRadius"]
    maximum = maximum_of_run(run)
    chosen = [0] if maximum is None else sorted({run.states.nearest(part * maximum.time) for part in _TIMES})
    states = [run.states[i] for i in chosen]
    window = _window(states, unit)
    columns = 1 if len(states) == 1 else 2
    rows = -(-len(states) // columns)
    panel = 5.2
    height = panel * (window[3] - window[2]) / (window[1] - window[0])
    figure = new_figure(panel * columns + 0.6, (height + 0.5) * rows + 0.9, constrained_layout=True)
    axes = figure.subplots(rows, columns, sharex=True, sharey=True, squeeze=False)
    for place in axes.flat[len(states) :]:
        place.remove()
    for place, state in zip(axes.flat, states):
        _draw_forces(place, state, unit, run.derived["pullOffForce"] / unit, window)
    for place in axes[:, 0]:
        place.set_ylabel("$y$  [grain radii]")
    for column in range(columns):
        [p for p in axes[:, column] if p.figure][-1].set_xlabel("$x$  [grain radii]")
    # A legend below the panels, in a strip that the layout leaves free.
    handles = [Line2D([], [], color=c, linewidth=2.5, label=text) for c, _, text in reversed(_FORCES.values())]
    strip = 0.35 / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0.0, strip, 1.0, 1.0 - strip))
    figure.legend(handles=handles, loc="lower center", ncol=3, frameon=False)
    figure.suptitle(run_title(run, f"slab $|z|$ $\\leq$ {_HALF_SLAB:g} $r$"), fontsize=10, color="0.3")
    return figure


def force_kinds(normal_force, pull_off_force):
    """Masks (M,) of contacts by name: compression F > 0.2 F_c, tension F < -0.2 F_c, other (forces [N], positive =
    repulsive; F_c of each contact or of all), as in A24 Fig. 13."""
    compression, tension = normal_force > _STRONG * pull_off_force, normal_force < -_STRONG * pull_off_force
    return {"compression": compression, "tension": tension, "other": ~(compression | tension)}


def _window(states, unit):
    """(x0, x1, y0, y1) in grain radii around the grains of the slab, half a percent of them aside, not wider than high:
    the force chains are where the aggregates meet."""
    every = np.concatenate([s.position for s in states]) / unit
    inside = np.abs(every[:, 2]) <= _HALF_SLAB
    places = every[inside if inside.any() else slice(None), :2]
    half_x, half_y = np.percentile(np.abs(places), 99.5, axis=0) * 1.03 + 2.0
    half_x = min(half_x, half_y)
    return -half_x, half_x, -half_y, half_y


def _draw_forces(axes, state, unit, pull_off_force_over_radius, window):
    slab = np.abs(state.position[:, 2]) <= _HALF_SLAB * unit
    pairs = state.contact_pairs
    inside = slab[pairs[:, 0]] & slab[pairs[:, 1]]
    ends = state.position[pairs[inside]][:, :, :2] / unit
    first, second = state.radius[pairs[inside]].T
    pull_off_force = pull_off_force_over_radius * 2.0 * first * second / (first + second)
    masks = force_kinds(state.contact_normal_force[inside], pull_off_force)
    # Lines thin out as the view grows, so that chains stay apart in large aggregates.
    scale = np.clip(60.0 / (window[1] - window[0]), 0.5, 2.0)
    for kind, (colour, width, _) in _FORCES.items():
        lines = LineCollection(ends[masks[kind]], colors=colour, linewidths=width * scale, capstyle="round")
        axes.add_collection(lines)
    axes.set_facecolor("black")
    axes.set_xlim(window[:2])
    axes.set_ylim(window[2:])
    axes.set_aspect("equal")
    axes.set_title(f"$t$ = {state.time * NANO:.1f} ns", loc="left")
