"""Pressure against filling factor: K13 Figs 4, 12, 13, and the whole range beside the formulae for any filling."""

import numpy as np

from ....figures.style import styled
from ....runs.table import run_folder
from ....theory.aggregates import bcca_coordination
from ....theory.compression import filling_at
from ...definition import StudyFigure
from .. import paper
from ..curve import AVERAGED, FILLINGS, averaged
from .common import OURS, PAPER, draw_formulae, legend, letter, panels, pressure_axes


def _of(material):
    """Figure of the first group of a material that was drawn of run folders; None where there is none."""

    def draw(results):
        groups = [group for group in results.of(material) if group.covered.any()]
        if not groups:
            return None
        main = results.main if results.main in groups else groups[0]
        return seeds_figure(results, main)

    return draw


@styled
def seeds_figure(_, group):
    """Every run, averaged over 1000 t0, and the mean over the seeds with its standard error."""
    figure, axes = panels(1, 2)
    left, right = axes[0]
    lowest = FILLINGS[group.covered][0]
    for row in group.table.itertuples():
        means = averaged(run_folder(row).history, ("filling", "pressure"), AVERAGED * row.time_unit)
        shown = means["pressure"] > 0
        left.plot(means["filling"][shown], means["pressure"][shown], linewidth=0.6, alpha=0.7)
    for place in (left, right):
        _draw_mean(place, group)
        pressure_axes(place)
    draw_formulae(right, group.scale, lowest, 0.6)
    bottom = 0.1 * np.nanmin(np.where(group.mean_pressure > 0, group.mean_pressure, np.nan))
    left.set_ylim(bottom, None)
    for place in (left, right):
        legend(place, loc="upper left")
    letter(axes, _title(group))
    return figure


def _draw_mean(axes, group):
    covered = group.covered
    mean = group.mean_pressure[covered]
    error = group.pressure[:, covered].std(axis=0, ddof=1) / np.sqrt(group.seeds) if group.seeds > 1 else 0.0 * mean
    axes.errorbar(
        FILLINGS[covered],
        mean,
        yerr=error,
        fmt="o-",
        color=OURS,
        markersize=4,
        label=_mean(group),
        zorder=4,
    )


def _mean(group):
    return f"mean of {group.seeds} runs" if group.seeds > 1 else "one run"


def _title(group):
    p = group.parameters
    return f"{p['material']}, N = {p['grains']}, $C_v$ = {p['strainRate']:g}, $k_n$ = {p['linearDamping']:g}"


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
    for (source, filling), marker in zip(paper.SILICATE_FILLINGS.items(), "*sD"):
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
    """One curve of strength over the whole range, as a ratio to T23's formula, and coordination against A24 eq 45."""
    figure, axes = panels(1, 2)
    left, right = axes[0]
    drawn = [group for group in results.groups if group.covered.any()]
    for group in drawn:
        covered = group.covered & (group.mean_pressure > 0)
        colour = OURS if group is results.main else "0.75"
        left.plot(
            FILLINGS[covered],
            group.mean_pressure[covered] / group.scale,
            "o-",
            color=colour,
            markersize=3,
            zorder=4 if colour == OURS else 2,
        )
        right.plot(
            FILLINGS[covered],
            group.coordination.mean(axis=0)[covered],
            "o-",
            color=colour,
            markersize=3,
            zorder=4 if colour == OURS else 2,
        )
    low = min(FILLINGS[group.covered][0] for group in drawn)
    draw_formulae(left, 1.0, low, 0.66)
    filling = np.geomspace(low, 0.66, 100)
    right.plot(filling, bcca_coordination(filling), "--", color=PAPER, label="A24 eq 45")
    pressure_axes(left)
    left.set_ylabel("$P\\,r_0^3/E_{roll}$")
    right.set_xscale("log")
    right.set_xlabel("filling factor $\\phi$")
    right.set_ylabel("coordination number $Z$")
    for place in axes[0]:
        legend(place, loc="upper left")
    letter(axes, "black: " + _title(results.main))
    return figure


FIGURES = (
    StudyFigure("fig04_strength", "K13 Fig. 4: pressure against filling factor, every seed and the mean.", _of("ice")),
    StudyFigure("fig12_silicate", "K13 Fig. 12: the same for silicate.", _of("silicate")),
    StudyFigure(
        "fig13_silicate", "K13 Fig. 13: filling factor against pressure, silicate, beside other work.", linear_figure
    ),
    StudyFigure(
        "whole_range",
        "Strength and coordination at any filling beside T23 and A24, all sets of parameters.",
        whole_range,
    ),
)
