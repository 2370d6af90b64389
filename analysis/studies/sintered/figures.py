"""Figures of the study: S17's own, springs that are cut beside springs that are held, and what space changes."""

from functools import partial
from pathlib import Path

import numpy as np

from ...figures.style import PAPER
from ...theory import ICE, pair_constants
from ...theory.chains import stretching_period
from ..curve_figure import CurveFigure
from ..paper import read_paper
from ..runs import alike
from ..snapshot_figure import SnapshotFigure

PERIOD = stretching_period(pair_constants(ICE, 1e-7))
RULES = ("cut", "held")
# Runs of the tables, and which part of the paper's times is shown.
FIG07 = {"b0-v10-held-s1": 1, "b0-v30-held-s1": 0.25, "b0.7-v3.2-held-s1": 1}
FIG07 |= {"b0.7-v10-held-s4": 1, "b0.7-v10-s4": 1, "b0.7-v30-held-s1": 0.25}
FIG09 = {"b0-v3-vg3-s1": 1, "b0.7-v3-vg3-s1": 1}


def _said(axes, panel, x):
    """What S17's text sets for the largest piece there, from paper.toml: bars between limits, a cross at its critical velocity."""
    label = "S17's words"
    for claim in read_paper(Path(__file__).parent)[1]:
        where = claim.where
        if where.get("setup") != "held" or not all(alike(where.get(n, np.nan), v) for n, v in panel.items()):
            continue
        if claim.quantity == "growth_limit" and x == "velocity":
            axes.plot([claim.value], [0.5], "x", color=PAPER, markersize=10, mew=2, label=label)
        elif claim.quantity == "largest" and where["growth_velocity"] == 0 and claim.test:
            low, high = np.clip(claim.limits, 0.0, 1.0)
            axes.plot([where[x]] * 2, [low, high], color=PAPER, lw=9, alpha=0.2, solid_capstyle="butt", label=label)
        else:
            continue
        label = None


def _shown(results, runs, periods):
    """(row, title, times) of runs {name: part of the times}."""
    for name, part in runs.items():
        for row in results.table[results.table.run == name].itertuples():
            title = f"β = {row.neck:g}, {row.velocity:.2g} m/s, springs {RULES[1 - row.cut]}, pair {row.packing_seed}"
            yield row, title, [number * part * PERIOD for number in periods]


LARGEST = {"y": "largest", "y_label": "mass in the largest piece", "limits": (0, 1.05), "level_line": 0.5}
BY_GROWTH = {"colour": "growth_velocity", "panel": "setup"}
GROWN = {"neck": 0.7, "setup": (*RULES, "space"), "growth_velocity": (0, 1, 3, 10)}

FIGURES = (
    CurveFigure(
        "held",
        "Springs cut at their limits or held there, beside S17's words (purple); β = 0: unsintered. Bars: standard errors.",
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
        "S17 Fig. 7: BCCA aggregates at the paper's times (0 to 20,000 periods of stretching, 1.22 ns each; at 30 m/s a quarter of them), run again "
        "with c98a3c2: trajectories are chaotic, and not those of runs.csv. Every panel has its own scale, in grain radii; the last hundredth of "
        "the grains may be outside.",
        partial(_shown, runs=FIG07, periods=(0, 2500, 5000, 10_000, 20_000)),
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
        "S17 Fig. 9: aggregates compacted at 3 m/s that collide at 3 m/s, at the paper's times (0 to 5,000 periods).",
        partial(_shown, runs=FIG09, periods=(0, 625, 1250, 2500, 5000)),
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
        *("lost", "neck", "way", "setup"),
        where={
            "setup": RULES,
            "way": ("rolling friction", "sliding friction", "contacts formed and broken", "necks broken"),
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
