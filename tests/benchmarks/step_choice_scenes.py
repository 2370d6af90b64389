"""The scenes that step_choice.py measures: dictionaries of parameters of collide.py and compress.py, with the set they are in.

The grids are what constants are fitted to; random scenes between and beyond only judge them.
"""

import math
from itertools import product

import numpy as np

from yade_scripts.experiments import collision
from yade_scripts.materials import pair_constants

VELOCITIES, STEPS = (0.3, 1.0, 3.0, 10.0, 30.0), (0.05, 0.1, 0.2, 0.4)
OTHER_VELOCITIES, BONDED_VELOCITIES = (0.5, 2.0, 8.0, 30.0, 80.0), (1.0, 4.0, 12.0, 30.0, 70.0)
GROWN = [
    {"packing": packing, "grains": grains, **({"planar": 1} if planar else {})}
    for packing, grains, planar in (
        ("bpca", 150, 0),
        ("bpca", 600, 0),
        ("bcca", 128, 0),
        ("bcca", 400, 0),
        ("bcca", 128, 1),
        ("bcca", 300, 1),
    )
]
CUT = {"limit": "cut", "criticalRolling": 2e-10}  # S17's


def cpe(radius, filling, **others):
    return {"packing": "cpe", "radius": float(radius), "filling": filling, **others}


def step_limit(given):
    """Largest stable stepFraction of a collision."""
    parameters = collision.CollisionParameters.parse({**given, "stepFraction": 0.01})
    return collision.step_limit(parameters, pair_constants(parameters, neck=parameters.neck))


def at_limit(given, fraction):
    """The scene with a fraction of the largest stable step."""
    return {**given, "stepFraction": math.floor(1000 * fraction * step_limit(given)) / 1000}


def close_packed():
    """CPE in space: drag, fillings, sizes, materials; steps beyond the limit of stability are left out."""

    def scene(radius, filling, velocity, drag, step, seed, material="ice"):
        others = {"velocity": velocity, "viscoelasticTime": drag, "stepFraction": step, "seed": seed}
        return cpe(radius, filling, material=material, **others)

    scenes = [
        scene(10, 0.4, v, drag, s, seed)
        for drag, v, s, seed in product((0.0, 1e-12, 6e-12), VELOCITIES, STEPS, (1, 2, 3))
    ]
    scenes += [
        scene(10, f, v, drag, s, seed)
        for f, drag, v, s, seed in product((0.3, 0.6), (0.0, 6e-12), VELOCITIES, STEPS, (1, 2))
    ]
    scenes += [scene(5, 0.4, v, drag, s, seed) for drag, v, s, seed in product((0.0, 3e-12), VELOCITIES, STEPS, (1, 2))]
    scenes += [scene(10, 0.4, v, 0.0, s, seed, "silicate") for v, s, seed in product(VELOCITIES, STEPS, (1, 2))]
    scenes += [
        scene(20, 0.4, v, drag, s, seed)
        for drag, v, s, seed in product((0.0, 6e-12), VELOCITIES[1:], STEPS[1:], (1, 2))
    ]
    scenes += [
        scene(16, f, v, 0.0, s, seed)
        for f, v, s, seed in product((0.2, 0.3), (1.0, 2.0, 4.0, 10.0), STEPS[1:3], (1, 2))
    ]
    return [{"set": "grid", **s} for s in scenes if s["stepFraction"] <= step_limit(s)]


def other_packings():
    """BPCA, BCCA and planar scenes, with and without drag."""
    scenes = []
    for packing, v, s, seed in product(GROWN, OTHER_VELOCITIES, (0.1, 0.3), (1, 2)):
        oblique = {"impact": 0.5} if seed == 2 and packing["packing"] == "bpca" else {}
        scenes.append({**packing, **oblique, "velocity": v, "stepFraction": s, "seed": seed})
    drag = {"stepFraction": 0.2, "seed": 3, "viscoelasticTime": 3e-12}
    scenes += [{**packing, "velocity": v, **drag} for packing, v in product(GROWN, OTHER_VELOCITIES)]
    scenes += [
        cpe(r, f, planar=1, velocity=v, stepFraction=s, seed=seed)
        for r, f, v, s, seed in product((10, 18), (0.5, 0.75), OTHER_VELOCITIES, (0.1, 0.3), (1, 2))
    ]
    scenes += [cpe(14, f, planar=1, velocity=v, **drag) for f, v in product((0.5, 0.75), OTHER_VELOCITIES)]
    return [{"set": "grid", **s} for s in scenes]


def cut_springs():
    """Springs that are cut at their limits, without necks."""
    packings = (cpe(8, 0.4), GROWN[0], GROWN[4])
    return [
        {"set": "grid", **packing, "velocity": v, "stepFraction": s, "seed": 1, **CUT}
        for packing, v, s in product(packings, OTHER_VELOCITIES, (0.1, 0.3))
    ]


def sintered():
    """Necks in all packings, springs of other contacts held or cut."""
    packings = (
        cpe(7, 0.4),
        cpe(12, 0.7, planar=1),
        {"packing": "bcca", "planar": 1, "grains": 128},
        {"packing": "bcca", "grains": 128},
        {"packing": "bpca", "grains": 150},
    )
    scenes = []
    for packing, neck, v, fraction, seed in product(packings, (0.2, 0.45, 0.7), BONDED_VELOCITIES, (0.5, 1.0), (1, 2)):
        given = {**packing, "neck": neck, "velocity": v, "seed": seed, **(CUT if seed == 2 else {})}
        scenes.append({"set": "grid", **at_limit(given, fraction)})
    return scenes


def random_close_packed(number=120, seed=20):
    """CPE in space: every parameter drawn from a range, uniformly or (velocity, step) in its logarithm."""
    random = np.random.default_rng(seed)
    scenes = []
    for k in range(number):
        drag = float(random.choice([0.0, random.uniform(0.3e-12, 6e-12)]))
        material = str(random.choice(["ice", "ice", "ice", "silicate"]))
        drawn = cpe(
            round(random.uniform(5, 14), 1),
            round(random.uniform(0.2, 0.65), 2),
            velocity=round(float(10 ** random.uniform(-0.3, 1.9)), 3),
            viscoelasticTime=drag if material == "ice" else 0.0,
            seed=100 + k,
            material=material,
        )
        step = round(float(np.exp(random.uniform(np.log(0.04), np.log(step_limit(drawn))))), 4)
        scenes.append({"set": "random", **drawn, "stepFraction": step})
    return scenes


def random_others(number=284, seed=21):
    """Other packings, planar, sintered and cut: likewise."""
    random = np.random.default_rng(seed)
    return [{"set": "random", **_drawn(random, k)} for k in range(number)]


def _drawn(random, k):
    packing, sintered = ("bpca", "bcca", "planar bcca", "planar cpe")[k % 4], (k // 4) % 2 == 1
    given = {"velocity": round(float(10 ** random.uniform(-0.3, 1.9)), 3), "seed": 200 + k}
    given["material"] = str(random.choice(["ice", "ice", "ice", "silicate"]))
    given.update(_drawn_plane(random) if packing == "planar cpe" else _drawn_grown(random, packing))
    if sintered:
        if k % 3 == 0:
            for name in ("planar", "grains", "projectileGrains"):
                given.pop(name, None)
            given.update(cpe(round(float(random.uniform(5, 9)), 1), round(float(random.uniform(0.2, 0.6)), 2)))
        if given["material"] == "silicate":
            given["material"] = "ice" if random.random() < 0.5 else "silicate"
        given["neck"] = round(float(random.uniform(0.18, 0.7)), 2)
    if random.random() < 0.3:
        given["criticalRolling"] = float(random.choice([2e-10, 4e-10, 3.2e-9]))
    if sintered and random.random() < 0.5 or random.random() < 0.15:
        given["limit"] = "cut"
    if random.random() < 0.3 and given["material"] == "ice":
        given["viscoelasticTime"] = float(round(random.uniform(0.3, 6) * 1e-12, 14))
    return at_limit(given, round(float(np.exp(random.uniform(np.log(0.15), 0))), 3))


def _drawn_grown(random, packing):
    sizes = [100, 200, 400, 800] if packing == "bpca" else [64, 128, 200, 350, 500]
    given = {"packing": packing.split()[-1], "grains": int(random.choice(sizes))}
    if packing == "planar bcca":
        given.update(planar=1, grains=min(given["grains"], 350))
    if random.random() < 0.5:
        given["impact"] = round(float(random.uniform(0, 0.7)), 2)
    if random.random() < 0.25:
        grains = given["grains"]
        given["projectileGrains"] = max(32, grains // int(random.integers(2, 5))) if packing == "bpca" else grains // 2
    return given


def _drawn_plane(random):
    return cpe(round(float(random.uniform(8, 20)), 1), round(float(random.uniform(0.4, 0.85)), 2), planar=1)


def compressions():
    """Compressions to a filling of 0.5; errors at lower fillings are taken on the way."""
    scenes = [
        {"grains": n, "strainRate": rate, "linearDamping": k, "stepFraction": s, "seed": seed}
        for n, rate, k, s, seed in product((64, 200), (1e-4, 3e-5, 1e-5), (0.0, 0.01, 0.1), (0.1, 0.3), (1, 2))
    ]
    scenes += [
        {"grains": 64, "strainRate": rate, "linearDamping": k, "stepFraction": 0.3, "seed": 3}
        for rate, k in ((3e-6, 0.01), (3e-6, 0.0), (1e-6, 0.01), (1e-6, 0.0), (3e-7, 0.01))
    ]
    larger = ((1000, 1e-4, 0.3, 5), (500, 1e-5, 0.3, 5), (200, 1e-6, 0.35, 5), (2000, 1e-4, 0.3, 6))
    scenes += [
        {"grains": n, "strainRate": rate, "linearDamping": k, "stepFraction": s, "seed": seed}
        for k, (n, rate, s, seed) in product((0.01, 0.0), larger)
    ]
    others = (
        ({"criticalRolling": 2e-10}, (0.01, 0.0)),
        ({"criticalRolling": 3.2e-9}, (0.01, 0.0)),
        ({"viscoelasticTime": 2e-12}, (0.01, 0.0)),
        ({"material": "silicate"}, (0.01,)),
        ({"limit": "cut"}, (0.01,)),
        (CUT, (0.01,)),
        ({"stretch": "x"}, (0.01,)),
        ({"stretch": "xyz", "finalFilling": 0.3}, (0.01,)),
    )
    scenes += [
        {"grains": 150, "strainRate": 3e-5, "stepFraction": 0.25, "linearDamping": k, "seed": 7, **other}
        for other, dampings in others
        for k in dampings
    ]
    return [{"set": "grid", **s} for s in scenes]


def random_compressions(number=28, seed=4):
    """Compressions of ice, springs held: sizes, rates, dampings, steps and critical rolling displacements drawn."""
    random = np.random.default_rng(seed)
    scenes = []
    for k in range(number):
        given = {"set": "random", "grains": int(10 ** random.uniform(1.85, 2.5))}
        given["strainRate"] = float(f"{10 ** random.uniform(-4.9, -3.7):.2g}")
        given["linearDamping"] = float(random.choice([0.0, 0.003, 0.01, 0.03, 0.1]))
        given.update(stepFraction=round(float(random.uniform(0.12, 0.35)), 2), seed=50 + k)
        if random.random() < 0.4:
            given["criticalRolling"] = float(random.choice([2e-10, 4e-10, 1.6e-9, 3.2e-9]))
        if given["linearDamping"] == 0 and random.random() < 0.3:
            given.update(viscoelasticTime=2e-12, stepFraction=min(given["stepFraction"], 0.25))
        scenes.append(given)
    return scenes
