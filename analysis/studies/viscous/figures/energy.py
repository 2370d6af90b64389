"""Where the energy goes: A22 Figs. 13 to 15, and against B_off."""

import numpy as np

from ....figures.style import styled
from ...definition import StudyFigure
from .. import paper
from ..grid import SAME
from ..impact_mean import at_impacts
from ..results import total_dissipation
from .common import (
    legend,
    letter,
    mean_points,
    one_run_each,
    panels,
    run_folder,
    time_colours,
    time_label,
    velocity_axis,
)

MICRO = 1e6
WAYS = {
    "rolling": ("rollingDissipation",),
    "sliding": ("slidingDissipation",),
    "twisting": ("twistingDissipation",),
    "connection, disconnection": ("connection", "disconnection"),
    "drag": ("drag",),
}


@styled
def over_time(results):
    """What has been lost in each of the five ways, against time, over N_tot F_c delta_c: Fig. 13."""
    shown = one_run_each(results)
    if not shown:
        return None
    colours = time_colours(results.table)
    figure, axes = panels(1, len(WAYS), 3.5, 3.8)
    for time, row in shown:
        history, unit = run_folder(row).history, 2 * row.grains * row.energy_unit
        for place, (name, channels) in zip(axes[0], WAYS.items()):
            lost = sum(history[c] - history[c][0] for c in channels) / unit
            place.plot(history["time"] * MICRO, lost, color=colours[time], label=time_label(time))
            place.set_title(name, fontsize=10)
            place.set_xlabel(r"$t$  [$\mu$s]")
    top = max(place.get_ylim()[1] for place in axes[0])
    for place in axes[0]:
        place.set_ylim(0.0, top)
    axes[0, 0].set_ylabel(r"$E_{dis}/(N_{tot} F_c \delta_c)$")
    legend(axes[0, 0], fontsize=8)
    axes[0, -1].text(
        0.97,
        0.97,
        f"{results.reference_size} grains each",
        transform=axes[0, -1].transAxes,
        ha="right",
        va="top",
        color="0.3",
    )
    return figure


def _of_square(results):
    """Table of the runs at B_off^2 = 3/12 of the largest size that has several velocities there; None without."""
    table = results.table[(results.table.impact**2 - paper.SQUARE).abs() < SAME]
    several = [grains for grains, runs in table.groupby("grains") if runs.velocity.round(6).nunique() > 1]
    return table[table.grains == max(several)] if several else None


def _against_velocity(place, runs, values, colours):
    for time, colour in colours.items():
        own = runs[(runs.viscoelasticTime - time).abs() < 1e-16]
        velocities = np.unique(own.velocity.round(6))
        samples = [values[own.index][own.velocity.round(6) == v] for v in velocities]
        if samples and any(np.any(sample > 0) for sample in samples):
            mean_points(place, velocities, samples, colour, time_label(time))
    velocity_axis(place, runs.velocity)
    place.set_yscale("log")


@styled
def at_end(results):
    """The same at the end, against velocity: Fig. 14."""
    runs = _of_square(results)
    if runs is None:
        return None
    figure, axes = panels(1, len(WAYS), 3.5, 3.8)
    unit = 2 * runs.grains * runs.energy_unit
    for place, (name, channels) in zip(axes[0], WAYS.items()):
        _against_velocity(place, runs, runs[list(channels)].sum(axis=1) / unit, time_colours(results.table))
        place.set_title(name, fontsize=10)
    low = min(place.get_ylim()[0] for place in axes[0])
    high = max(place.get_ylim()[1] for place in axes[0])
    for place in axes[0]:
        place.set_ylim(max(low, 1e-3), high)
    axes[0, 0].set_ylabel(r"$E_{dis}/(N_{tot} F_c \delta_c)$ at the end")
    legend(axes[0, 0], fontsize=8)
    return figure


@styled
def events(results):
    """Contacts formed and broken over N_tot, against velocity: Fig. 15."""
    runs = _of_square(results)
    if runs is None:
        return None
    runs = runs[np.isfinite(runs.formed.astype(float))]
    if runs.empty:
        return None
    figure, axes = panels(1, 2, 4.6, 4.0)
    for place, (name, values) in zip(axes[0], (("$N_{con}$", runs.formed), ("$N_{cut}$", runs.broken))):
        _against_velocity(place, runs, values.astype(float) / (2 * runs.grains), time_colours(results.table))
        place.axhline(1.0, color="0.6", lw=0.8)
        place.set_ylabel(name + "$/N_{tot}$")
    legend(axes[0, 0], fontsize=8)
    letter(axes, f"{runs.grains.max()} grains each, $B_{{off}}^2$ = 3/12")
    return figure


@styled
def against_impact(results):
    """Fraction of K(0) that each way takes, against B_off^2, at 50.1 m/s, a panel for each T_vis."""
    table, grains = results.table, results.main_size
    if grains is None:
        return None
    runs = table[(table.grains == grains) & ((table.velocity / paper.VELOCITY - 1).abs() < SAME)]
    times = sorted(runs.viscoelasticTime.round(16).unique())
    if not times:
        return None
    colours = ("#d7301f", "#f2b134", "#fc8d59", "#8c4a9e", "#7a5230")
    figure, axes = panels(1, len(times), 4.0, 4.0)
    for place, time in zip(axes[0], times):
        own = runs[(runs.viscoelasticTime - time).abs() < 1e-16]
        for colour, (name, channels) in zip(colours, WAYS.items()):
            points = at_impacts(own, own[list(channels)].sum(axis=1) / own.kinetic_at_start)
            mean_points(place, [p[0] for p in points], [p[1] for p in points], colour, name)
        points = at_impacts(own, total_dissipation(own) / own.kinetic_at_start)
        place.plot([p[0] for p in points], [p[1].mean() for p in points], color="0.6", lw=3, zorder=0, label="all")
        place.set_xlabel("$B_{off}^2$")
        place.set_ylim(0.0, None)
        place.text(0.97, 0.95, time_label(time), transform=place.transAxes, ha="right", va="top")
    axes[0, 0].set_ylabel("lost, fraction of $K(0)$")
    legend(axes[0, -1], fontsize=8, loc="upper right", bbox_to_anchor=(1.0, 0.9))
    letter(axes, f"{grains} grains each, 50.1 m/s")
    return figure


FIGURES = (
    StudyFigure("fig13_over_time", "A22 Fig. 13: energy lost in each of five ways, against time.", over_time),
    StudyFigure("fig14_at_end", "A22 Fig. 14: energy lost in each way by the end, against velocity.", at_end),
    StudyFigure("fig15_events", "A22 Fig. 15: contacts formed and broken.", events),
    StudyFigure("channels", "What each way takes of the kinetic energy, against B_off^2.", against_impact),
)
