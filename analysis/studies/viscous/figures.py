"""Figures of the study: A22's own, and what size and drag change."""

import numpy as np

from ...figures.panels import PAPER
from ..curve_figure import CurveFigure
from ..runs import Runs
from ..snapshot_figure import SnapshotFigure

V_FRA = 50.0, 60.0  # m/s (section 3.2)
SNAPSHOTS = (0.0, 0.32e-6, 0.63e-6, 1.27e-6, 6.34e-6)  # s: Fig. 1
SHOWN_GRAINS = 2000  # a size whose states can be kept
PAPERS_RADIUS = 72.27  # r_c of the paper's aggregates, in grain radii


def _threshold(axes, panel):
    axes.axvspan(*V_FRA, color=PAPER, alpha=0.12, lw=0, label="paper: $v_{fra}$ (50,000 grains)")


def _inverse(axes, panel):
    """f(N) = 1/N (A22 eq 35: N_cum = N)."""
    numbers = np.array([1.0, 2.0 * panel["grains"]])
    axes.plot(numbers, numbers, "--", color=PAPER, lw=1.2, label="paper: $f(N) = 1/N$")


def _collisions(results):
    """The first pair of SHOWN_GRAINS at 50.1 m/s, B_off^2 = 3/12, without drag and with the most."""
    own = Runs(results.table).where(grains=SHOWN_GRAINS, velocity=10**1.7, impact=0.5).table
    own = own[own.seed == own.seed.min()].sort_values("viscoelasticTime")
    for row in own.iloc[[0, -1]].itertuples() if len(own) > 1 else ():
        scale = row.characteristic_radius / row.grain_radius / PAPERS_RADIUS
        title = f"$T_{{vis}}$ = {row.viscoelasticTime * 1e12:g} ps, {row.grains} grains each"
        yield row, title, [scale * t for t in SNAPSHOTS]


OF_SIZE = {"x": "velocity", "colour": "viscoelasticTime", "panel": "grains", "logarithmic": "x"}

FIGURES = (
    SnapshotFigure(
        "fig01_snapshots",
        "A22 Fig. 1 with 2,000 grains each: 50.1 m/s, B_off² = 3/12, at the paper's times in proportion to the aggregates' radii; the bar is in "
        "grain radii, and the last hundredth of the grains may have left a panel.",
        _collisions,
    ),
    CurveFigure(
        "fig03_mean_growth",
        "Growth efficiency, mean over 13 offsets, against velocity (A22 Fig. 3, there with 50,000 grains). Bars: standard errors.",
        "growth",
        paper=_threshold,
        y_label=r"$\langle f_{gro} \rangle$",
        level_line=0.0,
        **OF_SIZE,
    ),
    CurveFigure(
        "fig04_head_on",
        "A22 Fig. 4: growth efficiency of head-on collisions.",
        "head_on",
        y_label="$f_{gro}$ at $B_{off}$ = 0",
        level_line=0.0,
        **OF_SIZE,
    ),
    CurveFigure(
        "fig02_at_offset",
        "A22 Fig. 2: growth efficiency at 50.1 m/s against the offset.",
        *("at_offset", "square", "viscoelasticTime", "grains"),
        where={"grains": (500, 2000, 10_000, 50_000)},
        y_label="$f_{gro}$",
        level_line=0.0,
        limits=(-0.6, 1.05),
    ),
    CurveFigure(
        "fig07_grains",
        "A22 Fig. 7: grains in fragments of at most N grains, 50.1 m/s, mean over 13 offsets.",
        *("grains_in_fragments", "fragment", "viscoelasticTime", "grains"),
        where={"velocity": 50.1},
        logarithmic="xy",
        paper=_inverse,
        y_label=r"$\langle N_{cum}(\leq N) \rangle$",
    ),
    CurveFigure(
        "fig14_at_end",
        "A22 Fig. 14: energy lost in each way by the end, over N_tot F_c δ_c, B_off² = 3/12, 2,000 grains.",
        *("loss_per_grain", "velocity", "viscoelasticTime", "channel"),
        where={"grains": 2000},
        logarithmic="xy",
        y_label=r"$E_{dis}/(N_{tot} F_c \delta_c)$",
        limits=(0.5, None),
    ),
    CurveFigure(
        "fig15_events",
        "A22 Fig. 15: contacts formed and broken over all grains, B_off² = 3/12, 2,000 grains.",
        *("events", "velocity", "viscoelasticTime", "event"),
        where={"grains": 2000},
        logarithmic="xy",
        level_line=1.0,
        y_label="over $N_{tot}$",
    ),
    CurveFigure(
        "drag",
        "What drag changes, 6 ps less without, of means over 13 offsets.",
        *("drag", "velocity", "grains", "part"),
        logarithmic="x",
        level_line=0.0,
        y_label="difference of means",
    ),
    CurveFigure(
        "size",
        "Head-on growth efficiency against the size of the aggregates, without drag.",
        *("head_on", "grains", "velocity"),
        where={"viscoelasticTime": 0.0},
        logarithmic="x",
        level_line=1.0,
        y_label="$f_{gro}$ at $B_{off}$ = 0",
    ),
)
