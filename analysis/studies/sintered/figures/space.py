"""The same collisions in space, and with drag, beside those in the plane (beyond S17: its section 6.2)."""

from itertools import product

from ....figures.style import styled
from ...definition import StudyFigure
from .common import draw_points, legend, letter, order_colour, panels, velocity_axis

QUANTITIES = {"largest": "sticking efficiency", "fragments": "mass in fragments", "cut_per_grain": "$N_{cut}/N_t$"}


@styled
def beyond(results):
    """Sticking efficiency, mass in fragments and broken necks of BCCA aggregates of beta = 0.7 against velocity, in the plane, in
    space, and with drag."""
    kinds = {"plane": {}, "space": {"planar": 0}}
    drags = sorted({p.viscoelasticTime for p in results.points} - {0.0})
    kinds.update({f"plane, $T_{{vis}}$ = {d * 1e12:g} ps": {"viscoelasticTime": d} for d in drags})
    shown = [
        (name, sorted(results.main(**{"growth_velocity": 0.0, "neck": 0.7, **values}), key=lambda p: p.velocity))
        for name, values in kinds.items()
    ]
    shown = [(name, points) for name, points in shown if points]
    if len(shown) < 2:
        return None
    figure, axes = panels(1, 3, 4.6)
    for place, (quantity, label) in zip(axes[0], QUANTITIES.items()):
        for number, (name, points) in enumerate(shown):
            draw_points(place, [p.velocity for p in points], points, quantity, order_colour(2 * number), name)
        velocity_axis(place, [p.velocity for _, points in shown for p in points])
        place.set_ylabel(label)
        place.set_ylim(0, None)
    legend(axes[0, 0], fontsize=8)
    letter(axes, r"BCCA, $\beta$ = 0.7")
    return figure


@styled
def compacted(results):
    """The same of compacted aggregates of beta = 0.7 against V_g, at 10 and 30 m/s, in the plane and in space."""
    shown = []
    for velocity, (planar, where) in product((10.0, 30.0), ((1, "plane"), (0, "space"))):
        points = sorted(results.main(planar=planar, neck=0.7, velocity=velocity), key=lambda p: p.growth_velocity)
        shown.append((planar, f"{where}, {velocity:g} m/s", points))
    if not any(point.growth_velocity for planar, _, points in shown if not planar for point in points):
        return None
    figure, axes = panels(1, 3, 4.6)
    for place, (quantity, label) in zip(axes[0], QUANTITIES.items()):
        for number, (planar, name, points) in enumerate(shown):
            line = "-" if planar else "--"
            at = [p.growth_velocity for p in points]
            draw_points(place, at, points, quantity, order_colour(number), name, line)
        place.set_xlabel("growth velocity $V_g$  [m/s]  (0: BCCA)")
        place.set_ylabel(label)
        place.set_ylim(0, None)
    legend(axes[0, 0], fontsize=8)
    letter(axes, r"$\beta$ = 0.7")
    return figure


FIGURES = (
    StudyFigure(
        "space", "Sintered BCCA aggregates in the plane, in space and with drag. Bars: standard errors.", beyond
    ),
    StudyFigure(
        "space_compacted", "Sintered compacted aggregates in the plane and in space. Bars: standard errors.", compacted
    ),
)
