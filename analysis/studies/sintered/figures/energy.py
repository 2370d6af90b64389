"""Energy and broken necks: S17 Figs 14, 15, the modes, and the chain model of Fig. 17."""

import numpy as np

from ....figures.style import styled
from ....runs.format import BROKEN_BONDS
from ...definition import StudyFigure
from .. import paper
from ..bouncing import predicted_ratio
from ..fits import OWN, Law
from ..measure import EARLY, LABELS, PARTS
from .common import (
    PAPER,
    beta_label,
    draw_points,
    growth_label,
    legend,
    letter,
    lines_of,
    neck_colour,
    order_colour,
    panels,
    velocity_axis,
)


@styled
def partition(results):
    """Parts of the energy after EARLY periods and at the end against beta, BCCA at 10 m/s: Fig. 14."""
    points = sorted(results.main(growth_velocity=0.0, velocity=10.0), key=lambda p: p.neck)
    times = {f"_{EARLY}": f"after {EARLY:,} periods", "": "at the end"}
    times = {ending: when for ending, when in times.items() if any(p.means[f"part_kinetic{ending}"] for p in points)}
    if len(points) < 2:
        return None
    figure, axes = panels(1, len(times))
    for place, (ending, when) in zip(axes[0], times.items()):
        for number, name in enumerate(PARTS):
            if any(abs(p.means[f"part_{name}"][0]) > 1e-3 for p in points):
                necks = [p.neck for p in points]
                draw_points(place, necks, points, f"part_{name}{ending}", order_colour(number), LABELS[name])
        place.set_xlabel(r"$\beta$  (0: unsintered)")
        place.set_ylabel(f"fraction of $K(0)$ {when}")
        place.set_ylim(*_PARTS_RANGE)
    legend(axes[0, 0], fontsize=8)
    letter(axes, "BCCA, 10 m/s")
    return figure


_PARTS_RANGE = (-0.6, 1.25)  # one for both panels


def _kinds(results):
    """[(label, [Point])] of Fig. 15: BCCA by beta, compacted ones by V_g."""
    sintered = [p for p in results.main() if p.neck]
    found = []
    for neck in (0.2, 0.7):
        found.append((f"BCCA, {beta_label(neck)}", [p for p in sintered if not p.growth_velocity and p.neck == neck]))
    for velocity in sorted({p.growth_velocity for p in sintered} - {0.0}):
        found.append((growth_label(velocity), [p for p in sintered if p.growth_velocity == velocity and p.neck == 0.7]))
    return [(label, sorted(own, key=lambda p: p.energy_ratio)) for label, own in found if own]


@styled
def against_energy(results):
    """Broken necks, mass in fragments and sticking efficiency against E_k/E_sint, with S17's fit and ours of
    its selection: Fig. 15."""
    kinds = _kinds(results)
    if not kinds:
        return None
    figure, axes = panels(1, 3, 4.8)
    names = {"cut_per_grain": "$N_{cut}/N_t$", "fragments": "mass in fragments", "largest": "sticking efficiency"}
    for place, (quantity, label) in zip(axes[0], names.items()):
        for number, (name, points) in enumerate(kinds):
            draw_points(
                place, [p.energy_ratio for p in points], points, quantity, order_colour(number), name, line="none"
            )
        place.set_xscale("log")
        place.set_xlabel("$E_k/E_{sint}$")
        place.set_ylabel(label)
    ratios = [p.energy_ratio for _, points in kinds for p in points]
    x = np.geomspace(min(ratios), max(ratios), 50)
    first = axes[0, 0]
    first.plot(x, Law(*paper.FIT).at(x), "--", color=PAPER, lw=1.2, label="S17's fit")
    own = results.fits.get((1, 0.0), {}).get(OWN)
    if own is not None:
        x = np.geomspace(own.lowest, own.highest, 50)
        first.plot(x, own.counts.at(x), "-", color="0.4", lw=1.2, label=r"ours, $\beta$ = 0.7 (counts)")
    first.set_yscale("log")
    legend(first, fontsize=7)
    letter(axes, "")
    return figure


@styled
def modes(results):
    """Which mode breaks necks, in per cent of all that broke, by beta in the plane and in space."""
    table = results.sintered()
    groups = [
        (("plane" if planar else "space") + f"\n{beta_label(neck)}", runs[list(BROKEN_BONDS)].sum().to_numpy())
        for (planar, neck), runs in table.groupby([1 - table.planar, table.neck])
        for planar in [1 - planar]
    ]
    groups = [(label, count) for label, count in groups if count.sum()]
    if not groups:
        return None
    figure, axes = panels(1, 1, 1.5 + 0.9 * len(groups))
    bottom = np.zeros(len(groups))
    for number, name in enumerate(BROKEN_BONDS):
        height = np.array([100 * count[number] / count.sum() for _, count in groups])
        label = name.removeprefix("brokenBy").lower()
        axes[0, 0].bar(range(len(groups)), height, bottom=bottom, color=order_colour(2 * number), label=label)
        bottom += height
    axes[0, 0].set_xticks(range(len(groups)), [label for label, _ in groups], fontsize=8)
    axes[0, 0].set_ylabel("broken necks  [per cent]")
    legend(axes[0, 0], fontsize=8, loc="center left", bbox_to_anchor=(1.0, 0.5))
    return figure


def _chains_of_beta(place, compacted):
    for number, (value, own) in enumerate(lines_of(compacted, "growth_velocity")):
        _ratios(place, [p.neck for p in own], own, order_colour(number), growth_label(value))
    place.set_xlabel(r"$\beta$")


def _chains_of_velocity(place, bcca):
    for neck, own in lines_of(bcca, "neck"):
        _ratios(place, [p.velocity for p in own], own, neck_colour(neck), beta_label(neck))
    loops = [(p.velocity, predicted_ratio(p, paper.LOOP_GRAINS)) for p in bcca if p.neck == 0.7]
    if loops:
        place.plot(*zip(*sorted(loops)), "s:", color="0.4", markersize=4, label=r"$\beta$ = 0.7, loops: N = 22")
    velocity_axis(place, [p.velocity for p in bcca])


@styled
def chain_model(results):
    """F_c/F_max of the chain model: against beta for V_c = V_g, against velocity for BCCA, with what the runs did: Fig. 17."""
    compacted = [p for p in results.main() if p.neck and p.growth_velocity and p.velocity == p.growth_velocity]
    bcca = [p for p in results.main(growth_velocity=0.0) if p.neck]
    if not compacted and not bcca:
        return None
    drawn = [(draw, points) for draw, points in ((_chains_of_beta, compacted), (_chains_of_velocity, bcca)) if points]
    figure, axes = panels(1, len(drawn))
    for place, (draw, points) in zip(axes[0], drawn):
        draw(place, points)
        place.axhline(1.0, color="0.6", lw=0.8)
        place.set_yscale("log")
        place.set_ylabel("$F_c/F_{max}$  (filled: half or more bounce)")
        legend(place, fontsize=7)
    letter(axes, "")
    return figure


def _ratios(place, x, points, colour, label):
    ratio = np.array([predicted_ratio(p) for p in points])
    shown = ratio > 0  # eq 17 diverges for the others
    if not shown.any():
        return
    place.plot(np.asarray(x)[shown], ratio[shown], color=colour, lw=1.0, label=label)
    for at, value, point in zip(x, ratio, points):
        if value > 0:
            face = colour if 2 * point.bouncing >= point.runs else "white"
            place.plot([at], [value], "o", markersize=5, color=colour, markerfacecolor=face)


FIGURES = (
    StudyFigure(
        "fig14_energy",
        "S17 Fig. 14: where the energy is, against beta, at two times. Bars: standard errors.",
        partition,
    ),
    StudyFigure(
        "fig15_necks",
        "S17 Fig. 15: broken necks, fragments, sticking against the energy. Bars: standard errors.",
        against_energy,
    ),
    StudyFigure("fig17_chains", "S17 Fig. 17: the chain model, and which runs bounced.", chain_model),
    StudyFigure("modes", "Which mode breaks necks, in the plane and in space.", modes),
)
