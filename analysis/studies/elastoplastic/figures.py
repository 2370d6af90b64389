"""Figures of the study: A24's own, and what the packings and the velocity change."""

from functools import partial
from types import SimpleNamespace

import numpy as np

from ...figures.style import OURS, PAPER, legend, letter, panels, styled
from ...theory import ICE
from ..curve_figure import MARKERS, CurveFigure, pairs_text, points
from ..definition import StudyFigure
from ..grains import PAPERS
from ..snapshot_figure import SnapshotFigure
from .andrews_fit import PRINTED, VELOCITY, degenerate_curve, printed
from .study import FREE

GRAIN = SimpleNamespace(grain_density=ICE.density, grain_radius=PAPERS["ice"]["grainRadius"])
SNAPSHOTS = (0.0, 150e-9, 500e-9)  # s
SNAPSHOTS_RADIUS = 40.0  # grain radii: a size whose states can be kept
SIZES = (40.0, 60.0, 80.0)  # that have several velocities
OF_SIZE = {"d_max": "$d_{max}$  [$r$]", "t_max": "$t_{max}$  [ns]"}
OF_SIZE |= {"deeper": "$d_{max}$ less A24's model  [$r$]", "late": "$t_{max}$ less A24's model  [ns]"}
CHANNELS_SHOWN = ("slidingDissipation", "rollingDissipation", "twistingDissipation", "normal", "sliding", "connection")
OF_VELOCITY = {"x": "velocity", "colour": "radius", "panel": "filling", "logarithmic": "x"}


@styled
def size_figure(results):
    """d_max and t_max at A24's velocity against size beside A24's fitted model, and the same less that model; None without such runs."""
    sizes = results.series("d_max", velocity=VELOCITY).index
    if not len(sizes):
        return None
    figure, axes = panels(2, 2, 5.0, 3.4)
    fillings = sorted(set(sizes.get_level_values("filling")), reverse=True)
    radii = np.linspace(0.0, 1.1 * max(sizes.get_level_values("radius")), 50)
    for k, (place, (name, label)) in enumerate(zip(axes.ravel(), OF_SIZE.items())):
        scale, beside = results[name].scale, k > 1
        for number, filling in enumerate(fillings):
            own = results.series(name, velocity=VELOCITY, filling=filling)
            pairs = None if k else f"$\\phi$ = {filling:g}, {pairs_text(own)} a size"
            x = own.index.to_numpy() + (number - 0.5) * beside
            points(place, x, own.to_list(), OURS, pairs, MARKERS[number], "", scale)
            if filling in PRINTED and not beside:
                model = printed(filling, GRAIN).at(radii, VELOCITY)[k] / scale
                place.plot(radii, model, "--", color=PAPER, lw=1.2, label=None if number else "A24's fitted model")
        if beside:
            place.axhline(0.0, ls="--", color=PAPER, lw=1.2)
        place.set(xlabel="$R$  [$r$]", ylabel=label, xlim=(30.0 if beside else 0.0, radii[-1]))
    legend(axes[0, 0], fontsize=9)
    letter(axes, "")
    return figure


@styled
def moduli_figure(results):
    """Pairs of yield stress and 1/E* with A24's delta_max/R*, A24's values and our fits, with those of resampled pairs: A24 Fig. 10."""
    names = ("stress", "compliance")
    stress, compliance = (results.series(name, fit=FREE).map(results[name].shown) for name in names)
    if not len(stress):
        return None
    units = np.array([[results[name].scale] for name in names])
    figure, axes = panels(1, len(stress), 5.0, 4.2)
    for place, (filling, sigma), soft in zip(axes[0], stress.items(), compliance):
        drawn = sigma.draws[0], np.maximum(soft.draws[0], 0.0)
        place.plot(*drawn, ".", color="0.75", ms=2, label="of resampled pairs", zorder=0)
        errors, label = (soft.error or 0.0, sigma.error or 0.0), f"our fit ({FREE}), {pairs_text([sigma])}"
        place.errorbar(sigma.value, soft.value, *errors, fmt="o", color=OURS, capsize=3, label=label)
        if filling in PRINTED:
            theirs, young, _, ratio = PRINTED[filling]
            curve = degenerate_curve(ratio, filling * GRAIN.grain_density) / units
            place.plot(*curve, "--", color=PAPER, lw=1.2, label=f"A24: $\\delta_{{max}}/R^*$ = {ratio:g}")
            point = [[theirs], [1.0 / young]] / units
            place.plot(*point, "*", ms=13, mfc="none", color=PAPER, label="A24's fit")
        place.set(xlabel=r"yield stress $\sigma_{plastic}$  [MPa]", ylabel="$1/E^*$  [1/GPa];  0: rigid-plastic")
        place.set_title(f"$\\phi$ = {filling:g}", fontsize=10)
        place.set_ylim(-0.05 * place.get_ylim()[1], None)
        legend(place, fontsize=8, loc="lower right")
    letter(axes, "")
    return figure


def _model(axes, panel, number, scale):
    """d_max (number 0) or t_max (1) of A24's fitted model against velocity, in that unit, at the smallest and the largest of SIZES."""
    velocity = np.geomspace(*axes.get_xlim(), 60)
    for radius in (SIZES[0], SIZES[-1]) if panel["filling"] in PRINTED else ():
        value = printed(panel["filling"], GRAIN).at(radius, velocity)[number]
        label = "A24's fitted model, $R$ = 40, 80 $r$" if radius == SIZES[0] else None
        axes.plot(velocity, value / scale, "--", color=PAPER, lw=1.2, label=label)


def _andrews(axes, panel):
    """Square of the restitution of Andrews's spheres with A24's moduli."""
    if panel["filling"] in PRINTED:
        velocity = np.geomspace(*axes.get_xlim(), 60)
        square = printed(panel["filling"], GRAIN).restitution(velocity) ** 2
        axes.plot(velocity, square, "--", color=PAPER, lw=1.2, label="Andrews, with A24's $\\sigma$, $E^*$")


def _collisions(results):
    """The first pair of A24's denser aggregates of a size whose states can be kept."""
    table = results.table
    for row in table[table.run == f"f0.4-R{SNAPSHOTS_RADIUS:g}-i5-s1"].itertuples():
        yield row, f"$\\phi$ = 0.4, $R$ = {SNAPSHOTS_RADIUS:g} $r$, 3.16 m/s", SNAPSHOTS


FIGURES = (
    SnapshotFigure(
        "fig03_snapshots",
        "A24 Fig. 3 at half its size: the first pair at φ = 0.4, R = 40 r, 3.16 m/s; the largest compression is at 161 ns.",
        _collisions,
        held=1.0,
    ),
    StudyFigure(
        "fig05_size",
        "Largest compression and its time at 3.2 m/s (A24 Figs 5 to 7). Bars: standard errors.",
        size_figure,
    ),
    CurveFigure(
        "fig08_compression",
        "A24 Figs 8a and 9a: largest compression against velocity.",
        "d_max",
        where={"radius": SIZES},
        y_label="$d_{max}$  [$r$]",
        paper=partial(_model, number=0, scale=1.0),
        **OF_VELOCITY,
    ),
    CurveFigure(
        "fig08_time",
        "A24 Figs 8b and 9b: its time against velocity.",
        "t_max",
        where={"radius": SIZES},
        y_label="$t_{max}$  [ns]",
        limits=(100.0, 800.0),
        paper=partial(_model, number=1, scale=1e-9),
        **OF_VELOCITY,
    ),
    StudyFigure(
        "fig10_moduli",
        "A24 Fig. 10 with 1/E* in place of E*: yield stress and compliance that give A24's δ_max/R*, A24's fit and ours, with standard errors and the fits of resampled pairs.",
        moduli_figure,
    ),
    CurveFigure(
        "rebound",
        "Kinetic energy in the relative motion of the halves when they part fastest, over K(0).",
        "rebound",
        where={"of": "e²"},
        y_label="returned, of $K(0)$",
        limits=(0.0, 1.05),
        paper=_andrews,
        **OF_VELOCITY,
    ),
    CurveFigure(
        "sticking",
        "Fraction of collisions followed for 3 µs that stick, φ = 0.4. Bars: 95 % intervals (exact).",
        *("sticking", "velocity"),
        panel="radius",
        where={"duration": 3e-6, "filling": 0.4},
        logarithmic="x",
        limits=(0.0, 1.05),
        line="",
        y_label="fraction that sticks",
    ),
    CurveFigure(
        "energy",
        "Where the energy has gone until the largest compression, R = 40 r.",
        *("energy", "velocity", "channel", "filling"),
        where={"radius": 40.0, "channel": CHANNELS_SHOWN},
        logarithmic="x",
        y_label="change  [% of $K(0)$]",
        level_line=0.0,
        limits=(-4.0, 115.0),
    ),
    CurveFigure(
        "zones",
        "Correlation of d_max with the filling of the zones that meet, at 3.16 m/s: 20, 8, 16, 5, 10 pairs.",
        *("zones_by_size", "radius"),
        panel="filling",
        where={"number": "correlation"},
        y_label="correlation",
        level_line=0.0,
        line="",
        limits=(-1.05, 1.05),
    ),
)
