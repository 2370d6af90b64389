"""Tables of the study of what the atlas leaves out: drag, surface energy, spin, unlike radii, two materials, sintered
necks, rolling, and springs that are missing.

desk: 1,000 pairs of BPCA and BCCA aggregates of 100 ice grains collide as they are, and once more with one thing
changed on each axis, one level of it for each pair. Velocities are drawn over v_break, the mean E_break of two grains
over the mean mass of one, so that what scales with it is no change. Rows stand pair by pair."""

from functools import lru_cache
from math import floor, pi

import numpy as np

from analysis.theory import ICE, breaking_velocity
from yade_scripts.experiments.collision import CollisionParameters, step_limit
from yade_scripts.materials import pair_constants
from yade_scripts.packings.aggregate import EQUAL, radii

PAIRS, GRAINS, SEED = 1000, 100, 50_000
SPEEDS, STRUCTURES = (2.0, 25.0), ("bpca", "bcca")  # v_break
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
HEAD = """BPCA and BCCA aggregates of 100 grains: as they are, and with one thing changed (row NUMBER-AXIS-LEVEL).
Units: velocity: m/s; viscoelasticTime: s; surfaceEnergy: J/m^2; spin, projectileSpin: rad/s; smallest, largest,
criticalRolling, grainRadius: m; stepFraction: t0."""


def tables():
    """{size: (rows, head)}."""
    return {"desk": ([row for number in range(PAIRS) for row in rows_of(number)], HEAD)}


def rows_of(number):
    """The rows of a pair: unchanged, then one a changed axis."""
    draw = np.random.default_rng([SEED, number])
    speed = SPEEDS[0] * (SPEEDS[1] / SPEEDS[0]) ** draw.random()
    pair = {"packing": STRUCTURES[number // 2 % 2], "grains": GRAINS, "grainRadius": "1e-7", "seed": SEED + number}
    pair |= {"impact": f"{draw.random() ** 0.5:.6g}"}
    changes = {"base-none": {}}
    for axis, levels in AXES.items():
        level = list(levels)[number % len(levels)]
        changes[f"{axis}-{level}"] = levels[level]
    for name, change in changes.items():
        given = {**pair, **change}
        scale, step = scale_and_step(tuple({**given, "seed": 1, "impact": 0}.items()))
        row = {"description": f"{number:04d}-{name}", **given, "velocity": f"{speed * scale:.6g}"}
        yield {**row, "stepFraction": step, "threads": 1, "states": 9, "out": f"runs/axes/{number:04d}-{name}"}


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
