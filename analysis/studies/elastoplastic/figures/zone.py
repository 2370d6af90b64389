"""d_max against the filling of the two zones that meet: how much of the scatter the packings explain, and what they predict."""

import numpy as np

from ....figures.style import styled
from ...definition import StudyFigure
from .. import prediction
from .common import OURS, PAPER, filling_text, legend, panels, size_colours


@styled
def zone_figure(results):
    """d_max less the mean of its size against R times the filling of the zones less its mean, with the common slope, one
    panel a filling; values predicted beforehand as open squares. None without zones."""
    shown = {
        factor: filling for factor, filling in results.by_filling.items() if next(iter(filling.covariates.values()))
    }
    if not shown:
        return None
    figure, axes = panels(1, len(shown), 5.4, 4.4)
    for place, (factor, filling) in zip(axes[0], shown.items()):
        slope = next(iter(filling.covariates.values()))
        velocity, unit = filling.size_fit.velocity, results.grain_radius
        colours = size_colours(each.radius for each in filling.adjusted)
        for each in filling.adjusted:
            runs = results.runs(factor, each.radius * unit, velocity)
            x = each.radius * (runs.zone_filling - 1.0 - each.zone)
            place.plot(
                x,
                runs.d_max / unit - each.mean,
                "D",
                markersize=5,
                color=colours[each.radius],
                label=f"$R$ = {each.radius:g} $r$",
            )
        reach = np.array(place.get_xlim())
        place.plot(
            reach, slope.slope * reach, color=OURS, label=f"slope {slope.slope:.3f} $\\pm$ {slope.slope_error:.3f}"
        )
        _draw_predictions(place, filling, results)
        place.set_xlabel("$R$ (zone filling less its mean)  [grain radii]")
        place.set_ylabel("$d_{max}$ less its mean  [grain radii]")
        place.set_title(
            f"correlation {slope.correlation:.2f} $\\pm$ {slope.correlation_error:.2f}", loc="left", fontsize=10
        )
        place.set_title(filling_text(factor, velocity), loc="right", fontsize=10, color="0.3")
        legend(place, fontsize=8.5)
    return figure


def _draw_predictions(axes, filling, results):
    by_radius = {each.radius: each for each in filling.adjusted}
    for chosen in prediction.SETS:
        rows = prediction.read(chosen.path)
        if chosen.covariate != "zone_filling" or chosen.radius not in by_radius or rows is None:
            continue
        each, own = by_radius[chosen.radius], rows[rows.filling.round(6) == filling.factor]
        if len(own):
            x = each.radius * (own.zone_filling - 1.0 - each.zone)
            y, error = own.d_max / results.grain_radius - each.mean, own.d_max_error / results.grain_radius
            options = {"fmt": "s", "markerfacecolor": "none", "color": PAPER, "elinewidth": 0.7, "markersize": 5}
            axes.errorbar(x, y, yerr=error, label=f"predicted, $R$ = {each.radius:g} $r$", **options)


FIGURES = (StudyFigure("zone_filling", "Largest compression against the filling of the zones that meet.", zone_figure),)
