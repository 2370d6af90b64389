"""Figures of the study: S17's own, springs that are cut beside springs that are held, and what space changes."""

from functools import partial
from pathlib import Path

import numpy as np

from ...figures.panels import PAPER
from ...theory import ICE, pair_constants
from ...theory.chains import stretching_period
from ..curve_figure import CurveFigure
from ..paper import read_paper
from ..runs import alike
from ..snapshot_figure import SnapshotFigure

PERIOD = stretching_period(pair_constants(ICE, 1e-7))
RULES = ("cut", "held")
# (beta, V_c [m/s], held, part of the paper's times): the first pair's collisions in Figs 7 and 9.
FIG07 = ((0, 10, 1, 1), (0, 30, 1, 0.25), (0.7, 3.16, 1, 1), (0.7, 10, 1, 1), (0.7, 10, 0, 1), (0.7, 30, 1, 0.25))
FIG09 = ((0, 3, 0, 1), (0.7, 3, 0, 1))


def _said(axes, panel, x):
    """What S17's text sets for the largest piece there, from paper.toml: bars between limits, a cross at its critical velocity."""
    label = "S17's words"
    for claim in read_paper(Path(__file__).parent)[1]:
        where = claim.where
        if where.get("setup") != "held" or any(not alike([where.get(n, np.nan)], v)[0] for n, v in panel.items()):
            continue
        if claim.quantity == "growth_limit" and x == "velocity":
            axes.plot([claim.value], [0.5], "x", color=PAPER, markersize=10, mew=2, label=label)
        elif claim.quantity == "largest" and where["growth_velocity"] == 0 and claim.test:
            low, high = np.clip(claim.limits, 0.0, 1.0)
            axes.plot([where[x]] * 2, [low, high], color=PAPER, lw=9, alpha=0.2, solid_capstyle="butt", label=label)
        else:
            continue
        label = None


def _shown(results, growth, collisions, periods):
    """(row, title, times) of the first pair's collisions, of BCCA aggregates (growth 0) or compacted ones."""
    table = results.table
    plain = (table.planar == 1) & (table.viscoelasticTime == 0) & alike(table.criticalRolling, 2e-10)
    first = table[plain & (table.packing_seed == 1) & (table.growth_velocity == growth)]
    for neck, velocity, held, part in collisions:
        title = f"β = {neck:g}, {velocity:.2g} m/s, springs {RULES[held]}"
        for row in first[alike(first.neck, neck) & alike(first.velocity, velocity) & (first.cut != held)].itertuples():
            yield row, title, [number * part * PERIOD for number in periods]


LARGEST = {"y": "largest", "y_label": "mass in the largest piece", "limits": (0, 1.05), "level_line": 0.5}
BY_GROWTH = {"colour": "growth_velocity", "panel": "setup"}
GROWN = {"neck": 0.7, "setup": (*RULES, "space"), "growth_velocity": (0, 1, 3, 10)}

FIGURES = (
    CurveFigure(
        "held",
        "Springs cut at their limits and held there, beside S17's words (purple; β = 0: unsintered). Bars: standard errors.",
        x="velocity",
        colour="setup",
        panel="neck",
        where={"growth_velocity": 0, "setup": RULES, "neck": (0, 0.7)},
        logarithmic="x",
        paper=partial(_said, x="velocity"),
        **LARGEST,
    ),
    CurveFigure(
        "fig06_contacts",
        "S17 Fig. 6: contacts a grain against the velocity that compacted the aggregates (0: BCCA); space is not in S17.",
        *("contacts", "growth_velocity", "setup"),
        where={"setup": (*RULES, "space")},
        y_label="contacts a grain",
    ),
    SnapshotFigure(
        "fig07_snapshots",
        "S17 Fig. 7: BCCA aggregates, first pair, at the paper's times (0 to 20,000 periods of stretching, 1.22 ns each; at 30 m/s a quarter of "
        "them). Every panel has its own scale, in grain radii; the last hundredth of the grains may be outside.",
        partial(_shown, growth=0, collisions=FIG07, periods=(0, 2500, 5000, 10_000, 20_000)),
    ),
    CurveFigure(
        "fig08_radius",
        "S17 Fig. 8, right: gyration radius of the largest piece of BCCA aggregates in grain radii. β = 0: unsintered.",
        *("gyration_radius", "velocity", "neck", "setup"),
        where={"growth_velocity": 0, "setup": RULES, "neck": (0, 0.2, 0.7)},
        logarithmic="x",
        y_label="$R_g/R$ of the largest piece",
        limits=(0, None),
    ),
    SnapshotFigure(
        "fig09_snapshots",
        "S17 Fig. 9: aggregates compacted at 3 m/s that collide at 3 m/s, first pair, at the paper's times (0 to 5,000 periods).",
        partial(_shown, growth=3, collisions=FIG09, periods=(0, 625, 1250, 2500, 5000)),
    ),
    CurveFigure(
        "fig10_growth",
        "S17 Fig. 10: largest piece of aggregates of β = 0.7 that velocities V_g have compacted (0: BCCA); space is not in S17.",
        x="velocity",
        where=GROWN,
        logarithmic="x",
        **LARGEST,
        **BY_GROWTH,
    ),
    CurveFigure(
        "fig11_beta",
        "S17 Fig. 11: largest piece of BCCA aggregates against β (0: unsintered); 30 Å: ξ_crit, springs cut.",
        x="neck",
        colour="setup",
        panel="velocity",
        where={"growth_velocity": 0, "setup": (*RULES, "30 Å"), "velocity": (10, 30)},
        paper=partial(_said, x="neck"),
        **LARGEST,
    ),
    CurveFigure(
        "fig12_fragments",
        "S17 Fig. 12: mass in fragments (pieces of less than a quarter of it) of BCCA aggregates against β.",
        *("fragments", "neck", "setup", "velocity"),
        where={"growth_velocity": 0, "setup": RULES, "velocity": (10, 30)},
        y_label="mass in fragments",
        limits=(0, None),
    ),
    CurveFigure(
        "fig14_energy",
        "S17 Fig. 14: what BCCA aggregates lose at 10 m/s until the end of the runs, of all that is lost. The paper has shares of K(0), unsintered 80 % "
        "by rolling and 20 % by breaking contacts; contacts that form release surface energy, so that our losses exceed K(0).",
        *("lost", "neck", "part", "setup"),
        where={
            "setup": RULES,
            "part": ("rolling friction", "sliding friction", "contacts formed and broken", "necks broken"),
        },
        y_label="share of what is lost [%]",
        limits=(0, None),
    ),
    CurveFigure(
        "fig15_necks",
        "S17 Fig. 15: broken necks over those of S17's fit, 0.037 (E_k/E_sint)^0.97, β = 0.7 (V_g = 0: BCCA). Space is not in S17.",
        *("necks_at_energy", "energy_ratio"),
        where=GROWN,
        logarithmic="xy",
        line="",
        level_line=1.0,
        y_label="$N_{cut}$ over S17's fit",
        **BY_GROWTH,
    ),
)
