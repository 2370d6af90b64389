"""An answer of the atlas in words, for python3 -m analysis outcome."""

import numpy as np
import pandas

from ..runs.table import read_table
from ..studies.columns import flat
from ..theory import GRAIN_RADIUS, MATERIALS
from .columns import MEASURED, breaking_velocity
from .grid import ERRORS, PROBABILITIES, RUNS_FILE, TOUCHING, outcome
from .neighbours import MARGIN, Neighbours
from .rules import KINDS
from .variables import FEATURES, of_structure, variables

LABELS = {
    TOUCHING: "fraction of such pairs that touch",
    "largest": "largest piece, of the mass",
    "second": "second largest",
    "fragment_index": "n of dN/dm ~ m^-n of all but the largest",
    "filling_after": "filling of the largest piece",
}
# What the intervals are of
WHERE = {"largest": "where there are more: ", "filling_after": ""}
COMMAND = (
    "python3 yade_scripts/studies/atlas.py full {0} {1} && python3 yade_scripts/study.py runs/atlas-full-{0}-{1}.table"
)


def text(options):
    """Lines (str) for the options of commands.outcome. ValueError for what cannot be, or where the atlas is not at hand."""
    averaged = options.impact == "averaged"
    about = (options.material, options.grain_radius, options.maxwell, None if averaged else options.impact)
    pair = options.velocity, options.projectile, options.target, options.filling
    answer = outcome(*pair, *about, structure=options.structure)
    answer = {name: float(value) for name, value in answer.items()}
    point = _point(options)
    table = of_structure(read_table(RUNS_FILE, flat(MEASURED))[0], options.structure) if RUNS_FILE.exists() else None
    ranges = {
        name: f" ({where}{answer[f'{name}_low']:.3g} to {answer[f'{name}_high']:.3g} in 90 %)"
        for name, where in WHERE.items()
        if np.isfinite(answer.get(f"{name}_low", np.nan))
    }
    known = np.isfinite(answer[ERRORS[0]])
    without = "" if known else "; the answer is that of the nearest data, its error is not known"
    near = None if table is None else Neighbours(table)  # None: installed without the repository's tables
    lines = [_title(options, point), *(line + without for line in _beyond(near, point, answer["inside"]))]
    for name, error, kind in zip(PROBABILITIES, ERRORS, KINDS):
        low, high = np.clip([answer[name] - answer[error], answer[name] + answer[error]], 0, 1)
        interval = f"  ({low:.3f} to {high:.3f})" if known else ""
        lines.append(f"  {kind.replace('_', ' '):<42} {answer[name]:.3f}{interval}")
    lines += [f"  {label:<42} {answer[name]:.3g}{ranges.get(name, '')}" for name, label in LABELS.items()]
    return "\n".join([*lines, *_nearest(near, point, averaged)])


def _point(options):
    """The query as a row of variables()."""
    large, small = max(options.projectile, options.target), min(options.projectile, options.target)
    speed = options.velocity / breaking_velocity(MATERIALS[options.material], _radius(options))
    square = 0.5 if options.impact == "averaged" else options.impact**2
    values = {"velocity": speed, "grains": large, "mass_ratio": small / large, "filling": options.filling}
    return pandas.DataFrame([{**values, "impact_square": square}])


def _radius(options):
    """Of the grains [m]."""
    return options.grain_radius or GRAIN_RADIUS[options.material]


def _title(options, point):
    impact = "averaged over impact parameters" if options.impact == "averaged" else f"b = {options.impact:g}"
    speeds = ", rms of a Maxwell distribution" if options.maxwell else ""
    return (
        f"{options.structure} aggregates of {options.projectile:g} and {options.target:g} grains of {options.material}, radius {1e6 * _radius(options):g} um, filling {options.filling:g}, {options.velocity:g} m/s "
        f"({point.velocity[0]:.3g} v_break{speeds}), {impact}:"
    )


def _outside(runs, point):
    """', velocity 79 beyond 0.08 to 26', of the coordinates that lie beyond those of all runs."""
    of_runs = variables(runs)[list(FEATURES[:-1])]
    found = zip(FEATURES, point.iloc[0], of_runs.min(), of_runs.max())
    return "".join(
        f", {name} {own:.3g} beyond {low:.2g} to {high:.3g}" for name, own, low, high in found if not low <= own <= high
    )


def _beyond(near, point, inside):
    """A line where the answer is an extrapolation, or no run is at hand to see."""
    if near is None:
        yield "  within the data" if inside == 1 else f"  EXTRAPOLATION: inside = {inside:.4g} in the table of outcomes"
    elif (beyond := near.beyond(point)[0]) > MARGIN:
        outside = _outside(near.runs, point)
        yield f"  EXTRAPOLATION: {beyond:.2g} times the scatter of the runs beyond the region that they fill{outside}"
    elif inside < 1:
        yield f"  at the edge of the data: inside = {inside:.4g} in the table of outcomes"


def _nearest(near, point, averaged):
    """Lines on the nearest runs."""
    if near is None:
        return
    yield "nearest runs:"
    for run in near.runs.iloc[near.nearest(point, averaged)[0]].itertuples():
        yield (
            f"  {run.run}: {run.structure}, {run.material}, {run.grains_projectile} and {run.grains_target} grains, filling {run.filling_target:.2g}, "
            f"{run.velocity / run.v_break:.3g} v_break, b = {run.impact:.2g}: {run.outcome.replace('_', ' ')}, largest {run.largest:.2g}"
        )
        yield f"    {COMMAND.format(run.number, run.number + 1)}"
