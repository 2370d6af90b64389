"""Tables of the study of what the atlas leaves out: drag, surface energy, spin, unlike radii, two materials, sintered
necks, rolling, and springs that are missing.

desk: 1,000 pairs of BPCA and BCCA aggregates of 100 ice grains collide as they are, and once more with one thing
changed on each axis, one level of it for each pair. large: 60 pairs of BPCA aggregates of 2,000 grains about the
threshold of fragmentation, and once more with each of CHANGES_OF_LARGE. Velocities are drawn over v_break, the mean
E_break of two grains over the mean mass of one, so that what scales with it is no change. Rows stand pair by pair."""

from functools import lru_cache
from math import floor, pi

import numpy as np

from analysis.theory import ICE, breaking_velocity
from yade_scripts.experiments.collision import CollisionParameters, step_limit
from yade_scripts.materials import pair_constants
from yade_scripts.packings.aggregate import EQUAL, radii

SEED = 50_000
DESK, DESK_GRAINS, DESK_SPEEDS = range(1000), 100, (2.0, 25.0)  # numbers of pairs, grains of each aggregate, v_break
LARGE, LARGE_GRAINS, LARGE_SPEEDS = range(1000, 1060), 2000, (8.0, 25.0)
LONGEST = 0.2  # step [t0], as of the atlas; a tenth below the limit of stability where that is less
SAMPLE = 10_000  # radii of which mean energy and mass are taken
AXES = {  # {axis: {level: what is changed}}
    "drag": {"2ps": {"viscoelasticTime": "2e-12"}, "6ps": {"viscoelasticTime": "6e-12"}},
    "gamma": {"0.02": {"surfaceEnergy": "0.02"}, "0.05": {"surfaceEnergy": "0.05"}},
    "spin": {level: {"spin": level, "projectileSpin": level} for level in ("2e6", "6e6")},
    "radii": {
        "lognormal": {"sizes": "lognormal", "sizeSpread": "0.4"},
        "powerlaw": {"sizes": "powerlaw", "sizeExponent": "-3.5", "smallest": "5e-8", "largest": "3e-7"},
    },
    "materials": {
        "mixed": {"material": "ice,silicate", "materialFraction": "0.5"},
        "apart": {"material": "ice,silicate", "layout": "target-projectile"},
    },
    "necks": {level: {"neck": level} for level in ("0.15", "0.3")},
    "rolling": {"2A": {"criticalRolling": "2e-10"}, "32A": {"criticalRolling": "32e-10"}},
    "springs": {f"no-{spring}": {spring: 0} for spring in ("sliding", "rolling", "twisting")},
}
CHANGES = {f"{axis}-{level}": change for axis, levels in AXES.items() for level, change in levels.items()}
CHANGES_OF_LARGE = [name for name in CHANGES if name.startswith(("springs", "rolling")) or name == "gamma-0.02"]
HEAD = """Aggregates of {} ice grains: as they are, and with one thing changed (row NUMBER-AXIS-LEVEL).
Units: velocity: m/s; viscoelasticTime: s; surfaceEnergy: J/m^2; spin, projectileSpin: rad/s; smallest, largest,
criticalRolling, grainRadius: m; stepFraction: t0."""


def tables():
    """{size: (rows, head)}."""
    desk = [row for number in DESK for row in of_desk(number)]
    large = [row for number in LARGE for row in of_large(number)]
    return {"desk": (desk, HEAD.format(f"{DESK_GRAINS:,}")), "large": (large, HEAD.format(f"{LARGE_GRAINS:,}"))}


def of_desk(number):
    """The rows of a pair: unchanged, then one a changed axis, at one of its levels."""
    changed = [f"{axis}-{list(levels)[number % len(levels)]}" for axis, levels in AXES.items()]
    structure = ("bpca", "bcca")[number // 2 % 2]
    return rows_of(number, {"packing": structure, "grains": DESK_GRAINS}, DESK_SPEEDS, changed, "runs/axes")


def of_large(number):
    """The same: unchanged, then each of CHANGES_OF_LARGE."""
    packing = {"packing": "bpca", "grains": LARGE_GRAINS}
    return rows_of(number, packing, LARGE_SPEEDS, CHANGES_OF_LARGE, "runs/axes-large")


def rows_of(number, packing, speeds, changed, folder):
    """The rows of a pair: unchanged, then with each of these CHANGES; folder: of the run folders."""
    draw = np.random.default_rng([SEED, number])
    speed = speeds[0] * (speeds[1] / speeds[0]) ** draw.random()
    pair = {**packing, "grainRadius": "1e-7", "seed": SEED + number, "impact": f"{draw.random() ** 0.5:.6g}"}
    for name in ("base-none", *changed):
        given = {**pair, **CHANGES.get(name, {})}
        scale, step = scale_and_step(tuple({**given, "seed": 1, "impact": 0}.items()))
        row = {"description": f"{number:04d}-{name}", **given, "velocity": f"{speed * scale:.6g}"}
        yield {**row, "stepFraction": step, "threads": 1, "states": 9, "out": f"{folder}/{number:04d}-{name}"}


@lru_cache
def scale_and_step(given):
    """(v_break [m/s], time step [t0]) of collisions with these cells, ((column, value), ...)."""
    parameters = CollisionParameters.parse({name: str(value) for name, value in given})
    grain_radius, each = parameters.grainRadius, parameters.of_each()
    constants, ends, some = pair_constants(parameters, neck=parameters.neck), None, [grain_radius]
    if parameters.sizes != EQUAL:
        drawn = np.sort(radii(parameters.changed(grains=SAMPLE), 0))
        ends, some = (drawn[0], drawn[-1]), drawn[SAMPLE // 40 :: SAMPLE // 20]
    grains = [(own, radius) for own in each for radius in some]
    pairs = [pair_constants(one, (r1, r2), other=other) for one, r1 in grains for other, r2 in grains]
    energy = np.mean([pair["pullOffForce"] * pair["pullOffOverlap"] for pair in pairs])
    mass = np.mean([4 / 3 * pi * own.density * radius**3 for own, radius in grains])
    ice = pair_constants(CollisionParameters.parse({"grainRadius": str(grain_radius)}))
    of_ice = ice["pullOffForce"] * ice["pullOffOverlap"] / (2 * ice["reducedMass"])
    step = min(LONGEST, floor(900 * step_limit(parameters, constants, ends)) / 1000)
    return breaking_velocity(ICE, grain_radius) * (energy / mass / of_ice) ** 0.5, step
