"""Snapshots of collisions: S17 Figs. 7 and 9."""

from ....figures.collision_view import draw_view, reach
from ....figures.style import styled
from ....measures.fragments import fragment_labels
from ....runs.table import run_folder
from ....theory.chains import stretching_period
from ....theory.pair_constants import ICE, pair_constants
from ...definition import StudyFigure
from .. import paper
from .common import beta_label, growth_label, panels

# (beta, V_c [m/s]) of BCCA aggregates, from top to bottom; and for V_g = 3 m/s.
_BCCA = ((0.0, 10.0), (0.0, 30.0), (0.7, paper.SLOW), (0.7, 10.0), (0.7, 30.0))
_COMPACTED = ((0.0, 3.0), (0.7, 3.0))
_TIMES, _COMPACTED_TIMES = (0, 2500, 5000, 10_000, 20_000), (0, 625, 1250, 2500, 5000)  # periods


def _figure(collisions, growth, periods):
    """Figure function: a row for each collision whose runs are there, of its first seed."""

    @styled
    def draw(results):
        rows = [row for row in (_first(results, growth, *each) for each in collisions) if row is not None]
        if not rows:
            return None
        figure, axes = panels(len(rows), len(periods), 2.7, 2.75)
        for places, row in zip(axes, rows):
            _draw_row(places, row, periods)
        return figure

    return draw


def _first(results, growth, neck, velocity):
    """The run (a row) of a collision with the lowest seed; None without one."""
    runs = results.runs(growth_velocity=growth, neck=neck, velocity=velocity).sort_values("packing_seed")
    return next(runs.itertuples(), None)


def _draw_row(places, row, periods):
    run = run_folder(row)
    period = stretching_period(pair_constants(ICE, row.grain_radius))
    chosen = sorted({run.states.nearest(number * period) for number in periods})
    states = [run.states[k] for k in chosen]
    half = 1.1 * reach(states[0], held=1.0) / row.grain_radius  # what flies farther leaves the panel
    draw_view(places[0], states[0], row.grain_radius, half)
    for place, state in zip(places[1:], states[1:]):
        draw_view(place, state, row.grain_radius, half, centre=_centre_of_largest(state))
    for place in places[len(states) :]:
        place.set_axis_off()
    places[0].set_title(
        f"{growth_label(row.growth_velocity)}, {beta_label(row.neck)}, {row.velocity:.3g} m/s", fontsize=9, loc="left"
    )


def _centre_of_largest(state):
    """Mean position (3,) [m] of the grains of the largest piece."""
    return state.position[fragment_labels(len(state.position), state.contact_pairs) == 0].mean(axis=0)


FIGURES = (
    StudyFigure(
        "fig07_snapshots",
        "S17 Fig. 7: collisions of BCCA aggregates (one seed), at the paper's times or the run's own end; "
        "later ones around the largest piece.",
        _figure(_BCCA, 0.0, _TIMES),
        vector=False,
    ),
    StudyFigure(
        "fig09_snapshots",
        "S17 Fig. 9: compacted aggregates at 3 m/s (one seed), at the saved states nearest to the paper's times; "
        "later ones around the largest piece.",
        _figure(_COMPACTED, 3.0, _COMPACTED_TIMES),
        vector=False,
    ),
)
