"""Normal forces at the contacts in a slab around the collision axis, around the largest compression: Arakawa et al.
(2024, A24), Fig. 13."""

import numpy as np
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D

from ...measures.of_run import maximum_of_run
from ...runs.format import COLLISION
from ..style import NANO, new_figure, run_title, styled

_STRONG = 0.2  # of F_c, A24 Fig. 13
_HALF_SLAB = 2.0  # in grain radii: thin enough to see single chains, thick enough to hold them
_TIMES = (5 / 6, 1.0, 7 / 6, 4 / 3)  # of t_max: A24 shows 250, 300, 350 and 400 ns beside a t_max of 300 ns
_KINDS = (("other", "#8f8f8f", 0.5), ("tension", "#00e5ff", 1.3), ("compression", "#ff2bd6", 1.3))
_TEXT = {"compression": "compression, $F > 0.2\\,F_c$", "tension": "tension, $F < -0.2\\,F_c$", "other": "weaker"}


@styled
def forces_figure(run):
    """Figure of the contacts as lines between grain centres at up to four states around the largest
    compression, for grains with |z| <= 2 grain radii: magenta F > 0.2 F_c, cyan F < -0.2 F_c, grey others
    (A24 Fig. 13). RunFolderError if there is no state."""
    run.start  # says so when there is no state
    unit = run.derived["grainRadius"]
    states = [run.states[i] for i in _chosen_states(run)]
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
        _draw(place, state, unit, run.derived["pullOffForce"] / unit, window)
    for place in axes[:, 0]:
        place.set_ylabel("$y$  [grain radii]")
    for column in range(columns):
        [p for p in axes[:, column] if p.figure][-1].set_xlabel("$x$  [grain radii]")
    _legend(figure, run)
    return figure


FIGURE, KINDS = forces_figure, (COLLISION.name,)


def force_kinds(normal_force, pull_off_force):
    """Masks (M,) of contacts by name: compression F > 0.2 F_c, tension F < -0.2 F_c, other (forces [N],
    positive = repulsive; F_c of each contact or of all), as in A24 Fig. 13."""
    compression, tension = normal_force > _STRONG * pull_off_force, normal_force < -_STRONG * pull_off_force
    return {"compression": compression, "tension": tension, "other": ~(compression | tension)}


def _chosen_states(run):
    maximum = maximum_of_run(run)
    if maximum is None:
        return [0]
    return sorted({run.states.nearest(part * maximum.time) for part in _TIMES})


def _in_slab(position, unit):
    return np.abs(position[:, 2]) <= _HALF_SLAB * unit


def _window(states, unit):
    """(x0, x1, y0, y1) in grain radii around the grains of the slab, but not wider than high: the force
    chains are where the aggregates meet. Half a percent of the grains may lie outside."""
    places = np.concatenate([s.position[_in_slab(s.position, unit)][:, :2] for s in states]) / unit
    if not len(places):
        places = np.concatenate([s.position[:, :2] for s in states]) / unit
    half_x, half_y = np.percentile(np.abs(places), 99.5, axis=0) * 1.03 + 2.0
    half_x = min(half_x, half_y)
    return -half_x, half_x, -half_y, half_y


def _draw(axes, state, unit, pull_off_force_over_radius, window):
    slab = _in_slab(state.position, unit)
    pairs = state.contact_pairs
    inside = slab[pairs[:, 0]] & slab[pairs[:, 1]]
    ends = state.position[pairs[inside]][:, :, :2] / unit
    first, second = state.radius[pairs[inside]].T
    pull_off_force = pull_off_force_over_radius * 2.0 * first * second / (first + second)
    masks = force_kinds(state.contact_normal_force[inside], pull_off_force)
    # Lines thin out as the view grows, so that chains stay apart in large aggregates.
    scale = np.clip(60.0 / (window[1] - window[0]), 0.5, 2.0)
    for kind, colour, width in _KINDS:
        axes.add_collection(
            LineCollection(ends[masks[kind]], colors=colour, linewidths=width * scale, capstyle="round")
        )
    axes.set_facecolor("black")
    axes.set_xlim(window[:2])
    axes.set_ylim(window[2:])
    axes.set_aspect("equal")
    axes.set_title(f"$t$ = {state.time * NANO:.1f} ns", loc="left")


def _legend(figure, run):
    """Below the panels, in a strip that the layout leaves free."""
    handles = [Line2D([], [], color=colour, linewidth=2.5, label=_TEXT[kind]) for kind, colour, _ in reversed(_KINDS)]
    strip = 0.35 / figure.get_figheight()
    figure.get_layout_engine().set(rect=(0.0, strip, 1.0, 1.0 - strip))
    figure.legend(handles=handles, loc="lower center", ncol=3, frameon=False)
    figure.suptitle(run_title(run, f"slab $|z|$ $\\leq$ {_HALF_SLAB:g} $r$"), fontsize=10, color="0.3")
