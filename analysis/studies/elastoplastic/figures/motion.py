"""d and v of all seeds against time, and v beside Andrews's model: A24 Figs. 4, 12; the force chains: Fig.
13."""

import numpy as np

from ....figures.of_run.forces import forces_figure
from ....figures.of_run.grains import grains_figure
from ....figures.style import NANO, styled
from ....runs.table import run_folder
from ....theory.andrews import Spheres
from ....theory.andrews_motion import motion, rigid_motion
from ...definition import StudyFigure
from .. import paper
from ..velocity_fit import reduced_radius
from .common import MEGA, OURS, PAPER, filling_text, legend, letter, main_filling, panels

_RED, _GREY, _ENOUGH = "#c62828", "0.6", 3
_FORCE_TIMES = (250e-9, 300e-9, 350e-9, 400e-9)  # s, A24 Fig. 13
_SNAPSHOT_TIMES = tuple(k * 100e-9 for k in range(6))  # s, A24 Fig. 3


def shown_rows(results):
    """Rows (namedtuples of the table) of the point whose motion is shown: of the main filling, at the velocity of its size
    fit, the largest size that has three seeds (or as many as any has). Of these, where there are any, the runs whose folders
    are at hand."""
    filling = main_filling(results)
    velocity = results.by_filling[filling].size_fit.velocity
    runs = results.runs(filling, velocity=velocity)
    if runs.folder.notna().any():
        runs = runs[runs.folder.notna()]
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
        spheres = Spheres(reduced_radius(row.radius, offset), density, *moduli)
        model = (motion if np.isfinite(moduli[1]) else rigid_motion)(row.velocity, spheres)
        contact = 2.0 * (results.grain_radius - offset) / row.velocity
        time = np.linspace(0.0, last, 1500)
        place.plot(
            time * NANO,
            model.velocity(time - contact),
            style,
            color=colour,
            linewidth=1.8,
            label=f"Andrews, {label}: {moduli[0] / MEGA:.3g}, {moduli[1] / MEGA:.3g} MPa, {offset / results.grain_radius:.2f} $r$",
        )
    place.axhline(0.0, color="0.8", linewidth=0.8, zorder=0)
    place.set_xlabel("time $t$  [ns]")
    place.set_ylabel("mutual velocity $v$  [m/s]")
    legend(place, loc="upper right")
    letter(axes, f"{filling_text(row.filling, row.velocity)}, $R$ = {row.radius / row.grain_radius:g} $r$")
    return figure


def _models(filling, results):
    """(moduli, offset [m], colour, style, label) of the models to draw."""
    fit, unit = filling.joint, results.grain_radius
    if fit.reason is None and np.isfinite(fit.values[0]):
        yield fit.values[:2], fit.values[2] * unit, OURS, "-", "our fit"
    if filling.factor in paper.YOUNG:
        moduli = paper.YIELD_STRESS[filling.factor], paper.YOUNG[filling.factor]
        yield moduli, paper.OFFSET[filling.factor] * unit, PAPER, "--", "A24's fit"


def chains_figure(results):
    """Contact forces of the first seed shown, in compression and in tension: Fig. 13. At A24's times where the scene is A24's,
    otherwise at the same fractions of t_max."""
    row = shown_rows(results)[0]
    return forces_figure(run_folder(row), _FORCE_TIMES if _is_papers_scene(row) else None)


def snapshots_figure(results):
    """Grains of the first seed shown, every 100 ns from 0 to 500 ns where the scene is A24's, otherwise at the start, at the
    largest compression and at the end: Fig. 3."""
    row = shown_rows(results)[0]
    return grains_figure(run_folder(row), _SNAPSHOT_TIMES if _is_papers_scene(row) else None)


def _is_papers_scene(row):
    """Whether a run is of the scene of A24's Figs. 3, 4, 12, 13: filling 0.4, R = 80 r, 10^0.5 m/s."""
    scene = round(row.filling, 6), round(row.radius / row.grain_radius, 3)
    return scene == (0.4, 80.0) and abs(row.velocity / paper.VELOCITY - 1.0) < 1e-3


FIGURES = (
    StudyFigure("fig03_snapshots", "A24 Fig. 3: snapshots of a collision.", snapshots_figure, vector=False),
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
    StudyFigure("fig13_forces", "A24 Fig. 13: contact forces, compression and tension.", chains_figure, vector=False),
)
