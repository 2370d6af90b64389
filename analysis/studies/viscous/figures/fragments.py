"""Size distributions of fragments: A22 Figs. 6 to 9."""

import numpy as np

from ....figures.style import styled
from ...definition import StudyFigure
from .. import paper
from ..results import at_velocities
from ..size_distribution import fitted_curves
from .common import PAPER, legend, letter, panels, size_label, time_colours, time_label

LABELS = {
    "number": (r"$\langle Z_{cum}(\geq N) \rangle$", 0),
    "grains": (r"$\langle N_{cum}(\leq N) \rangle$", 1),
    "cross_section": (r"$\langle S_{cum}(\leq N) \rangle / S_1$", 2),
}


def distributions(results, growth):
    """{velocity: SizeDistribution} of a Growth."""
    return results.distributions[growth.grains, growth.viscous_time]


def _draw(place, quantity, distributions, total, curve=True):
    """distributions: [(SizeDistribution, colour, label)]."""
    label, number = LABELS[quantity]
    for distribution, colour, name in distributions:
        values = getattr(distribution, quantity)
        place.plot(distribution.numbers, np.where(values > 0, values, np.nan), color=colour, label=name)
    numbers = np.geomspace(1, total, 200)
    if curve:
        place.plot(numbers, fitted_curves(numbers, total)[number], "--", color=PAPER, lw=1.2, label="A22: $f(N)=1/N$")
    place.set_xscale("log")
    place.set_yscale("log")
    place.set_xlim(1, total)
    place.set_ylim(0.3 if quantity != "number" else 0.5, None)
    place.set_xlabel("grains of a fragment $N$")
    place.set_ylabel(label)


def of_velocities(quantity):
    """Figure of one quantity at 50.1 and 100 m/s, for every T_vis: Figs. 6, 7, 8."""

    @styled
    def figure(results):
        shown = results.of_size(results.main_size) if results.sizes else []
        velocities = [
            v
            for v in (paper.VELOCITY, 100.0)
            if any(at_velocities(v, distributions(results, growth)) for growth in shown)
        ]
        if not velocities:
            return None
        colours = time_colours(results.table)
        drawn, axes = panels(1, len(velocities), 4.8, 4.2)
        for place, velocity in zip(axes[0], velocities):
            own = [
                (d, colours[growth.viscous_time], time_label(growth.viscous_time))
                for growth in shown
                for u, d in distributions(results, growth).items()
                if at_velocities(u, (velocity,))
            ]
            _draw(place, quantity, own, 2 * results.main_size)
            place.text(0.5, 0.96, f"{velocity:.3g} m/s", transform=place.transAxes, ha="center", va="top")
        legend(axes[0, 0], fontsize=8)
        letter(axes, size_label(results.main_size, shown))
        return drawn

    return figure


@styled
def around_threshold(results):
    """The three distributions at the largest T_vis and velocities around v_fra: Fig. 9."""
    if not results.sizes:
        return None
    growth = results.of_size(results.main_size)[-1]
    near = growth.v_fra or paper.VELOCITY
    found = distributions(results, growth)
    velocities = [v for v in found if 0.6 < v / near < 1.7]
    if not velocities:
        return None
    drawn, axes = panels(1, 3, 4.4, 4.2)
    shades = [str(0.75 - 0.75 * i / max(1, len(velocities) - 1)) for i in range(len(velocities))]
    for place, quantity in zip(axes[0], LABELS):
        own = [(found[v], shade, f"{v:.3g} m/s") for v, shade in zip(velocities, shades)]
        _draw(place, quantity, own, 2 * results.main_size)
    legend(axes[0, 0], fontsize=8)
    letter(axes, f"{time_label(growth.viscous_time)}, {size_label(results.main_size, [growth])}")
    return drawn


FIGURES = (
    StudyFigure(
        "fig06_number", "A22 Fig. 6: number of fragments of N grains or more, mean over B_off.", of_velocities("number")
    ),
    StudyFigure("fig07_grains", "A22 Fig. 7: grains in fragments of at most N grains.", of_velocities("grains")),
    StudyFigure(
        "fig08_cross_section",
        "A22 Fig. 8: cross-section of fragments of at most N grains.",
        of_velocities("cross_section"),
    ),
    StudyFigure(
        "fig09_fits", "A22 Fig. 9: the three with A22's fits, around v_fra, at the largest T_vis.", around_threshold
    ),
)
