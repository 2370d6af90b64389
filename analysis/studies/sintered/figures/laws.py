"""Springs that are held at their limits beside springs that are cut, as S17's section 3.2 has it."""

from ....figures.style import styled
from ...definition import StudyFigure
from .. import paper
from .common import beta_label, draw_points, legend, letter, neck_colour, order_colour, panels, velocity_axis

LAWS = {"cut": ({"cut": 1}, "-", "o"), "held": ({"cut": 0}, "--", "s")}


@styled
def held_and_cut(results):
    """Sticking efficiency of BCCA aggregates against velocity and beta, with either rule."""
    bcca = {name: results.main(growth_velocity=0.0, **law) for name, (law, _, _) in LAWS.items()}
    if not all(bcca.values()):
        return None
    figure, axes = panels(1, 2)
    for name, (_, line, marker) in LAWS.items():
        for neck in (0.0, 0.7):
            points = sorted((p for p in bcca[name] if p.neck == neck), key=lambda p: p.velocity)
            at = [p.velocity for p in points]
            label = f"{beta_label(neck)}, {name}"
            draw_points(axes[0, 0], at, points, "largest", neck_colour(neck), label, line, marker)
        for number, velocity in enumerate((10.0, 30.0)):
            points = sorted((p for p in bcca[name] if p.velocity == velocity), key=lambda p: p.neck)
            at, colour = [p.neck for p in points], order_colour(4 * number)
            draw_points(axes[0, 1], at, points, "largest", colour, f"{velocity:g} m/s, {name}", line, marker)
    for neck, velocity in paper.CRITICAL_VELOCITIES.items():
        axes[0, 0].plot([velocity], [0.5], "x", color=neck_colour(neck), markersize=9, label=f"S17, {beta_label(neck)}")
    velocity_axis(axes[0, 0], [p.velocity for points in bcca.values() for p in points])
    axes[0, 1].set_xlabel(r"$\beta$  (0: unsintered)")
    for place in axes[0]:
        place.axhline(0.5, color="0.7", lw=0.8, zorder=0)
        place.set_ylabel("sticking efficiency")
        place.set_ylim(0, 1.05)
        legend(place, fontsize=7)
    letter(axes, "BCCA")
    return figure


FIGURES = (
    StudyFigure(
        "held",
        "Sticking efficiency with springs that are cut and held at their limits; crosses: S17's critical velocities. Bars: standard errors.",
        held_and_cut,
    ),
)
