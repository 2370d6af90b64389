"""Figures of the study: S17's own, springs that are cut beside springs that are held, and what space changes."""

from functools import partial
from pathlib import Path

import numpy as np

from ...figures.panels import PAPER, legend, letter, panels, velocity_axis
from ...figures.style import styled
from ...theory import ICE, pair_constants
from ...theory.chains import stretching_period
from ..curve_figure import MARKERS, CurveFigure, colours, pairs_text, points
from ..definition import StudyFigure
from ..levels import level
from ..paper import read_paper
from ..runs import alike
from ..snapshot_figure import SnapshotFigure
from .measure import LABELS, energy_ratio
from .models import papers_necks
from .study import LOST

GRAIN = {"grainRadius": 1e-7, "density": ICE.density, "surfaceEnergy": ICE.surface_energy}
PERIOD = stretching_period(pair_constants(ICE, GRAIN["grainRadius"]))
BCCA, STRONG, RULES = {"growth_velocity": 0.0}, {"neck": 0.7}, ("cut", "held")
LARGEST = "mass in the largest piece"


def _colours(results, name):
    return colours(results["largest"].values.index.get_level_values(name))


@styled
def _held(results):
    """Largest piece with either rule and S17's words on it: against velocity, unsintered and beta = 0.7, and against beta."""
    figure, axes = panels(1, 3, 4.6)
    panel = ("unsintered", {"neck": 0.0}, "velocity"), ("β = 0.7", STRONG, "velocity"), ("30 m/s", {"velocity": 30.0}, "neck")
    for place, (title, fixed, x) in zip(axes[0], panel):
        for setup, marker in zip(RULES, MARKERS):
            series = results.series("largest", setup=setup, **BCCA, **fixed).sort_index()
            if len(series):
                at, colour = series.index.get_level_values(x), _colours(results, "setup")[setup]
                points(place, at, series.to_list(), colour, f"springs {setup}, {pairs_text(series)}", marker)
        _said(place, fixed, x)
        place.set_title(title, fontsize=10)
        if x == "velocity":
            velocity_axis(place, [3.1, 51.0])
        place.set_xlabel(level(x).axis())
        place.set_ylim(0, 1.05)
        place.axhline(0.5, color="0.7", lw=0.8, zorder=0)
    axes[0, 0].set_ylabel(LARGEST)
    legend(axes[0, 1], fontsize=8)
    letter(axes, "")
    return figure


def _said(axes, fixed, x):
    """What S17's text sets for the largest piece there, from paper.toml: bars between limits, a cross at its critical velocity."""
    label = "S17's words"
    for claim in read_paper(Path(__file__).parent)[1]:
        where = claim.where
        if where.get("setup") != "held" or any(not alike([where.get(n, np.nan)], v)[0] for n, v in fixed.items()):
            continue
        low, high = np.clip(claim.limits, 0.0, 1.0)
        if claim.quantity == "largest" and where["growth_velocity"] == 0 and low < high and claim.test:
            axes.plot([where[x]] * 2, [low, high], "-", color=PAPER, lw=9, alpha=0.2, solid_capstyle="butt", label=label)
        elif claim.quantity == "growth_limit":
            axes.plot([claim.value], [0.5], "x", color=PAPER, markersize=10, mew=2, label=label)
        else:
            continue
        label = None


@styled
def _necks(results):
    """Broken necks, mass in fragments and the largest piece against E_k/E_sint, with S17's fit: Fig. 15."""
    figure, axes = panels(1, 3, 4.6)
    grown = _colours(results, "growth_velocity")
    kinds = [({"neck": 0.2, **BCCA}, "0.6", "BCCA, β = 0.2")]
    kinds += [({**STRONG, "growth_velocity": g}, c, f"$V_g$ = {g:g} m/s" if g else "BCCA") for g, c in grown.items()]
    for place, name in zip(axes[0], ("necks", "fragments", "largest")):
        for (where, colour, label), marker in zip(kinds, MARKERS + MARKERS):
            series = results.series(name, setup="cut", **where).sort_index()
            series = series[series.map(lambda own: own.value > 0)] if name == "necks" else series
            if len(series):
                ratios = [energy_ratio(where["neck"], v, **GRAIN) for v in series.index.get_level_values("velocity")]
                points(place, ratios, series.to_list(), colour, f"{label}, {pairs_text(series)}", marker, "")
        place.set_xscale("log")
        place.set_xlabel("$E_k/E_{sint}$")
    ratios = np.array([0.01, 20.0])
    axes[0, 0].plot(ratios, papers_necks(ratios), "--", color=PAPER, lw=1.2, label="S17's fit")
    axes[0, 0].set_yscale("log")
    for place, label in zip(axes[0], ("$N_{cut}/N_t$", "mass in fragments", LARGEST)):
        place.set_ylabel(label)
    legend(axes[0, 0], fontsize=7)
    letter(axes, "springs cut, β = 0.7")
    return figure


@styled
def _chains(results):
    """F_c/F_max of the chain model against velocity, and which runs bounced: Fig. 17."""
    figure, axes = panels(1, 3, 4.6)
    for place, setup in zip(axes[0], (*RULES, "space")):
        for (growth, colour), marker in zip(_colours(results, "growth_velocity").items(), MARKERS):
            for key, own in results.series("chain_ratio", setup=setup, growth_velocity=growth).items():
                bounced = results["bouncing"].values[(setup, growth, *key)]
                face = colour if 2 * bounced.successes >= bounced.pairs else "white"
                place.errorbar([key[1]], [own.value], own.error or 0.0, fmt=marker, color=colour, mfc=face, capsize=3)
            place.plot([], [], marker, color=colour, label=f"$V_g$ = {growth:g} m/s" if growth else "BCCA")
        place.axhline(1.0, color=PAPER, ls="--", lw=1.2, label="S17: bouncing below")
        velocity_axis(place, [1.0, 50.0])
        place.set_yscale("log")
        place.set_ylim(0.01, 20)
        place.set_title(f"{setup}, {pairs_text(results.series('bouncing', setup=setup))}", fontsize=10)
    axes[0, 0].set_ylabel("$F_c/F_{max}$  (filled: half of the runs or more bounce)")
    legend(axes[0, 1], fontsize=8, loc="lower left")
    letter(axes, "")
    return figure


def _shown(results, growth, collisions, periods):
    """(row, title, times) of the first pair's collisions (beta, V_c, cut), of BCCA aggregates or compacted at `growth`."""
    table = results.table
    plain = (table.planar == 1) & (table.viscoelasticTime == 0) & alike(table.criticalRolling, 2e-10) & (table.packing_seed == 1)
    for neck, velocity, cut, scale in collisions:
        here = plain & (table.neck == neck) & alike(table.velocity, velocity) & (table.cut == cut)
        title = f"{level('neck').label(neck)}, {velocity:g} m/s, springs {RULES[1 - cut]}"
        for row in table[here & (table.growth_velocity == growth)].itertuples():
            yield row, title, [number * scale * PERIOD for number in periods]


FIG07 = ((0.0, 10.0, 0, 1), (0.0, 30.0, 0, 0.25), (0.7, 3.16, 0, 1), (0.7, 10.0, 0, 1), (0.7, 10.0, 1, 1), (0.7, 30.0, 0, 0.25))
FIG09 = ((0.0, 3.0, 1, 1), (0.7, 3.0, 1, 1))


def _paper_losses(axes, panel):
    for share in (80, 20):
        axes.plot([0.0], [share], "*", color=PAPER, markersize=12, mfc="none", label=None if share == 20 else "S17, unsintered")


AGAINST_VELOCITY = {"x": "velocity", "logarithmic": "x", "panel": "setup"}
AGAINST_BETA = {"x": "neck", "colour": "velocity", "panel": "setup"}

FIGURES = (
    StudyFigure(
        "held",
        "Springs of contacts without necks cut at their limits, as S17's text has it, and held there, beside what its text says of the "
        "largest piece (bars: limits, cross: critical velocity for growth). BCCA aggregates in the plane; bars: standard errors.",
        _held,
    ),
    CurveFigure(
        "fig06_contacts",
        "S17 Fig. 6: contacts a grain against the velocity that compacted the aggregates (0: BCCA); space: not in S17.",
        "contacts",
        "growth_velocity",
        "setup",
        where={"setup": (*RULES, "space")},
        y_label="contacts a grain",
    ),
    SnapshotFigure(
        "fig07_snapshots",
        "S17 Fig. 7: BCCA aggregates, first pair, at the paper's times (0 to 20,000 periods; at 30 m/s a quarter of them). Every panel has its "
        "own scale in grain radii; the last hundredth of the grains may be outside.",
        partial(_shown, growth=0.0, collisions=FIG07, periods=(0, 2500, 5000, 10_000, 20_000)),
    ),
    CurveFigure(
        "fig08_velocity",
        "S17 Fig. 8, left: largest piece of BCCA aggregates against velocity. β = 0: unsintered.",
        "largest",
        colour="neck",
        where={**BCCA, "setup": RULES, "neck": (0.0, 0.2, 0.7)},
        y_label=LARGEST,
        limits=(0, 1.05),
        level_line=0.5,
        **AGAINST_VELOCITY,
    ),
    CurveFigure(
        "fig08_radius",
        "S17 Fig. 8, right: gyration radius of the largest piece in grain radii.",
        "gyration_radius",
        colour="neck",
        where={**BCCA, "setup": RULES, "neck": (0.0, 0.2, 0.7)},
        y_label="$R_g/R$ of the largest piece",
        limits=(0, None),
        **AGAINST_VELOCITY,
    ),
    SnapshotFigure(
        "fig09_snapshots",
        "S17 Fig. 9: aggregates compacted at 3 m/s collide at 3 m/s, first pair, at the paper's times.",
        partial(_shown, growth=3.0, collisions=FIG09, periods=(0, 625, 1250, 2500, 5000)),
    ),
    CurveFigure(
        "fig10_growth",
        "S17 Fig. 10: largest piece of aggregates of β = 0.7 that velocities V_g have compacted (0: BCCA).",
        "largest",
        colour="growth_velocity",
        where={**STRONG, "setup": (*RULES, "space"), "growth_velocity": (0.0, 1.0, 3.0, 10.0)},
        y_label=LARGEST,
        limits=(0, 1.05),
        level_line=0.5,
        **AGAINST_VELOCITY,
    ),
    CurveFigure(
        "fig11_beta",
        "S17 Fig. 11: largest piece of BCCA aggregates against β (0: unsintered); ξ_crit is 2 Å but where 30 Å is said.",
        "largest",
        where={**BCCA, "setup": (*RULES, "30 Å"), "velocity": (10.0, 30.0)},
        y_label=LARGEST,
        limits=(0, 1.05),
        level_line=0.5,
        **AGAINST_BETA,
    ),
    CurveFigure(
        "fig12_fragments",
        "S17 Fig. 12: mass in fragments of BCCA aggregates against β.",
        "fragments",
        where={**BCCA, "setup": RULES, "velocity": (10.0, 30.0)},
        y_label="mass in fragments",
        limits=(0, None),
        **AGAINST_BETA,
    ),
    CurveFigure(
        "fig13_compacted",
        "S17 Fig. 13: largest piece of compacted aggregates that collide at the velocity V_g which compacted them.",
        "largest_own",
        "growth_velocity",
        "neck",
        "setup",
        where={"setup": (*RULES, "space")},
        y_label=LARGEST,
        limits=(0, 1.05),
    ),
    CurveFigure(
        "fig14_energy",
        "S17 Fig. 14: what BCCA aggregates lose at 10 m/s, by the end of the runs, of all that is lost. The paper prints shares of K(0); contacts "
        "that form release surface energy, so that our losses exceed K(0).",
        "lost",
        "neck",
        "part",
        "setup",
        where={"setup": RULES, "part": tuple(LABELS[name] for name in LOST if name != "drag")},
        limits=(0, None),
        y_label="share of what is lost [%]",
        paper=_paper_losses,
    ),
    StudyFigure(
        "fig15_necks",
        "S17 Fig. 15: broken necks, mass in fragments and largest piece against the energy; points without a broken neck are left out.",
        _necks,
    ),
    StudyFigure(
        "fig17_chains",
        "S17 Fig. 17: the chain model, which predicts bouncing below 1, for all β, and which runs bounced. Bars: standard errors, from the "
        "contacts of the aggregates; chains of three contacts a grain or more (V_g = 10 m/s) are outside of the model.",
        _chains,
    ),
    CurveFigure(
        "modes",
        "Which mode breaks the necks of BCCA aggregates, at all velocities.",
        "modes",
        "neck",
        "mode",
        "setup",
        where={**BCCA, "setup": ("cut", "space")},
        y_label="of the necks that broke [%]",
    ),
    CurveFigure(
        "space",
        "Broken necks in space beside the plane, β = 0.7 (V_g = 0: BCCA), springs cut.",
        "necks",
        "velocity",
        "setup",
        "growth_velocity",
        where={**STRONG, "setup": ("cut", "space"), "growth_velocity": (0.0, 1.0, 3.0), "velocity": (10.0, 15.0, 20.0, 30.0, 50.0)},
        y_label="$N_{cut}/N_t$",
        logarithmic="xy",
    ),
)
