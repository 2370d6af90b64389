"""Restitution, sticking probability, what comes back, and the energy of a bounce, channel by channel: beyond A24 (section
5.3)."""

import numpy as np

from ....figures.style import styled
from ....runs.format import CHANNELS, COLOURS, LABELS
from ....theory.andrews import Spheres, restitution
from ...definition import StudyFigure
from .. import paper
from .common import (
    FILLING_COLOURS,
    OURS,
    PAPER,
    filling_text,
    legend,
    letter,
    main_filling,
    panels,
    size_colours,
    velocity_axis,
)

_SHOWN = tuple(c for c in CHANNELS if c != "kinetic")


@styled
def outcome_figure(results):
    """Sticking probability and coefficient of restitution against velocity (main filling, by size) and against size (at
    the velocity of the size fit, by filling): thick from undecided runs counted one way to the other, thin to the outer
    ends of the 95 % intervals; Andrews's restitution."""
    filling = main_filling(results)
    figure, axes = panels(2, 2, 5.4, 3.7)
    own = [b for b in results.bounces if b.filling == filling]
    colours = size_colours(b.radius for b in own)
    for number, (radius, colour) in enumerate(colours.items()):
        series = [b for b in own if b.radius == radius]
        x = [b.velocity * 1.02 ** (number - 0.5 * len(colours)) for b in series]
        _series(axes[:, 0], x, series, colour, f"$R$ = {radius:g} $r$")
    for number, (other, colour) in enumerate(zip(results.by_filling, FILLING_COLOURS)):
        series = _at_size_velocity(results, other)
        _series(axes[:, 1], [b.radius + 0.5 * number for b in series], series, colour, f"filling {other:g}")
    _draw_theory(axes[1, 0], results, filling, np.array([b.velocity for b in own]))
    for row, label in zip(axes, ("sticking probability", "coefficient of restitution")):
        for place in row:
            place.set_ylabel(label)
            place.set_ylim(-0.03, 1.05)
        velocity_axis(row[0], [b.velocity for b in own])
        row[1].set_xlabel("aggregate radius  [grain radii]")
        row[1].set_xticks(sorted({b.radius for b in results.bounces}))
    for place, corner in zip((*axes[0], axes[1, 0]), ("lower right", "lower center", "center")):
        legend(place, fontsize=8, loc=corner)
    _name_panels(axes, results, filling)
    return figure


def _name_panels(axes, results, filling):
    """Letters, and what is held fixed: the filling on the left, the velocity on the right."""
    letter(axes, "")
    left, right = np.atleast_2d(axes)[0]
    left.set_title(filling_text(filling), loc="right", fontsize=10, color="0.3")
    right.set_title(f"{results.by_filling[filling].size_fit.velocity:.4g} m/s", loc="right", fontsize=10, color="0.3")


def _at_size_velocity(results, filling):
    velocity = results.by_filling[filling].size_fit.velocity
    return [b for b in results.bounces if b.filling == filling and abs(b.velocity / velocity - 1.0) < 1e-6]


def _series(axes, x, series, colour, label):
    """Sticking on the first of the axes, restitution on the second."""
    for place, name in zip(axes, ("sticking", "restitution")):
        low, high, lowest, highest = np.array([getattr(b, name) for b in series], dtype=float).T
        known = np.isfinite(low)
        lowest, highest = np.where(np.isnan(lowest), low, lowest), np.where(np.isnan(highest), high, highest)
        at = np.asarray(x, dtype=float)[known]
        place.vlines(at, lowest[known], highest[known], color=colour, linewidth=0.9)
        place.vlines(at, low[known], high[known], color=colour, linewidth=4.0, alpha=0.55)
        place.plot(at, low[known], "D", color=colour, markersize=4, label=label)
        place.plot(at, high[known], "D", color=colour, markersize=4)


def _draw_theory(axes, results, factor, velocities):
    """Andrews's restitution with A24's moduli, and with ours where E* has an upper limit: without one it may be anything from
    that of the lower limit to 0."""
    joint, density = results.by_filling[factor].joint, factor * results.grain_density
    v = np.geomspace(velocities.min(), velocities.max(), 60)
    if joint.reason is None and np.all(np.isfinite(joint.limits[1])):
        axes.plot(v, restitution(v, Spheres(1.0, density, *joint.values[:2])), color=OURS, label="Andrews, our moduli")
    if factor in paper.YOUNG:
        spheres = Spheres(1.0, density, paper.YIELD_STRESS[factor], paper.YOUNG[factor])
        axes.plot(v, restitution(v, spheres), "--", color=PAPER, label="Andrews, A24's moduli")


@styled
def returned_figure(results):
    """Fraction of K(0) in bulk motion of the halves at their largest return speed, against velocity (main filling, by size)
    and against size (at the velocity of the size fit, by filling), beside Andrews's restitution squared; None where no
    run has it."""
    if not any(b.returned for b in results.bounces):
        return None
    filling = main_filling(results)
    figure, axes = panels(1, 2, 5.4, 3.9)
    own = [b for b in results.bounces if b.filling == filling and b.returned]
    for radius, colour in size_colours(b.radius for b in own).items():
        series = [b for b in own if b.radius == radius]
        _returned_series(axes[0, 0], [b.velocity for b in series], series, colour, f"$R$ = {radius:g} $r$")
    for other, colour in zip(results.by_filling, FILLING_COLOURS):
        series = [b for b in _at_size_velocity(results, other) if b.returned]
        _returned_series(axes[0, 1], [b.radius for b in series], series, colour, f"filling {other:g}")
    if filling in paper.YOUNG and own:
        v = np.geomspace(min(b.velocity for b in own) / 1.1, max(b.velocity for b in own) * 1.1, 60)
        spheres = Spheres(1.0, filling * results.grain_density, paper.YIELD_STRESS[filling], paper.YOUNG[filling])
        axes[0, 0].plot(v, 100 * restitution(v, spheres) ** 2, "--", color=PAPER, label="Andrews, A24's moduli")
    if own:
        velocity_axis(axes[0, 0], [b.velocity for b in own])
    axes[0, 1].set_xlabel("aggregate radius  [grain radii]")
    for place in axes[0]:
        place.set_ylabel("returned bulk motion  [% of $K(0)$]")
        place.set_ylim(0.0, 1.15 * place.get_ylim()[1])
        legend(place, fontsize=9)
    _name_panels(axes[0], results, filling)
    return figure


def _returned_series(axes, x, series, colour, label):
    if series:
        mean, error = np.array([b.returned for b in series], dtype=float).T
        axes.errorbar(x, 100 * mean, yerr=100 * np.nan_to_num(error), fmt="D-", color=colour, capsize=3, label=label)


@styled
def energy_velocity_figure(results):
    """Change of every channel against velocity, in compression and in the return phase (by outcome), for each filling at
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
    chosen = _at_size_velocity(results, filling)
    velocity = results.by_filling[filling].size_fit.velocity
    return chosen, [f"{b.radius:g}" for b in chosen], f"{velocity:.4g} m/s"


def _energy_figure(results, choose, xlabel):
    fillings = list(results.by_filling)
    figure, axes = panels(len(fillings), 2, 6.6, 3.8)
    for row, filling in zip(axes, fillings):
        chosen, names, fixed = choose(results, filling)
        _stack(row[0], [_all_outcomes(b) for b in chosen], names)
        apart = [(p, f"{name}, {p.seeds} {p.outcome}") for b, name in zip(chosen, names) for p in b.phases]
        _stack(row[1], [phases.parting for phases, _ in apart], [name for _, name in apart])
        row[1].tick_params(axis="x", labelsize=8, rotation=90)
        for place, title in zip(row, ("start to $t_{max}$", "$t_{max}$ to end, by outcome")):
            place.set_xlabel(xlabel)
            place.set_title(title, loc="left", fontsize=11)
        row[0].set_ylabel("change  [% of $K(0)$]")
        row[1].set_title(f"filling {filling:g}, {fixed}", loc="right", fontsize=10, color="0.3")
    handles, labels = axes[0, 0].get_legend_handles_labels()
    figure.get_layout_engine().set(rect=(0.0, 0.0, 0.82, 1.0))
    figure.legend(handles, labels, loc="center left", bbox_to_anchor=(0.825, 0.5), frameon=False, fontsize=9)
    return figure


def _all_outcomes(point):
    """Change of the channels until t_max, mean over all runs of a point: what comes later cannot matter."""
    weights = np.array([phases.seeds for phases in point.phases], dtype=float)
    mean = {c: weights @ [p.compression[c][0] for p in point.phases] / weights.sum() for c in CHANNELS}
    return {c: (value, None) for c, value in mean.items()}


def _stack(axes, phases, names):
    """Bars of the channels' changes, positive ones stacked up and negative ones down, and diamonds for their sum, which is
    the kinetic energy lost."""
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
    label = "kinetic energy lost"
    axes.errorbar(range(len(phases)), lost, yerr=error, fmt="D", color="black", markersize=5, capsize=3, label=label)
    axes.axhline(0.0, color="black", linewidth=0.7)
    axes.set_xticks(range(len(names)))
    axes.set_xticklabels(names)


FIGURES = (
    StudyFigure("outcome", "Sticking probability and restitution, undecided runs counted both ways.", outcome_figure),
    StudyFigure("returned", "Bulk motion at the largest return speed, against velocity and size.", returned_figure),
    StudyFigure("energy_velocity", "Where the energy goes, against velocity.", energy_velocity_figure),
    StudyFigure("energy_size", "Where the energy goes, against size.", energy_size_figure),
)
