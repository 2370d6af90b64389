"""Pressure against filling factor for different parameters: K13 Figs 5, 6, 7, 9."""

from ....figures.style import styled
from ...definition import StudyFigure
from ..curve import FILLINGS
from ..results import family
from .common import colours_of, draw_formulae, letter, panels, pressure_axes

_TEXTS = {
    "strainRate": lambda value: f"$C_v$ = {value:g}",
    "grains": lambda value: f"N = {value}",
    "linearDamping": lambda value: f"$k_n$ = {value:g}",
    "criticalRolling": lambda value: f"$\\xi_{{crit}}$ = {value * 1e10:.3g} Å",
    "stepFraction": lambda value: f"step {value:g} $t_0$",
}


def varied(name):
    """Figure of the groups that differ in one parameter; None where there are none."""

    @styled
    def draw(results):
        groups = [group for group in family(results, name) if group.covered.any()]
        if len(groups) < 2:
            return None
        figure, axes = panels(1, 1, 6.4, 4.8)
        place = axes[0, 0]
        scales = {}
        for group, colour in zip(groups, colours_of(groups)):
            shown = group.covered & (group.mean_pressure > 0)
            text = f"{_TEXTS[name](group.parameters[name])} ({group.seeds})"
            place.plot(FILLINGS[shown], group.mean_pressure[shown], "o-", color=colour, markersize=4, label=text)
            scales.setdefault(round(group.scale, 3), (group.scale, colour))
        for scale, colour in scales.values():
            low = min(FILLINGS[group.covered][0] for group in groups)
            draw_formulae(
                place, scale, low, 0.6, dense=len(scales) == 1, **({"color": colour} if len(scales) > 1 else {})
            )
        pressure_axes(place)
        handles, labels = place.get_legend_handles_labels()
        once = dict(zip(labels[::-1], handles[::-1]))
        place.legend(list(once.values())[::-1], list(once)[::-1], frameon=False, loc="upper left")
        others = groups[0].parameters
        letter(axes, ", ".join(_TEXTS[key](others[key]) for key in ("grains", "strainRate") if key != name))
        return figure

    return draw


FIGURES = (
    StudyFigure("fig05_rate", "K13 Fig. 5: different strain rates C_v.", varied("strainRate")),
    StudyFigure("fig06_size", "K13 Fig. 6: different numbers of grains.", varied("grains")),
    StudyFigure("fig07_damping", "K13 Fig. 7: different damping k_n.", varied("linearDamping")),
    StudyFigure("fig09_rolling", "K13 Fig. 9: different xi_crit, each with its eq 25.", varied("criticalRolling")),
    StudyFigure("step", "Different time steps.", varied("stepFraction")),
)
