"""Number of grains within a distance: K13 Fig 11. And the tension of stretched cells."""

import numpy as np

from ....figures.style import styled
from ....measures.structure import grains_within
from ....runs.table import run_folder
from ....theory.compression import tensile_strength
from ...definition import StudyFigure
from .. import paper
from ..curve import AVERAGED, tension
from ..measure import ORIGINS, state_at
from .common import PAPER, colours_of, legend, letter, panels

_AXES = {1: "one axis", 2: "two axes", 3: "three axes"}


def _states(run):
    """{filling: state} of the paper's filling factors that a run has."""
    states = {filling: state_at(run, filling) for filling in paper.STRUCTURE_FILLINGS}
    return {filling: state for filling, state in states.items() if state is not None}


@styled
def structure_figure(results):
    """N(< r) of one run of the main group, and of that with more grains, at the paper's filling factors."""
    found = [
        (group, max((_states(run_folder(row)) for row in group.table.itertuples()), key=len)) for group in results.shown
    ]
    found = [(group, states) for group, states in found if states]
    if not found:
        return None
    figure, axes = panels(1, len(found), 6.0, 4.8)
    for place, (group, states) in zip(axes[0], found):
        _draw_structure(place, group, states)
    letter(axes, "dashed: D = 3 at each filling (eq 29)")
    return figure


def _draw_structure(place, group, states):
    distance = np.geomspace(1.5, 100.0, 40)
    colours = dict(zip(paper.STRUCTURE_FILLINGS, colours_of(paper.STRUCTURE_FILLINGS)))
    for filling, state in states.items():
        radius = state.radius.mean()
        reached = distance[distance * radius < 1.5 * state.cell_size.min()]
        counts = grains_within(state.position, reached * radius, state.cell_size, ORIGINS // 4)
        place.plot(reached, counts, color=colours[filling], label=f"$\\phi$ = {filling:g}")
        place.plot(distance, filling * distance**3, "--", color=colours[filling], linewidth=0.8)
    place.plot(distance, distance**2, "-", color="0.8", linewidth=3, zorder=0, label="D = 2")
    grains = group.parameters["grains"]
    place.axhline(grains, linestyle=":", color="0.4", label=f"N = {grains}")
    place.set_xscale("log")
    place.set_yscale("log")
    place.set_ylim(1.0, 10.0 * grains)
    place.set_xlabel("distance $r_{in}/r_0$")
    place.set_ylabel("number of grains $N(r < r_{in})$")
    legend(place, loc="upper left")


@styled
def tension_figure(results):
    """Tension against filling factor of every stretched run, and the largest against T19."""
    if not len(results.stretched):
        return None
    figure, axes = panels(1, 2)
    left, right = axes[0]
    for row in results.stretched.itertuples():
        fillings, stress = tension(run_folder(row).history, AVERAGED * row.time_unit)
        left.plot(
            fillings / row.largest_filling,
            stress,
            linewidth=0.8,
            label=f"from {row.largest_filling:.2g}, along {_AXES[row.stretched_axes]}",
        )
        right.plot(
            [row.largest_filling],
            [row.tensile_strength],
            "D" if row.stretched_axes == 1 else "o",
            markerfacecolor="none",
            color="#c62828",
        )
    filling = np.geomspace(0.5 * results.stretched.largest_filling.min(), 0.65, 50)
    kinds = results.stretched[["surfaceEnergy", "grainRadius"]].drop_duplicates()
    for gamma, radius in kinds.itertuples(index=False):
        of = f", gamma = {gamma:g} J/m$^2$, $r_0$ = {radius * 1e6:g} um" if len(kinds) > 1 else ""
        theirs = tensile_strength(filling, gamma, radius)
        right.plot(filling, theirs, "--", color=PAPER, label=f"Tatsuuma et al. (2019), one axis{of}")
    left.set_xlabel("filling factor over that before the stretching")
    left.set_ylabel("tension  [Pa]")
    right.set_xscale("log")
    right.set_yscale("log")
    right.set_xlabel("filling factor before the stretching")
    right.set_ylabel("tensile strength  [Pa]")
    legend(left, fontsize=8)
    legend(right)
    letter(axes, "diamonds: one axis, circles: three")
    return figure


FIGURES = (
    StudyFigure("fig11_structure", "K13 Fig. 11: number of grains within a distance.", structure_figure),
    StudyFigure("tension", "Tension of stretched cells, and tensile strength beside T19.", tension_figure),
)
