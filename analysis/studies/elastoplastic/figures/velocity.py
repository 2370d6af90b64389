"""delta_max and tau_max against velocity, and the pairs of yield stress and E*: A24 Figs. 8, 9, 10."""

import numpy as np

from ....figures.style import NANO, styled
from ....theory.andrews import (
    Spheres,
    elastic_compression,
    elastic_time,
    largest_compression,
    plastic_compression,
    plastic_time,
    time_of_largest_compression,
)
from ...definition import StudyFigure
from .. import paper
from ..velocity_fit import degenerate_curve, effective, reduced_radius
from .common import (
    ELASTIC,
    MEGA,
    OURS,
    PAPER,
    RIGID,
    filling_text,
    legend,
    letter,
    of_main_filling,
    of_other_filling,
    panels,
    scatter_of_seeds,
    size_colours,
    velocity_axis,
)


@styled
def velocity_figure(results, filling):
    """delta_max/r and tau_max of all runs against velocity, the best fits, and the limits that give the same
    delta_max as our fit (or A24's) at A24's velocity: Figs. 8, 9."""
    points, unit = filling.points, results.grain_radius
    radii = sorted({round(float(radius / unit), 3) for radius in points.radius})
    shown = [radius for radius in radii if np.sum(np.isclose(points.radius / unit, radius)) > 1] or radii
    colours = size_colours(shown)
    figure, axes = panels(1, 2, 5.6, 4.8)
    left, right = axes[0]
    named = set()
    for k in range(len(points)):
        radius = round(float(points.radius[k] / unit), 3)
        if radius not in colours:
            continue
        delta, tau = effective(*points.samples[k], points.velocity[k], filling.offset, unit)
        label = None if radius in named else f"$R$ = {radius:g} $r$"
        named.add(radius)
        scatter_of_seeds(left, points.velocity[k], delta / unit, colours[radius], label)
        scatter_of_seeds(right, points.velocity[k], tau * NANO, colours[radius])
    v = np.geomspace(points.velocity.min() / 1.1, points.velocity.max() * 1.1, 120)
    for radius in (min(shown), max(shown)) if len(shown) > 1 else shown:
        _draw_models(left, right, v, results, filling, radius, radius == max(shown))
    velocity_axis(left, points.velocity)
    velocity_axis(right, points.velocity)
    means = (points.d_max + 2.0 * filling.offset) / unit
    if np.any(means > 0):
        left.set_yscale("log")
        left.set_ylim(0.5 * means[means > 0].min(), 2.0 * means.max())
        low, high = left.get_ylim()
        left.set_yticks([t for t in (0.05, 0.1, 0.2, 0.5, 1, 2, 3, 5, 10, 20, 50) if low <= t <= high])
        left.set_yticks([], minor=True)
        left.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    right.set_ylim(0.0, None)
    left.set_ylabel("largest compression $\\delta_{max}$  [grain radii]")
    right.set_ylabel("time to it $\\tau_{max}$  [ns]")
    legend(left, fontsize=8)
    letter(axes, filling_text(filling.factor))
    return figure


def _draw_models(left, right, v, results, filling, radius, named):
    """Curves of both panels for one size; their labels only once."""
    unit, density = results.grain_radius, filling.factor * results.grain_density
    half = reduced_radius(radius * unit, filling.offset)
    fit = filling.velocity_fit
    curves = []
    if fit.reason is None:
        spheres = Spheres(half, density, *fit.values)
        curves.append(
            (
                largest_compression(v, spheres),
                time_of_largest_compression(v, spheres),
                OURS,
                "-",
                f"fit: {fit.values[0] / MEGA:.3g}, {fit.values[1] / MEGA:.3g} MPa",
            )
        )
    if filling.factor in paper.YOUNG:
        theirs = paper.YIELD_STRESS[filling.factor], paper.YOUNG[filling.factor]
        spheres = Spheres(half, density, *theirs)
        curves.append(
            (
                largest_compression(v, spheres),
                time_of_largest_compression(v, spheres),
                PAPER,
                "--",
                f"A24: {theirs[0] / MEGA:g}, {theirs[1] / MEGA:g} MPa",
            )
        )
    ratio, anchor = filling.size_fit.ratio, filling.size_fit.velocity
    if ratio is None:
        ratio, anchor = paper.RATIO.get(filling.factor), paper.VELOCITY
    if ratio is not None:
        young = 5.0 * np.pi * density * anchor**2 / ratio**2.5
        sigma = 16.0 / 3.0 * density * anchor**2 / ratio**2
        limit = Spheres(half, density, sigma, young)
        curves.append((elastic_compression(v, limit), elastic_time(v, limit), ELASTIC, ":", "elastic"))
        curves.append(
            (
                plastic_compression(v, limit),
                np.broadcast_to(plastic_time(v, limit), v.shape),
                RIGID,
                "-.",
                "rigid plastic",
            )
        )
    for delta, tau, colour, style, label in curves:
        left.plot(v, delta / unit, style, color=colour, linewidth=1.4, label=label if named else None)
        right.plot(v, tau * NANO, style, color=colour, linewidth=1.4)


@styled
def moduli_figure(results):
    """Pairs (sigma_plastic, E*) that give the measured delta_max/R*, with its error, and the best fits: Fig.
    10."""
    fillings = list(results.by_filling.values())
    figure, axes = panels(1, len(fillings), 5.4, 4.6)
    for place, filling in zip(axes[0], fillings):
        density = filling.factor * results.grain_density
        size_fit, fit = filling.size_fit, filling.velocity_fit
        if size_fit.ratio is not None:
            ratio, error = size_fit.ratio, size_fit.errors["ratio"] or 0.0
            _draw_curve(
                place,
                ratio,
                size_fit.velocity,
                density,
                OURS,
                "-",
                f"$\\delta_{{max}}/R^*$ = {ratio:.4f} $\\pm$ {error:.4f}",
            )
            for other in (max(ratio - error, 0.5 * ratio), ratio + error):
                _draw_curve(place, other, size_fit.velocity, density, "0.6", "-", None)
        if filling.factor in paper.RATIO:
            _draw_curve(
                place,
                paper.RATIO[filling.factor],
                paper.VELOCITY,
                density,
                PAPER,
                "--",
                f"A24: {paper.RATIO[filling.factor]:g}",
            )
            place.plot(
                paper.YIELD_STRESS[filling.factor] / MEGA,
                paper.YOUNG[filling.factor] / MEGA,
                "*",
                markersize=15,
                markerfacecolor="none",
                color=PAPER,
                label="A24's fit",
                zorder=5,
            )
        if fit.reason is None and np.all(np.isfinite(fit.values)):
            sigma, young = (value / MEGA for value in fit.values)
            bars = [None if e is None else [e / MEGA] for e in fit.errors]
            place.errorbar(
                [sigma],
                [young],
                xerr=bars[0],
                yerr=bars[1],
                fmt="*",
                markersize=13,
                color="#c62828",
                capsize=3,
                label="fit to all velocities",
                zorder=6,
            )
        place.set_xlabel("yield stress $\\sigma_{plastic}$  [MPa]")
        place.set_ylabel("reduced Young's modulus $E^*$  [MPa]")
        place.set_yscale("log")
        place.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
        place.set_xlim(0.0, None)
        legend(place, loc="upper right")
        place.set_title(filling_text(filling.factor), loc="right", fontsize=10, color="0.3")
    return figure


def _draw_curve(axes, ratio, velocity, density, colour, style, label):
    sigma, young, elastic_from, elastic_young = degenerate_curve(ratio, velocity, density)
    seen = young < 30.0 * elastic_young
    axes.plot(sigma[seen] / MEGA, young[seen] / MEGA, style, color=colour, label=label, linewidth=1.6 if label else 0.8)
    axes.plot(
        [elastic_from / MEGA, 1.5 * elastic_from / MEGA], [elastic_young / MEGA] * 2, style, color=colour, linewidth=0.9
    )


FIGURES = (
    StudyFigure(
        "fig08_velocity",
        "A24 Fig. 8: largest compression and its time against velocity.",
        of_main_filling(velocity_figure),
    ),
    StudyFigure("fig09_velocity", "A24 Fig. 9: the same at the other filling.", of_other_filling(velocity_figure)),
    StudyFigure(
        "fig10_moduli",
        "A24 Fig. 10: pairs of yield stress and E* that give one largest compression.",
        moduli_figure,
    ),
)
