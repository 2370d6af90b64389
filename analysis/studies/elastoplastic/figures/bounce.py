"""Restitution, sticking probability and the energy of a bounce, channel by channel: beyond A24 (section
5.3)."""

import numpy as np

from ....figures.style import styled
from ....runs.format import CHANNELS, COLOURS, LABELS
from ....theory.andrews import Spheres, restitution
from ...definition import StudyFigure
from .. import paper
from .common import OURS, PAPER, filling_text, legend, letter, main_filling, panels, size_colours, velocity_axis

_SHOWN = tuple(c for c in CHANNELS if c != "kinetic")
_FILLING_COLOURS = ("#c62828", "#2166ac", "#1b8a8f", "#e08214")


@styled
def outcome_figure(results):
    """Coefficient of restitution and sticking probability against velocity (main filling, by size) and
    against size (at the velocity of the size fit, by filling), with 95 % intervals and Andrews's
    restitution."""
    filling = main_filling(results)
    velocity = results.by_filling[filling].size_fit.velocity
    figure, axes = panels(2, 2, 5.4, 3.7)
    own = [b for b in results.bounces if b.filling == filling]
    colours = size_colours(b.radius for b in own)
    for radius, colour in colours.items():
        series = [b for b in own if b.radius == radius]
        _series(axes[:, 0], [b.velocity for b in series], series, colour, f"$R$ = {radius:g} $r$")
    for number, (other, colour) in enumerate(zip(results.by_filling, _FILLING_COLOURS)):
        series = [
            b
            for b in results.bounces
            if b.filling == other and abs(b.velocity / results.by_filling[other].size_fit.velocity - 1.0) < 1e-6
        ]
        _series(axes[:, 1], [b.radius + 0.3 * number for b in series], series, colour, f"filling {other:g}")
    _draw_theory(axes[0, 0], results, filling, np.array([b.velocity for b in own]))
    for row, label in zip(axes, ("coefficient of restitution", "sticking probability")):
        for place in row:
            place.set_ylabel(label)
            place.set_ylim(-0.03, 1.05)
        velocity_axis(row[0], [b.velocity for b in own])
        row[1].set_xlabel("aggregate radius  [grain radii]")
        row[1].set_xticks(sorted({b.radius for b in results.bounces}))
    for place in axes[0]:
        legend(place, fontsize=8, loc="best")
    letter(axes, "")
    axes[0, 0].set_title(filling_text(filling), loc="right", fontsize=10, color="0.3")
    axes[0, 1].set_title(f"{velocity:.4g} m/s", loc="right", fontsize=10, color="0.3")
    return figure


def _series(axes, x, series, colour, label):
    """Restitution on the first of the axes, sticking on the second; the line is broken where no run is decided."""
    x = np.asarray(x, dtype=float)
    for place, name in zip(axes, ("restitution", "sticking")):
        mean, low, high = np.array([getattr(b, name) for b in series], dtype=float).T
        known = np.isfinite(mean)
        error = np.nan_to_num([mean - low, high - mean])
        place.plot(x, mean, color=colour, linewidth=0.9)
        place.errorbar(
            x[known], mean[known], yerr=error[:, known], fmt="D", color=colour, markersize=5, capsize=3, label=label
        )


def _draw_theory(axes, results, factor, velocities):
    filling = results.by_filling[factor]
    v = np.geomspace(velocities.min(), velocities.max(), 60)
    density = factor * results.grain_density
    if filling.velocity_fit.reason is None and np.all(np.isfinite(filling.velocity_fit.values)):
        axes.plot(
            v,
            restitution(v, Spheres(1.0, density, *filling.velocity_fit.values)),
            color=OURS,
            label="Andrews, our moduli",
        )
    if factor in paper.YOUNG:
        spheres = Spheres(1.0, density, paper.YIELD_STRESS[factor], paper.YOUNG[factor])
        axes.plot(v, restitution(v, spheres), "--", color=PAPER, label="Andrews, A24's moduli")


@styled
def energy_velocity_figure(results):
    """Change of every channel against velocity, in compression and in the return phase, for each filling at
    its size with the most velocities."""
    return _energy_figure(results, _by_velocity, "collision velocity  [m/s]")


@styled
def energy_size_figure(results):
    """The same against size, at the velocity of the size fit."""
    return _energy_figure(results, _by_size, "aggregate radius  [grain radii]")


def _by_velocity(results, filling):
    """(bounces, their names on the axis, what is held fixed)."""
    own = [b for b in results.bounces if b.filling == filling]
    count = {radius: sum(b.radius == radius for b in own) for radius in {b.radius for b in own}}
    radius = max(count, key=lambda r: (count[r], r))
    chosen = [b for b in own if b.radius == radius]
    return chosen, [f"{b.velocity:.3g}" for b in chosen], f"$R$ = {radius:g} $r$"


def _by_size(results, filling):
    velocity = results.by_filling[filling].size_fit.velocity
    chosen = [b for b in results.bounces if b.filling == filling and abs(b.velocity / velocity - 1.0) < 1e-6]
    return chosen, [f"{b.radius:g}" for b in chosen], f"{velocity:.4g} m/s"


def _energy_figure(results, choose, xlabel):
    fillings = list(results.by_filling)
    figure, axes = panels(len(fillings), 2, 6.2, 3.6)
    for row, filling in zip(axes, fillings):
        chosen, names, fixed = choose(results, filling)
        for place, phase, title in zip(row, ("compression", "parting"), ("start to $t_{max}$", "$t_{max}$ to end")):
            _stack(place, [getattr(b, phase) for b in chosen])
            place.set_xticks(range(len(names)))
            place.set_xticklabels(names)
            place.set_xlabel(xlabel)
            place.set_title(title, loc="left", fontsize=11)
        row[0].set_ylabel("change  [% of $K(0)$]")
        row[1].set_title(f"filling {filling:g}, {fixed}", loc="right", fontsize=10, color="0.3")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.get_layout_engine().set(rect=(0.0, 0.0, 0.8, 1.0))
    figure.legend(handles, labels, loc="center left", bbox_to_anchor=(0.805, 0.5), frameon=False, fontsize=9)
    return figure


def _stack(axes, phases):
    """Bars of the channels' changes, positive ones stacked up and negative ones down, and diamonds for their
    sum, which is the kinetic energy lost."""
    base = {True: np.zeros(len(phases)), False: np.zeros(len(phases))}
    for channel in _SHOWN:
        change = 100.0 * np.array([phase[channel][0] for phase in phases])
        label = LABELS[channel]
        if not np.any(change):
            continue
        for up in (True, False):
            part = np.where((change > 0) == up, change, 0.0)
            if np.any(part):
                axes.bar(range(len(phases)), part, bottom=base[up], color=COLOURS[channel], label=label)
                label = None
                base[up] = base[up] + part
    lost = -100.0 * np.array([phase["kinetic"][0] for phase in phases])
    error = 100.0 * np.array([phase["kinetic"][1] or 0.0 for phase in phases])
    axes.errorbar(
        range(len(phases)),
        lost,
        yerr=error,
        fmt="D",
        color="black",
        markersize=5,
        capsize=3,
        label="kinetic energy lost",
    )
    axes.axhline(0.0, color="black", linewidth=0.7)


FIGURES = (
    StudyFigure("outcome", "Restitution and sticking probability with 95 % intervals.", outcome_figure),
    StudyFigure("energy_velocity", "Where the energy goes, against velocity.", energy_velocity_figure),
    StudyFigure("energy_size", "Where the energy goes, against size.", energy_size_figure),
)
