"""p_stick against velocity, and the region in which aggregates bounce: lines and areas from the table of outcomes, dots from the runs."""

import numpy as np

from ...atlas.grid import FILE
from ...atlas.outcome_table import read_outcomes
from ...atlas.variables import decided, drawn, variables
from ...figures.panels import letter, panels
from ...figures.style import styled
from ..curve_figure import COLOURS, plain_ticks, points
from ..definition import StudyFigure
from ..runs import select
from .study import BOUNCING, STICKING

GRAINS, RATIO = 256, 0.25  # of the lines: where most runs are
VELOCITIES = (0.5, 2.2, 10.0)  # v_break: 1.9, 8.4 and 38 m/s for ice


def _ends(values):
    return values.min(), values.max()


@styled
def sticking(results):
    """p_stick(v) for six fillings."""
    if not FILE.exists():
        return None
    table, (figure, axes) = read_outcomes(FILE), panels(2, 3, 3.4, 2.9)
    velocity = np.geomspace(*_ends(variables(results.table).velocity), 100)
    runs = results[f"{STICKING}_at"].values
    for filling, place, colour in zip(sorted(set(runs.index.get_level_values("filling"))), axes.ravel(), COLOURS):
        found = table.lookup(velocity=velocity, grains=GRAINS, mass_ratio=RATIO, filling=filling)
        p, error, inside = found["p_sticking"], found["error"], found["inside"] == 1
        place.fill_between(velocity, np.clip(p - error, 0, 1), np.clip(p + error, 0, 1), color=colour, alpha=0.2, lw=0)
        place.plot(velocity, np.where(inside, p, np.nan), color=colour)
        place.plot(velocity, p, ":", color=colour)
        own = select(runs, filling=filling)
        points(place, own.index.to_numpy(dtype=float), own.to_list(), "#111111", line="")
        place.set_xscale("log")
        place.set_ylim(-0.03, 1.03)
        place.set_title(rf"$\phi$ = {filling:.2g}, {sum(one.pairs for one in own)} runs", fontsize=10)
    for place in axes[-1]:
        place.set_xlabel("$v/v_{break}$")
    for place in axes[:, 0]:
        place.set_ylabel("$p_{stick}$")
    letter(axes, "")
    return figure


@styled
def bouncing(results):
    """p_bounce in filling and size."""
    if not FILE.exists():
        return None
    table, (figure, axes) = read_outcomes(FILE), panels(1, len(VELOCITIES), 3.7, 3.4)
    runs = drawn(decided(results.table))  # those chosen would hide what lies behind them
    at, bounced = variables(runs), (runs.outcome == BOUNCING).to_numpy()
    filling = np.linspace(table.axes[3].nodes[0], table.axes[3].nodes[-1], 60)
    grains = np.geomspace(*_ends(at.grains), 60)
    limits = np.geomspace(
        VELOCITIES[0] ** 1.5 / VELOCITIES[1] ** 0.5, VELOCITIES[-1] ** 1.5 / VELOCITIES[-2] ** 0.5, len(VELOCITIES) + 1
    )
    for place, velocity, low, high in zip(axes.ravel(), VELOCITIES, limits, limits[1:]):
        found = table.lookup(velocity=velocity, grains=grains[:, None], mass_ratio=1.0, filling=filling)
        areas = place.pcolormesh(
            filling, grains, found["p_bouncing"], vmin=0, vmax=1, cmap="Purples", shading="nearest", rasterized=True
        )
        for sign, line in ((0, "-"), (-1, ":"), (1, ":")):
            p = found["p_bouncing"] + sign * found["error"]
            if p.min() < 0.5 < p.max():
                place.contour(filling, grains, p, levels=[0.5], colors="#7b3fa0", linestyles=line)
        place.contourf(filling, grains, found["inside"], levels=[-1, 0.999], colors="none", hatches=["///"])
        near = at.velocity.between(low, high).to_numpy()
        for kind, marker, colour in ((~bounced, ".", "0.6"), (bounced, "o", "#111111")):
            place.plot(at.filling[near & kind], at.grains[near & kind], marker, color=colour, markersize=4)
        place.set_yscale("log")
        place.set_ylim(grains[0], grains[-1])
        place.set_xlim(0, filling[-1])
        plain_ticks(place.yaxis)
        place.set_title(f"$v$ = {velocity:g} $v_{{break}}$", fontsize=10)
        place.set_xlabel(r"filling factor $\phi$")
    axes[0, 0].set_ylabel("grains of the larger aggregate")
    figure.colorbar(areas, ax=list(axes.ravel()), label="$p_{bounce}$, equal masses")
    return figure


FIGURES = (
    StudyFigure(
        "sticking",
        "Fraction of collisions that stick, averaged over impact parameters. Dots: decided runs that were not chosen, in a band of filling φ and velocity "
        f"(ice: v_break = 3.8 m/s), with 95 % intervals; lines: the table of outcomes at {GRAINS} grains and a mass ratio of 1/4, with its error; dotted: extrapolated.",
        sticking,
    ),
    StudyFigure(
        "bouncing",
        "Fraction of collisions of equal aggregates that bounce, averaged over impact parameters, by the table of outcomes; line: 1/2, dotted: with its error (90 %); "
        "hatched: extrapolated. Dots: decided runs that were not chosen, of all mass ratios near that velocity, black ones bounced.",
        bouncing,
    ),
)
