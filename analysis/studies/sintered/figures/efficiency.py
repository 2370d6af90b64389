"""Sticking efficiency, structure and fragments: S17 Figs 6, 8, 10, 11, 12, 13."""

from ....figures.style import styled
from ...definition import StudyFigure
from .common import (
    beta_label,
    draw_points,
    growth_label,
    legend,
    letter,
    lines_of,
    neck_colour,
    order_colour,
    panels,
    velocity_axis,
)

AXES = {
    "largest": "sticking efficiency",
    "gyration_radius": "$R_g/R$ of the largest piece",
    "fragments": "mass in fragments",
    "contacts": "contacts a grain",
}


def _against_velocity(place, lines, quantity, colour, label):
    for value, points in lines:
        draw_points(place, [p.velocity for p in points], points, quantity, colour(value), label(value))
    velocity_axis(place, [p.velocity for _, points in lines for p in points])
    place.set_ylabel(AXES[quantity])


@styled
def of_velocity(results):
    """Sticking efficiency and radius of gyration of BCCA aggregates against velocity: Fig. 8."""
    lines = lines_of(results.main(growth_velocity=0.0), "neck")
    if not lines:
        return None
    figure, axes = panels(1, 2)
    for place, quantity in zip(axes[0], ("largest", "gyration_radius")):
        _against_velocity(place, lines, quantity, neck_colour, beta_label)
    axes[0, 0].axhline(0.5, color="0.7", lw=0.8, zorder=0)
    axes[0, 0].set_ylim(0, 1.05)
    axes[0, 1].set_ylim(0, None)
    legend(axes[0, 0])
    letter(axes, "BCCA, 1,024 grains each")
    return figure


@styled
def of_growth(results):
    """Sticking efficiency of aggregates of beta = 0.7 with several V_g against velocity: Fig. 10."""
    lines = lines_of(results.main(neck=0.7), "growth_velocity")
    if len(lines) < 2:
        return None
    order = [value for value, _ in lines]
    figure, axes = panels(1, 1)
    _against_velocity(axes[0, 0], lines, "largest", lambda value: order_colour(order.index(value)), growth_label)
    axes[0, 0].axhline(0.5, color="0.7", lw=0.8, zorder=0)
    axes[0, 0].set_ylim(0, 1.05)
    legend(axes[0, 0])
    letter(axes, r"$\beta$ = 0.7")
    return figure


def _of_beta(quantity, rolling):
    lines = lines_of([p for p in rolling if p.velocity in (10.0, 30.0)], "velocity")

    def draw(place):
        for number, (velocity, points) in enumerate(lines):
            draw_points(
                place, [p.neck for p in points], points, quantity, order_colour(4 * number), f"{velocity:g} m/s"
            )
        place.set_xlabel(r"$\beta$  (0: unsintered)")
        place.set_ylabel(AXES[quantity])

    return lines, draw


def _figure_of_beta(quantity):
    @styled
    def figure(results):
        drawn = [
            (rolling, *_of_beta(quantity, results.main(growth_velocity=0.0, criticalRolling=rolling)))
            for rolling in (2e-10, 30e-10)
        ]
        drawn = [(rolling, draw) for rolling, lines, draw in drawn if lines]
        if not drawn:
            return None
        made, axes = panels(1, len(drawn))
        for place, (rolling, draw) in zip(axes[0], drawn):
            draw(place)
            place.set_title(rf"$\xi_c$ = {rolling * 1e10:g} $\AA$", fontsize=10)
            place.set_ylim(0, None)
        legend(axes[0, 0])
        letter(axes, "BCCA")
        return made

    return figure


@styled
def compacted(results):
    """Sticking efficiency of compacted aggregates with V_c = V_g against beta: Fig. 13."""
    points = [p for p in results.main() if p.growth_velocity and p.velocity == p.growth_velocity]
    lines = lines_of(points, "growth_velocity")
    if not lines:
        return None
    figure, axes = panels(1, 1)
    for number, (value, own) in enumerate(lines):
        draw_points(axes[0, 0], [p.neck for p in own], own, "largest", order_colour(number), growth_label(value))
    axes[0, 0].set_xlabel(r"$\beta$  (0: unsintered)")
    axes[0, 0].set_ylabel(AXES["largest"])
    axes[0, 0].set_ylim(0, 1.05)
    legend(axes[0, 0], fontsize=8)
    letter(axes, "$V_c = V_g$")
    return figure


@styled
def contacts(results):
    """Contacts a grain against V_g, for each xi_crit: Fig. 6."""
    lines = []
    for rolling in (2e-10, 30e-10):
        best = {}  # of the points with one V_g, which share their aggregates, that with the most runs
        for point in results.main(criticalRolling=rolling):
            held = best.get(point.growth_velocity)
            best[point.growth_velocity] = point if held is None or point.runs > held.runs else held
        lines.append((rolling, [best[value] for value in sorted(best)]))
    lines = [(rolling, own) for rolling, own in lines if len(own) > 1]
    if not lines:
        return None
    figure, axes = panels(1, 1)
    for number, (rolling, own) in enumerate(lines):
        label = rf"$\xi_c$ = {rolling * 1e10:g} $\AA$"
        draw_points(axes[0, 0], [p.growth_velocity for p in own], own, "contacts", order_colour(4 * number), label)
    axes[0, 0].set_xlabel("growth velocity $V_g$  [m/s]  (0: BCCA)")
    axes[0, 0].set_ylabel(AXES["contacts"])
    legend(axes[0, 0])
    return figure


FIGURES = (
    StudyFigure(
        "fig06_contacts",
        "S17 Fig. 6: contacts a grain of the aggregates, against V_g. Bars: standard errors.",
        contacts,
    ),
    StudyFigure(
        "fig08_velocity",
        "S17 Fig. 8: sticking efficiency and gyration radius against velocity. Bars: standard errors.",
        of_velocity,
    ),
    StudyFigure(
        "fig10_growth", "S17 Fig. 10: sticking efficiency of compacted aggregates. Bars: standard errors.", of_growth
    ),
    StudyFigure(
        "fig11_beta",
        "S17 Fig. 11: sticking efficiency against beta. Bars: standard errors.",
        _figure_of_beta("largest"),
    ),
    StudyFigure(
        "fig12_fragments",
        "S17 Fig. 12: mass in fragments against beta. Bars: standard errors.",
        _figure_of_beta("fragments"),
    ),
    StudyFigure(
        "fig13_compacted",
        "S17 Fig. 13: compacted aggregates that collide at V_c = V_g. Bars: standard errors.",
        compacted,
    ),
)
