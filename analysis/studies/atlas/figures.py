"""p_stick against velocity, and the region in which aggregates bounce: lines and areas from the table of outcomes, dots from the runs."""

import numpy as np

from ...atlas.make import SIZES
from ...atlas.outcome_table import read_outcomes
from ...atlas.query import outcomes_file
from ...atlas.variables import STRUCTURES, decided, drawn, of_structure, variables
from ...figures.style import letter, panels, styled
from ..curve_figure import COLOURS, plain_ticks, points
from ..definition import StudyFigure
from ..runs import select
from .study import BOUNCING, STICKING

GRAINS, RATIO = 256, 0.25  # of the lines: where most runs are
VELOCITIES = (0.5, 2.2, 10.0)  # v_break: 1.9, 8.4 and 38 m/s for ice
FEWEST = 20  # runs of a structure in a band of fillings, to be drawn


def _tables():
    """{structure: OutcomeTable}, empty where they are not at hand."""
    files = {structure: outcomes_file(structure, averaged=True) for structure in STRUCTURES}
    return {structure: read_outcomes(file) for structure, file in files.items() if file.exists()}


def _ends(values):
    return values.min(), values.max()


@styled
def sticking(results):
    """p_stick(v) for six fillings."""
    if not (tables := _tables()):
        return None
    figure, axes = panels(2, 3, 3.4, 2.9)
    velocity = np.geomspace(*_ends(variables(results.table).velocity), 100)
    runs = results[f"{STICKING}_at"].values
    for filling, place in zip(sorted(set(runs.index.get_level_values("filling"))), axes.ravel()):
        for (structure, table), colour in zip(tables.items(), COLOURS):
            own = select(runs, filling=filling, aggregates=structure)
            if sum(one.pairs for one in own) < FEWEST:
                continue
            found = table.lookup(velocity=velocity, grains=GRAINS, mass_ratio=RATIO, filling=filling)
            p, error, inside = found["p_sticking"], found["error_sticking"], found["inside"] == 1
            low, high = np.clip(p - error, 0, 1), np.clip(p + error, 0, 1)
            place.fill_between(velocity, low, high, color=colour, alpha=0.2, lw=0)
            place.plot(velocity, np.where(inside, p, np.nan), color=colour, label=structure)
            place.plot(velocity, p, ":", color=colour)
            points(place, own.index.to_numpy(dtype=float), own.to_list(), colour, line="")
        place.set_xscale("log")
        place.set_ylim(-0.03, 1.03)
        place.set_title(rf"$\phi$ = {filling:.2g}", fontsize=10)
    for place in axes[-1]:
        place.set_xlabel("$v/v_{break}$")
    for place in axes[:, 0]:
        place.set_ylabel("$p_{stick}$")
    axes[-1, -1].legend(frameon=False)
    letter(axes, "")
    return figure


@styled
def bouncing(results):
    """p_bounce in filling and size, a row of panels for each structure."""
    if not (tables := _tables()):
        return None
    figure, axes = panels(len(tables), len(VELOCITIES), 3.7, 3.1)
    runs = drawn(decided(results.table))  # those chosen would hide what lies behind them
    ratio = VELOCITIES[1] / VELOCITIES[0]
    for row, (structure, table) in zip(axes, tables.items()):
        own = of_structure(runs, structure)
        for place, velocity in zip(row, VELOCITIES):
            near = variables(own).velocity.between(velocity / ratio**0.5, velocity * ratio**0.5)
            areas = _bouncing(place, table, velocity, own[near])
            place.set_title(f"{structure}, $v$ = {velocity:g} $v_{{break}}$", fontsize=10)
        row[0].set_ylabel("grains of the larger aggregate")
    for place in axes[-1]:
        place.set_xlabel(r"filling factor $\phi$")
    figure.colorbar(areas, ax=list(axes.ravel()), label="$p_{bounce}$, equal masses")
    return figure


def _bouncing(place, table, velocity, runs):
    """p_bounce of a table at a velocity, and runs; returns the coloured areas."""
    at, bounced = variables(runs), (runs.outcome == BOUNCING).to_numpy()
    filling, grains = np.linspace(*_ends(table.axes[3].nodes), 60), np.geomspace(SIZES[0], SIZES[-1], 60)
    found = table.lookup(velocity=velocity, grains=grains[:, None], mass_ratio=1.0, filling=filling)
    about = dict(vmin=0, vmax=1, cmap="Purples", shading="nearest", rasterized=True)
    areas = place.pcolormesh(filling, grains, found["p_bouncing"], **about)
    for sign, line in ((0, "-"), (-1, ":"), (1, ":")):
        p = found["p_bouncing"] + sign * found["error_bouncing"]
        if p.min() < 0.5 < p.max():
            place.contour(filling, grains, p, levels=[0.5], colors="#7b3fa0", linestyles=line)
    place.contourf(filling, grains, found["inside"], levels=[-1, 0.999], colors="none", hatches=["///"])
    for kind, marker, colour in ((~bounced, ".", "0.6"), (bounced, "o", "#111111")):
        place.plot(at.filling[kind], at.grains[kind], marker, color=colour, markersize=4)
    place.set_yscale("log")
    place.set_ylim(grains[0], grains[-1])
    place.set_xlim(*_ends(filling))
    plain_ticks(place.yaxis)
    return areas


FIGURES = (
    StudyFigure(
        "sticking",
        "Fraction of collisions that stick, averaged over impact parameters. Dots: decided runs that were not chosen, in a band of filling φ and velocity "
        f"(ice: v_break = 3.8 m/s), with 95 % intervals; lines: the tables of outcomes at {GRAINS} grains and a mass ratio of 1/4, with their errors; dotted: extrapolated.",
        sticking,
    ),
    StudyFigure(
        "bouncing",
        "Fraction of collisions of equal aggregates that bounce, averaged over impact parameters, by the tables of outcomes; line: 1/2, dotted: with its error (90 %); "
        "hatched: extrapolated. Dots: decided runs that were not chosen, of all mass ratios near that velocity, black ones bounced.",
        bouncing,
    ),
)
