"""Figures of the study. K13's pressures over many decades are drawn over its eq 25, its dissipated energies as parts of their sum."""

import numpy as np

from ...figures.style import PAPER, legend, panels, styled
from ...theory.compression import tensile_strength
from ..curve_figure import CurveFigure, palette, plain_ticks, points
from ..definition import StudyFigure
from ..levels import level
from ..runs import Runs
from .strength import VALID_TO, by_filling, furthest, named
from .study import ICE

AGREEMENT = (1 / 1.13**3, 1.13**3)  # of P: 13 % in φ at one pressure, which K13 calls good agreement (section 3.7)
STEP = {"stepFraction": 0.3}
SLOW = {**ICE, **STEP, "strainRate": 3e-7}
THOUSAND = {**ICE, **STEP, "grains": 1024, "strainRate": 1e-6}
SILICATE = {"grains": 4096, "strainRate": 3e-7, "criticalRolling": None}  # each material's own displacement
NOTE = "; below 0.03 to 0.06 not every cell is spanned by contacts. Shaded: agreement with eq 25 to 13 % in filling factor."


def _eq_25(axes, panel):
    """Eq 25, and what counts as agreement with it where K13 says that it holds."""
    axes.axhline(1.0, color=PAPER, ls="--", lw=1.2, zorder=0)
    axes.fill_between([1e-4, VALID_TO], *AGREEMENT, color=PAPER, alpha=0.1, lw=0)
    axes.set(xlim=(0.015, 0.3), ylim=(0.2, 5.0))


def _tatsuuma(axes, panel):
    filling = np.geomspace(0.08, 0.5, 50)
    axes.plot(filling, tensile_strength(filling, 0.1, 1e-7) / 1e3, "--", color=PAPER, label="Tatsuuma et al. (2019)")


@styled
def _every_cluster(results):
    """Each cluster thin, and means with errors where all are settled; a panel a number of grains."""
    means, settled = results.series("strength", **SLOW), results.series("dense", **STEP, strainRate=SLOW["strainRate"])
    rows = Runs(by_filling(furthest(named(results.table)))).where(**SLOW).table
    colours = palette(results, "grains")
    sizes = sorted(settled.index.unique("grains"))
    if not sizes:
        return None
    figure, axes = panels(1, len(sizes), 4.4, 4.0)
    for place, grains in zip(axes[0], sizes):
        clusters = [own for _, own in rows[rows.grains == grains].groupby("seed")]
        for own in clusters:
            place.plot(own.filling, own.over.where(own.over > 0), color=colours[grains], lw=0.8, alpha=0.6)
        where = settled.loc[grains].index
        text = f"mean of {len(clusters)} clusters at most" if len(clusters) > 1 else "1 cluster"
        points(place, where, [means.loc[grains, filling] for filling in where], colours[grains], text)
        place.set(
            xscale="log", yscale="log", title=level("grains").label(grains), xlabel=level("filling").head(math=True)
        )
        _eq_25(place, {})
        place.set(xlim=(1e-3, 0.3))
        plain_ticks(place.yaxis)
        legend(place, fontsize=9, loc="lower right")
    axes[0, 0].set_ylabel(r"$P$ over eq 25, $(E_{roll}/r_0^3)\,\phi^3$")
    return figure


def _over_eq_25(name, caption, colour, panel="", **where):
    drawn, where = ("strength", "filling", colour, panel), _others({**THOUSAND, **where}, colour, panel)
    return CurveFigure(name, caption + NOTE, *drawn, where, "xy", "$P$ over eq 25", paper=_eq_25)


def _shares(name, caption, panel, **where):
    drawn, where = ("shares", "until", "channel", panel), _others({**THOUSAND, "since": 0.0, **where}, panel)
    return CurveFigure(name, caption, *drawn, where, "x", "part of all dissipated  [%]", (0.0, 100.0))


def _others(where, *drawn):
    """The values of levels that are not drawn, without those that are left open."""
    return {name: value for name, value in where.items() if name not in drawn and value is not None}


FIGURES = (
    StudyFigure(
        "fig04_strength",
        "Pressure over eq 25 against filling factor, C_v = 3e-7 (K13 Figs 4, 6). Lines: clusters; points: means where contacts span every cell (open: one cluster). "
        "Shaded: agreement.",
        _every_cluster,
    ),
    _over_eq_25("fig05_rate", "K13 Fig. 5 with 1,024 grains", "strainRate"),
    _over_eq_25("fig07_damping", "K13 Fig. 7 with 1,024 grains, for two time steps", "linearDamping", "stepFraction"),
    _shares("fig08_energy", "K13 Fig. 8 with 1,024 grains: where the work went", "linearDamping", stepFraction=0.1),
    _over_eq_25("fig09_rolling", "K13 Fig. 9 with 1,024 grains", "criticalRolling"),
    _shares("fig10_energy", "K13 Fig. 10 with 1,024 grains: where the work went", "criticalRolling"),
    CurveFigure(
        "fig11_structure",
        "Fractal dimension between 3 and 10 grain radii, C_v = 3e-7 (K13 Fig. 11 draws N(< r) beside 2 and 3).",
        *("dimension", "filling", "grains"),
        where=SLOW,
        logarithmic="x",
        y_label="$D$",
        level_line=2.0,
    ),
    _over_eq_25("fig12_silicate", "K13 Fig. 12 with 4,096 grains, C_v = 3e-7", "material", **SILICATE),
    CurveFigure(
        "whole_range",
        "Pressure of K13's ice over the formula of Tatsuuma et al. (2023) for any filling factor.",
        *("dense", "filling", "strainRate", "grains"),
        STEP,
        "x",
        r"$P$ over $(E_{roll}/r_0^3)(1/\phi - 1/0.74)^{-3}$",
        limits=(0.0, None),
        level_line=1.0,
    ),
    CurveFigure(
        "tension",
        "Largest tension while a cell of 1,024 grains is stretched along one axis.",
        *("tensile", "finalFilling"),
        where={**THOUSAND, "stretched_axes": 1},
        logarithmic="xy",
        y_label="tensile strength  [kPa]",
        paper=_tatsuuma,
    ),
)
