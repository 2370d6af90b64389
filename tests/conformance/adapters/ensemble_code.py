"""Without YADE: the ensemble's code (yade_scripts/run/ensemble.py), which has free grains alone.

/usr/bin/python3 adapters/ensemble_code.py RESULTS.json [CASE ...]"""

import sys
from pathlib import Path

import numpy as np
from answers import NotModelled, main

sys.path.insert(0, str(Path(__file__).resolve().parents[3]))
from yade_scripts.run.ensemble import MECHANISMS, Collision, Grains, Library

PROPERTIES = "young", "poisson", "density", "surface_energy", "critical_rolling", "viscoelastic_time"
CHANNELS = {"connection": "connection", "disconnection": "disconnection", "bond breaking": "bondBreaking"}


def series_of(scene, materials, steps):
    for there, why in (("prescribed", "grains that are moved"), ("plane", "planes")):
        if there in scene:
            raise NotModelled(f"no {why}")
    names, bodies, library = list(materials), scene["grains"], Library()
    of = lambda name: np.array([grain[name] for grain in bodies])
    kinds = [names.index(grain["material"]) for grain in bodies]
    constants = np.array([[materials[name][key] for key in PROPERTIES] for name in names])
    grains = Grains(of("position"), of("velocity"), of("radius"), constants, kinds, spin=of("spin"))
    drag = constants[kinds, -1].any() or "linear_damping" in scene
    mechanisms = sum(MECHANISMS.values()) - (0 if drag else MECHANISMS["drag"])
    options = dict(mechanisms=mechanisms, neck=scene.get("neck", 0.0), linear_damping=scene.get("linear_damping", 0.0))
    one = Collision(library, grains, steps, scene["duration"] / steps, 1, **options).read()
    rows, start = [], np.array([grains.position, grains.velocity, grains.spin])
    for step in range(steps + 1):
        motion, (pairs, push, _) = one.motion() if step else start, one.contacts()
        first = pairs[:, 0] == 0
        apart = motion[0][0] - motion[0][pairs[first, 1]]
        force = (push[first, None] * apart / np.linalg.norm(apart, axis=1)[:, None]).sum(axis=0)  # without sliding
        rows.append((*motion, force))
        if step < steps:
            library.run([one], 1)
            one.read()
    position, velocity, spin, force = (np.array(column) for column in zip(*rows))
    samples, mass = one.samples(), 4 / 3 * np.pi * of("radius") ** 3 * constants[kinds, 2]
    channels = {name: samples[key] for name, key in CHANNELS.items()}
    channels["total"] = sum(samples[name] for name in library.channels)
    found = dict(time=samples["time"], position=position, velocity=velocity, spin=spin, force=force, mass=mass)
    return {**found, "torque": np.full_like(position, np.nan), "channels": channels}


if __name__ == "__main__":
    path, *chosen = sys.argv[1:]
    main("ensemble", "", series_of, path, chosen)
