"""d and v of all seeds against time, and v beside Andrews's model: A24 Figs. 4, 12; the force chains: Fig.
13."""

import numpy as np

from ....figures.of_run.forces import forces_figure
from ....figures.style import NANO, styled
from ....runs.table import run_folder
from ....theory.andrews import Spheres
from ....theory.andrews_motion import motion
from ...definition import StudyFigure
from .. import paper
from ..velocity_fit import reduced_radius
from .common import MEGA, OURS, PAPER, filling_text, legend, letter, main_filling, panels

_RED, _GREY, _ENOUGH = "#c62828", "0.6", 3


def shown_rows(results):
    """Rows (namedtuples of the table) of the point whose motion is shown: of the main filling, at the velocity of its size
    fit, the largest size that has three seeds (or as many as any has)."""
    filling = main_filling(results)
    velocity = results.by_filling[filling].size_fit.velocity
    runs = results.runs(filling, velocity=velocity)
    seeds = runs.radius.value_counts()
    radius = max(seeds[seeds >= min(_ENOUGH, seeds.max())].index)
    return list(runs[runs.radius == radius].sort_values("seed").itertuples())


@styled
def motion_figure(results):
    """d and v of every seed against time, the first seed in red: Fig. 4."""
    rows = shown_rows(results)
    figure, axes = panels(1, 2, 5.4, 4.4)
    for number, row in reversed(list(enumerate(rows))):
        history = run_folder(row).history
        colour, width = (_RED, 1.8) if number == 0 else (_GREY, 0.9)
        axes[0, 0].plot(history["time"] * NANO, history["d"] / row.grain_radius, color=colour, linewidth=width)
        axes[0, 1].plot(history["time"] * NANO, history["v"], color=colour, linewidth=width)
    row = rows[0]
    line = paper.line(round(row.filling, 6))
    radius = row.radius / row.grain_radius
    if line and abs(row.velocity / paper.VELOCITY - 1.0) < 1e-3:
        axes[0, 0].axhline(
            line[0] * radius - line[1],
            color=PAPER,
            linestyle="--",
            linewidth=1.2,
            label=f"A24's line: $d_{{max}}$ = {line[0] * radius - line[1]:.2f} $r$",
        )
        legend(axes[0, 0], loc="lower right")
    for place in axes[0]:
        place.axhline(0.0, color="0.8", linewidth=0.8, zorder=0)
        place.set_xlabel("time $t$  [ns]")
    axes[0, 0].set_ylabel("compression length $d$  [grain radii]")
    axes[0, 1].set_ylabel("mutual velocity $v$  [m/s]")
    letter(axes, f"{filling_text(row.filling, row.velocity)}, $R$ = {radius:g} $r$, {len(rows)} seeds")
    return figure


@styled
def andrews_figure(results):
    """v of every seed against time beside Andrews's model, through the return phase, with our moduli and with
    A24's: Fig. 12."""
    rows = shown_rows(results)
    row, filling = rows[0], results.by_filling[main_filling(results)]
    figure, axes = panels(1, 1, 6.4, 4.8)
    place = axes[0, 0]
    last = 0.0
    for number, each in enumerate(rows):
        history = run_folder(each).history
        place.plot(
            history["time"] * NANO,
            history["v"],
            color=_GREY,
            linewidth=0.9,
            label=f"{len(rows)} seeds" if number == 0 else None,
        )
        last = max(last, history["time"][-1])
    for moduli, offset, colour, style, label in _models(filling, results):
        density = filling.factor * results.grain_density
        model = motion(row.velocity, Spheres(reduced_radius(row.radius, offset), density, *moduli))
        contact = 2.0 * (results.grain_radius - offset) / row.velocity
        time = np.linspace(0.0, last, 1500)
        place.plot(
            time * NANO,
            model.velocity(time - contact),
            style,
            color=colour,
            linewidth=1.8,
            label=f"Andrews, {label}: {moduli[0] / MEGA:.3g}, {moduli[1] / MEGA:.3g} MPa",
        )
    place.axhline(0.0, color="0.8", linewidth=0.8, zorder=0)
    place.set_xlabel("time $t$  [ns]")
    place.set_ylabel("mutual velocity $v$  [m/s]")
    legend(place, loc="upper right")
    letter(axes, f"{filling_text(row.filling, row.velocity)}, $R$ = {row.radius / row.grain_radius:g} $r$")
    return figure


def _models(filling, results):
    """(moduli, offset [m], colour, style, label) of the models to draw."""
    fit = filling.velocity_fit
    if fit.reason is None and np.all(np.isfinite(fit.values)):
        yield fit.values, fit.offset, OURS, "-", "our fit"
    if filling.factor in paper.YOUNG:
        yield (
            (paper.YIELD_STRESS[filling.factor], paper.YOUNG[filling.factor]),
            paper.OFFSET[filling.factor] * results.grain_radius,
            PAPER,
            "--",
            "A24's fit",
        )


def chains_figure(results):
    """Contact forces of the first seed shown, around the largest compression: Fig. 13."""
    return forces_figure(run_folder(shown_rows(results)[0]))


FIGURES = (
    StudyFigure(
        "fig04_motion",
        "A24 Fig. 4: compression length and mutual velocity, all seeds (first in red).",
        motion_figure,
    ),
    StudyFigure(
        "fig12_andrews",
        "A24 Fig. 12: mutual velocity beside Andrews's model with its return phase.",
        andrews_figure,
    ),
    StudyFigure("fig13_forces", "A24 Fig. 13: contact forces around the largest compression.", chains_figure),
)
