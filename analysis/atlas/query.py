"""What becomes of a collision, from the atlas's tables: analysis.outcome(), and in words for the command line."""

from dataclasses import replace
from functools import lru_cache
from pathlib import Path

import numpy as np
import pandas

from ..arrays import numbers
from ..theory import GRAIN_RADIUS, MATERIALS, breaking_velocity
from ..theory.pair_constants import GRAIN_RADII
from .columns import read_runs
from .outcome_table import ERRORS, INSIDE, INTERVALS, PROBABILITIES, read_outcomes
from .rules import KINDS, change, largest_after
from .variables import GROWN, STRUCTURES, Region, of_structure

FOLDER = Path(__file__).resolve().parents[1] / "gallery" / "atlas"
RUNS_FILE = FOLDER / "runs.csv"
MOSTLY = 0.5  # inside: below it the errors of the nearest data say nothing
GAINING = ("largest", "largest_low", "largest_high")


def outcomes_file(structure, averaged):
    """Path of the atlas's table of outcomes of a structure, averaged over impact parameters or at each one."""
    own = "" if structure == GROWN else f"-{structure}"
    return FOLDER / f"outcomes{own}{'' if averaged else '-impact'}.txt"


def outcome(
    velocity,
    projectile,
    target,
    filling,
    material="ice",
    grain_radius=None,
    maxwell=False,
    impact=None,
    file=None,
    structure=GROWN,
    surface_energy=None,
    young=None,
    density=None,
):
    """What becomes of collisions of two aggregates, from the atlas's tables of outcomes.

    Parameters
    ----------
    velocity : float or array
        [m/s]. Arrays broadcast.
    projectile, target : float or array
        Grains of either aggregate.
    filling : float or array
        Volume filling factor of both, of spheres of radius (5/3)^(1/2) R_g.
    material : {"ice", "silicate"}
        Of the grains.
    grain_radius : float, optional
        [m]; by default 1e-7 of ice, 6e-7 of silicate. With the material it makes v_break, which is all that it changes:
        the runs' grains had 1e-7, and rolling and sliding, which scale differently, are not corrected for.
    maxwell : bool
        Whether the velocity is the root mean square of a Maxwell distribution of speeds.
    impact : float or array, optional
        Impact parameter, 0 to 1, over the sum of these radii; averaged, uniform in its square, if left out.
    file : path, optional
        Another table than those of the atlas.
    surface_energy, young, density : float, optional
        [J/m^2, Pa, kg/m^3]; by default those of the material. They act through v_break, as the radius does.
    structure : {"grown", "close-packed"}
        Which of the atlas's tables: grown by hits of grains and clusters, or compressed; or close-packed.

    Returns
    -------
    dict of arrays
        By column; the first lines of analysis/gallery/atlas/outcomes.txt say what each one is. `inside` is 1 within the
        data and less where the values are extrapolated, at 0 those of the nearest data; below 1/2 errors and intervals
        are NaN. Intervals (`largest_low`, ...), with an impact parameter, are of runs that leave more than one piece:
        `largest`, of all runs, may be outside.
    """
    if structure not in STRUCTURES:
        raise ValueError(f"structure = {structure}: must be {' or '.join(STRUCTURES)}")
    grains = grains_of(material, grain_radius, surface_energy, young, density)
    query = coordinates(velocity, projectile, target, filling, grains, impact)
    table = _table(file or outcomes_file(structure, impact is None), maxwell)
    found, ratio = table.lookup(**query), query["mass_ratio"]
    for name in set(GAINING) & set(found):
        found[name] = np.asarray(largest_after(found[name], ratio))
    if "second" in found:
        most = np.minimum(found["largest"], 1 - found["largest"])
        found["second"] = np.asarray(np.minimum(found["second"] * ratio / (1 + ratio), most))
    for name in {*ERRORS, *INTERVALS} & set(found):
        found[name][found[INSIDE] < MOSTLY] = np.nan
    return found


def coordinates(velocity, projectile, target, filling, grains, impact):
    """{axis of the tables: array} of arguments of outcome(), grains as of grains_of(); ValueError for what they cannot
    be."""
    v_break = breaking_velocity(*grains)
    projectile, target = numbers("projectile", projectile, least=1), numbers("target", target, least=1)
    large, small = np.maximum(projectile, target), np.minimum(projectile, target)
    square = {} if impact is None else {"impact_square": numbers("impact", impact, least=0, most=1) ** 2}
    return {
        "velocity": numbers("velocity", velocity, least=0) / v_break,
        "grains": large,
        "mass_ratio": small / large,
        "filling": numbers("filling", filling, positive=True, most=1),
        **square,
    }


def radius_of(material, grain_radius=None):
    """Radius [m] of grains of a material, that of the papers if left out; ValueError for one that no dust has."""
    if grain_radius is None:
        return GRAIN_RADIUS[material]
    low, high = GRAIN_RADII
    return float(numbers("grain_radius", grain_radius, (), least=low, most=high))


def grains_of(material, grain_radius=None, surface_energy=None, young=None, density=None):
    """(theory.Material, radius [m]) of arguments of outcome(); ValueError for what they cannot be."""
    if material not in MATERIALS:
        raise ValueError(f"material = {material}: must be {' or '.join(MATERIALS)}")
    given = {"surface_energy": surface_energy, "young": young, "density": density}
    own = {name: float(numbers(name, value, (), positive=True)) for name, value in given.items() if value is not None}
    return replace(MATERIALS[material], **own), radius_of(material, grain_radius)


@lru_cache
def _table(file, maxwell):
    """An OutcomeTable with pieces in the smaller aggregate's mass, those of GAINING by rules.change().

    Then interpolation gives 1 for sticking and 0 for bouncing at every mass ratio, and no more is lost than there is.
    """
    table = read_outcomes(file)
    table = table.maxwell() if maxwell else table
    mesh = np.meshgrid(*(axis.nodes for axis in table.axes), indexing="ij", sparse=True)
    ratio = {axis.name: nodes for axis, nodes in zip(table.axes, mesh)}.get("mass_ratio")
    if ratio is None:  # lookup() refuses it
        return table
    values = table.values.copy()
    for k, name in enumerate(table.columns):
        if name in GAINING:
            values[..., k] = change(values[..., k], ratio)
        elif name == "second":
            values[..., k] *= (1 + ratio) / ratio
    return replace(table, values=values)


LABELS = {
    "p_touching": "fraction of such pairs that touch",
    "largest": "largest piece, of the mass",
    "second": "second largest",
    "fragment_index": "n of dN/dm ~ m^-n of all but the largest",
    "filling_after": "filling of the largest piece",
}


def in_words(options):
    """Lines (str) for the options of commands.outcome: the query, whether it is within the data, probabilities, what is
    left, and the nearest runs."""
    pair = options.velocity, options.projectile, options.target, options.filling
    names = "material", "grain_radius", "surface_energy", "young", "density"
    of_grains = {name: getattr(options, name) for name in names}
    found = outcome(*pair, maxwell=options.maxwell, impact=options.impact, structure=options.structure, **of_grains)
    material, radius = grains_of(**of_grains)
    answer = {name: float(value) for name, value in found.items()}
    point = pandas.DataFrame([{"impact_square": 0.5} | coordinates(*pair, (material, radius), options.impact)]).astype(
        float
    )
    speeds = ", rms of a Maxwell distribution" if options.maxwell else ""
    yield (
        f"{options.structure} aggregates of {options.projectile:g} and {options.target:g} grains of "
        f"{options.material} (radius {1e6 * radius:g} um, surface energy {material.surface_energy:g} J/m^2, Young's "
        f"modulus {material.young:g} Pa, density {material.density:g} kg/m^3), "
        f"filling {options.filling:g}, {options.velocity:g} m/s ({point.velocity[0]:.3g} v_break{speeds}), "
        + ("averaged over impact parameters:" if options.impact is None else f"b = {options.impact:g}:")
    )
    known = np.isfinite(answer[ERRORS[0]])
    without = "" if known else "; the answer is that of the nearest data, its error is not known"
    # The repository has the runs, an installed package has not.
    region = Region(of_structure(read_runs(RUNS_FILE), options.structure)) if RUNS_FILE.exists() else None
    if answer[INSIDE] < 1:
        axes = _table(outcomes_file(options.structure, options.impact is None), options.maxwell).axes
        far = [axis for axis in axes if axis.beyond(point[axis.name][0])]
        ends = "".join(f", {a.name} {point[a.name][0]:.3g} beyond {a.nodes[0]:.2g} to {a.nodes[-1]:.3g}" for a in far)
        yield f"  EXTRAPOLATION: inside = {answer[INSIDE]:.3g} (1: within the data){ends}{without}"
    for kind, name, error in zip(KINDS, PROBABILITIES, ERRORS):
        low, high = np.clip([answer[name] - answer[error], answer[name] + answer[error]], 0, 1)
        interval = f"  ({low:.3f} to {high:.3f})" if known else ""
        yield f"  {kind.replace('_', ' '):<42} {answer[name]:.3f}{interval}"
    for name, label in LABELS.items():
        low, high = (answer.get(f"{name}_{end}", np.nan) for end in ("low", "high"))
        which = "where there are more: " if name == "largest" else ""
        interval = f" ({which}{low:.3g} to {high:.3g} in 90 %)" if np.isfinite(low) else ""
        yield f"  {label:<42} {answer[name]:.3g}{interval}"
    if region is not None:
        yield "nearest runs:"
        for run in region.runs.iloc[region.nearest(point, options.impact is None)[0]].itertuples():
            yield from _run(run)


def _run(run):
    """What became of a run, a row of the table, and how to run it again."""
    yield (
        f"  {run.run}: {run.structure}, {run.material}, {run.grains_projectile} and {run.grains_target} grains, "
        f"filling {run.filling_target:.2g}, {run.velocity / run.v_break:.3g} v_break, b = {run.impact:.2g}: "
        f"{run.outcome.replace('_', ' ')}, largest {run.largest:.2g}"
    )
    first, last = run.number, run.number + 1
    yield (
        f"    python3 yade_scripts/studies/atlas.py full {first} {last} && "
        f"python3 yade_scripts/study.py runs/atlas-full-{first}-{last}.table"
    )
