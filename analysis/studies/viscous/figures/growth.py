"""Growth efficiency and thresholds: A22 Figs. 2 to 5."""

import numpy as np

from ....figures.style import styled
from ...definition import StudyFigure
from .. import paper
from ..impact_mean import at_impacts, offsets_text
from ..results import picoseconds
from .common import (
    PAPER,
    draw_curve,
    impact_colour,
    legend,
    letter,
    mean_points,
    panels,
    size_label,
    threshold_points,
    time_colours,
    time_label,
    velocity_axis,
)


@styled
def growth_figure(results):
    """f_gro against velocity for every B_off, and its mean over them, a panel for each T_vis: Fig. 2."""
    grains, table = results.main_size, results.table
    if grains is None:
        return None
    of_size = results.of_size(grains)
    figure, axes = panels(1, len(of_size), 4.2, 4.4)
    for place, growth in zip(axes[0], of_size):
        label = "mean" if offsets_text(growth.offsets) else "mean (29)"
        runs = table[(table.grains == grains) & ((table.viscoelasticTime - growth.viscous_time).abs() < 1e-16)]
        for square in np.unique((runs.impact**2).round(6)):
            own = runs[((runs.impact**2) - square).abs() < 1e-5]
            velocities = np.unique(own.velocity.round(6))
            samples = [own.growth[own.velocity.round(6) == v] for v in velocities]
            mean_points(place, velocities, samples, impact_colour(square), f"{12 * square:.3g}/12")
        place.plot(growth.velocities, growth.mean, color="0.55", lw=4, zorder=0, label=label)
        place.axhline(0.0, color="0.7", lw=0.8, zorder=0)
        velocity_axis(place, table.velocity)
        place.set_ylim(-1.05, 1.05)
        place.text(0.03, 0.03, time_label(growth.viscous_time), transform=place.transAxes)
    axes[0, 0].set_ylabel("growth efficiency $f_{gro}$")
    legend(axes[0, -1], title="$B_{off}^2$", fontsize=7, loc="center left", bbox_to_anchor=(1.0, 0.5))
    letter(axes, size_label(grains, of_size))
    return figure


@styled
def mean_growth_figure(results):
    """<f_gro> against velocity for every T_vis, a panel for each size: Fig. 3."""
    if not results.sizes:
        return None
    figure, axes = panels(1, len(results.sizes), 5.0, 4.2)
    colours = time_colours(results.table)
    for place, grains in zip(axes[0], results.sizes):
        for growth in results.of_size(grains):
            draw_curve(place, growth, colours[growth.viscous_time], time_label(growth.viscous_time))
        place.axhline(0.0, color="0.6", lw=0.8)
        place.axvspan(*paper.V_FRA, color=PAPER, alpha=0.12, lw=0, label="A22: $v_{fra}$")
        velocity_axis(place, results.table.velocity)
        place.text(0.03, 0.05, size_label(grains, results.of_size(grains)), transform=place.transAxes)
    axes[0, 0].set_ylabel(r"$\langle f_{gro} \rangle$")
    legend(axes[0, 0], fontsize=8)
    letter(axes, "")
    return figure


@styled
def head_on_figure(results):
    """f_gro of head-on collisions against velocity for every T_vis, a panel for each size: Fig. 4."""
    sizes = sorted({grains for grains, _ in results.head_on})
    if not sizes:
        return None
    figure, axes = panels(1, len(sizes), 4.0, 4.2)
    colours = time_colours(results.table)
    for place, grains in zip(axes[0], sizes):
        for (own, time), curve in sorted(results.head_on.items()):
            if own == grains:
                draw_curve(place, curve, colours[time], time_label(time))
        velocity_axis(place, results.table.velocity)
        place.axhline(0.0, color="0.6", lw=0.8)
        place.set_ylim(-0.9, 1.05)
        place.text(0.03, 0.05, f"{grains} grains each", transform=place.transAxes)
    axes[0, 0].set_ylabel("$f_{gro}$ at $B_{off}$ = 0")
    legend(axes[0, 0], fontsize=8, loc="center left")
    letter(axes, "")
    return figure


@styled
def thresholds_figure(results):
    """v_stick and v_fra against T_vis, of every size: Fig. 5."""
    figure, axes = panels(1, 1)
    place = axes[0, 0]
    known = results.table.drop_duplicates("viscoelasticTime").sort_values("viscoelasticTime")
    times, sticking = known.viscoelasticTime.to_numpy() * 1e12, known.sticking_velocity.to_numpy()
    finite = np.isfinite(sticking)
    place.plot(times[finite], sticking[finite], "s--", color="0.35", label="$v_{stick}$, two grains")
    top = max([150.0, *sticking[finite]]) * 1.3
    for time in times[~finite]:
        place.annotate("always\nstick", (time, top / 1.1), ha="center", va="top", fontsize=7, color="0.35")
        place.plot(time, top / 1.05, "^", color="0.35", clip_on=False)
    shades = ("#9ecae1", "#4292c6", "#2166ac", "#08306b")
    for i, grains in enumerate(results.sizes):
        found = [growth for growth in results.of_size(grains) if growth.v_fra is not None]
        for offsets in sorted({growth.offsets for growth in found}, key=len):
            own = [growth for growth in found if growth.offsets == offsets]
            colour = shades[min(i, 3) if len(results.sizes) > 1 else 2]
            label = f"$v_{{fra}}$, {grains} grains{offsets_text(offsets)}"
            threshold_points(place, [growth.viscous_time * 1e12 for growth in own], own, colour, label)
    place.axhspan(*paper.V_FRA, color=PAPER, alpha=0.12, lw=0, label="A22: $v_{fra}$")
    place.set_yscale("log")
    place.set_ylim(min([3.0, *(0.7 * sticking[finite])]), top)
    ticks = [tick for tick in (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000) if place.get_ylim()[0] <= tick <= top]
    place.set_yticks(ticks, [str(tick) for tick in ticks])
    place.set_yticks([], minor=True)
    place.set_xlabel("$T_{vis}$  [ps]")
    place.set_ylabel("threshold velocity  [m/s]")
    legend(place, fontsize=8)
    return figure


@styled
def collapse_figure(results):
    """<f_gro> against velocity, and against velocity over v_stick(T_vis): one curve if single contacts decided."""
    grains = results.main_size
    if grains is None:
        return None
    figure, axes = panels(1, 2, 4.8, 4.2)
    colours = time_colours(results.table)
    for growth in results.of_size(grains):
        # Where two grains always stick there is no v_stick to scale with.
        for place, scale in zip(axes[0], (1.0, growth.sticking_velocity)):
            if np.isfinite(scale):
                draw_curve(place, growth, colours[growth.viscous_time], f"{picoseconds(growth.viscous_time)} ps", scale)
            place.axhline(0.0, color="0.6", lw=0.8)
    velocity_axis(axes[0, 0], results.table.velocity)
    axes[0, 1].set_xscale("log")
    axes[0, 1].set_xlabel("$v_{col}/v_{stick}(T_{vis})$")
    axes[0, 0].set_ylabel(r"$\langle f_{gro} \rangle$")
    legend(axes[0, 0], fontsize=8, title="$T_{vis}$")
    letter(axes, size_label(grains, results.of_size(grains)))
    return figure


@styled
def impact_figure(results):
    """f_gro against B_off^2 at velocities around v_fra, for every T_vis."""
    grains = results.main_size
    if grains is None:
        return None
    table = results.table[results.table.grains == grains]
    velocities = [v for v in np.unique(table.velocity.round(6)) if 30 < v < 101]
    if not velocities:
        return None
    figure, axes = panels(1, len(velocities), 3.6, 3.8)
    for place, velocity in zip(axes[0], velocities):
        for time, colour in time_colours(table).items():
            own = table[(table.velocity.round(6) == velocity) & ((table.viscoelasticTime - time).abs() < 1e-16)]
            points = at_impacts(own, own.growth)
            if points:
                mean_points(place, [p[0] for p in points], [p[1] for p in points], colour, time_label(time))
        place.axhline(0.0, color="0.6", lw=0.8)
        place.set_ylim(-1.05, 1.05)
        place.set_xlabel("$B_{off}^2$")
        place.text(0.97, 0.95, f"{velocity:.3g} m/s", transform=place.transAxes, ha="right", va="top")
    axes[0, 0].set_ylabel("$f_{gro}$")
    legend(axes[0, 0], fontsize=8, loc="lower left")
    letter(axes, "")
    return figure


FIGURES = (
    StudyFigure("fig02_growth", "A22 Fig. 2: growth efficiency of every B_off and velocity.", growth_figure),
    StudyFigure(
        "fig03_mean_growth", "A22 Fig. 3: growth efficiency, mean over B_off, of every size.", mean_growth_figure
    ),
    StudyFigure("fig04_head_on", "A22 Fig. 4: growth efficiency of head-on collisions, of every size.", head_on_figure),
    StudyFigure("fig05_thresholds", "A22 Fig. 5: v_stick of two grains and v_fra of aggregates.", thresholds_figure),
    StudyFigure(
        "collapse", "Growth efficiency with speeds scaled by v_stick(T_vis): no theory of one contact.", collapse_figure
    ),
    StudyFigure("impact", "Growth efficiency against B_off^2 around v_fra.", impact_figure),
)
