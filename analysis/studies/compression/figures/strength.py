"""Pressure against filling factor: K13 Figs 4, 12, 13, and the whole range beside the formulae for any filling."""

import numpy as np

from ....figures.style import styled
from ....runs.table import run_folder
from ....statistics import mean_and_error
from ....theory.aggregates import bcca_coordination
from ....theory.compression import compressive_strength_dense, filling_at
from ...definition import StudyFigure
from .. import paper
from ..curve import AVERAGED, FILLINGS, pressure_over
from ..shown import material_text
from .common import LARGER, OURS, PAPER, colours_of, draw_formulae, legend, letter, panels, pressure_axes


@styled
def ice_figure(results):
    """Every run of the main group, averaged over 1000 t0, its mean over the clusters, and the group of more grains."""
    return _seeds_figure([group for group in results.shown if group.covered.any()])


@styled
def silicate_figure(results):
    """The same of the first group of silicate; None where there is none."""
    return _seeds_figure([group for group in results.of("silicate") if group.covered.any()][:1])


def _seeds_figure(groups):
    if not groups:
        return None
    figure, axes = panels(1, 2)
    left, right = axes[0]
    main, *_ = groups
    for row in main.table.itertuples():
        fillings, pressures = pressure_over(run_folder(row).history, AVERAGED * row.time_unit)
        left.plot(fillings[pressures > 0], pressures[pressures > 0], linewidth=0.6, alpha=0.7)
    for group, colour in zip(groups, (OURS, LARGER)):
        for place in (left, right):
            _draw_mean(place, group, colour)
    for place in (left, right):
        pressure_axes(place)
    lowest = min(FILLINGS[group.covered & (group.mean_pressure > 0)][0] for group in groups)
    draw_formulae(right, main.scale, lowest, 0.66)
    left.set_ylim(0.1 * min(np.nanmin(np.where(g.mean_pressure > 0, g.mean_pressure, np.nan)) for g in groups), None)
    for place in (left, right):
        legend(place, loc="upper left")
    letter(axes, _title(main))
    return figure


def _draw_mean(axes, group, colour):
    """Means and errors over the clusters; above the filling that all reach, over those that reach it."""
    some = np.isfinite(group.pressure).any(axis=0)
    found = [mean_and_error(column[np.isfinite(column)]) for column in group.pressure.T[some]]
    axes.errorbar(
        FILLINGS[some],
        [mean if mean > 0 else np.nan for mean, _ in found],
        yerr=[error or 0.0 for _, error in found],
        fmt="o-",
        color=colour,
        markersize=4,
        label=_mean(group),
        zorder=4,
    )


def _mean(group):
    return (f"mean of {group.seeds} runs" if group.seeds > 1 else "one run") + f", N = {group.parameters['grains']}"


def _title(group):
    p = group.parameters
    return f"{material_text(p)}, $C_v$ = {p['strainRate']:g}, $k_n$ = {p['linearDamping']:g}"


@styled
def linear_figure(results):
    """Filling factor against pressure, silicate: K13 Fig 13."""
    groups = [group for group in results.of("silicate") if group.covered.any()]
    if not groups:
        return None
    group = groups[0]
    figure, axes = panels(1, 1, 6.0, 4.6)
    place = axes[0, 0]
    covered = group.covered & (group.mean_pressure > 0)
    place.semilogx(group.mean_pressure[covered], FILLINGS[covered], "o-", color=OURS, label=_mean(group))
    pressure = np.geomspace(1.0, 1e6, 200)
    thin = filling_at(pressure, group.scale)
    place.semilogx(pressure[thin < 0.3], thin[thin < 0.3], "--", color=PAPER, label="K13 eq 25")
    place.semilogx(pressure, filling_at(pressure, group.scale, 0.74), ":", color=PAPER, label="Tatsuuma et al. (2023)")
    theirs = paper.SILICATE_FILLINGS if paper.has_k13s_grains(group.parameters) else {}
    for (source, filling), marker in zip(theirs.items(), "*sD"):
        place.plot(
            [paper.SILICATE_PRESSURE],
            [filling],
            marker,
            markersize=10,
            markerfacecolor="none",
            color=PAPER,
            label=source,
        )
    place.set_xlabel("pressure $P$  [Pa]")
    place.set_ylabel("filling factor $\\phi$")
    place.set_ylim(0.0, 0.7)
    legend(place, loc="upper left")
    letter(axes, _title(group))
    return figure


@styled
def whole_range(results):
    """Strength over the whole range, its ratio to T23's formula and the coordination number: K13's grains in colours, every
    other group in grey, beside K13 eq 25, T23's formula and A24 eq 45. The ratio is from where a fit begins."""
    figure, axes = panels(1, 3, 4.6, 4.2)
    own = [group for group in results.of_k13s_grains if group.seeds > 1 or any(group is one for one in results.shown)]
    others = [group for group in results.groups if not any(group is one for one in own)]
    for group, colour in [*((g, "0.8") for g in others), *zip(own, colours_of(own))]:
        _draw_over_range(axes[0], group, colour, named=colour != "0.8")
    for group, colour in zip(own, colours_of(own)):
        _draw_ratio(axes[0, 1], group, colour)
    low = min(FILLINGS[np.isfinite(group.pressure).any(axis=0)][0] for group in results.groups)
    draw_formulae(axes[0, 0], 1.0, low, 0.66)
    filling = np.geomspace(low, 0.66, 100)
    axes[0, 2].plot(filling, bcca_coordination(filling), "--", color=PAPER, label="A24 eq 45")
    pressure_axes(axes[0, 0])
    axes[0, 0].set_ylim(1e-8, None)
    axes[0, 0].set_ylabel("$P\\,r_0^3/E_{roll}$")
    axes[0, 1].axhline(1.0, linestyle=":", color=PAPER, label="Tatsuuma et al. (2023)")
    axes[0, 1].set_ylim(0.0, None)
    for place, text in zip(axes[0, 1:], ("$P$ over Tatsuuma et al. (2023)", "coordination number $Z$")):
        place.set_xscale("log")
        place.set_xlabel("filling factor $\\phi$")
        place.set_ylabel(text)
    for place, where in zip(axes[0], ("upper left", "lower left", "upper left")):
        legend(place, loc=where, fontsize=8)
    letter(axes, "grey: all other sets")
    return figure


def _draw_over_range(axes, group, colour, named):
    some = np.isfinite(group.pressure).any(axis=0)
    pressure, contacts = (np.nanmean(series[:, some], axis=0) for series in (group.pressure, group.coordination))
    style = {"color": colour, "markersize": 3, "zorder": 4 if named else 2}
    pressed = pressure > 0
    text = _set_of(group) if named else None
    axes[0].plot(FILLINGS[some][pressed], pressure[pressed] / group.scale, "o-", label=text, **style)
    axes[2].plot(FILLINGS[some], contacts, "o-", **style)


def _draw_ratio(axes, group, colour):
    shown = np.isfinite(group.pressure).any(axis=0) & (FILLINGS >= group.fit.between[0] * (1 - 1e-9))
    ratios = group.pressure[:, shown] / compressive_strength_dense(FILLINGS[shown], group.scale)
    found = [mean_and_error(column[np.isfinite(column)]) for column in ratios.T]
    means, errors = [mean for mean, _ in found], [error or 0.0 for _, error in found]
    axes.errorbar(FILLINGS[shown], means, yerr=errors, fmt="o-", color=colour, markersize=3, linewidth=1)


def _set_of(group):
    p = group.parameters
    return f"N = {p['grains']}, $C_v$ = {p['strainRate']:g}, step {p['stepFraction']:g} ({group.seeds})"


FIGURES = (
    StudyFigure(
        "fig04_strength",
        "K13 Fig. 4: pressure against filling factor, every run and the mean of the set with most clusters, and more grains.",
        ice_figure,
    ),
    StudyFigure("fig12_silicate", "K13 Fig. 12: the same for silicate.", silicate_figure),
    StudyFigure(
        "fig13_silicate", "K13 Fig. 13: filling factor against pressure, silicate, beside other work.", linear_figure
    ),
    StudyFigure(
        "whole_range",
        "Strength and coordination at any filling beside T23 and A24; in brackets the number of clusters.",
        whole_range,
    ),
)
