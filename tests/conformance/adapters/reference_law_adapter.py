"""tests/reference_law.py:  /usr/bin/python3 adapters/reference_law_adapter.py RESULTS.json [CASE ...]"""

import sys
from pathlib import Path

import numpy as np
from answers import NotModelled, main

sys.path.append(str(Path(__file__).resolve().parents[2]))
import reference_law

CHANNELS = {"connection": "connection", "disconnection": "disconnection", "bond breaking": "bondBreaking"}


def material(given):
    """With the attributes of JKRMat."""
    others = {"surfaceEnergy": "surface_energy", "criticalRolling": "critical_rolling"}
    others |= {"viscoelasticTime": "viscoelastic_time", **{name: name for name in ("young", "poisson", "density")}}
    return {our: given[name] for our, name in others.items()}


def series_of(scene, materials, steps):
    if "plane" in scene:
        raise NotModelled("no planes")
    grains, dt, segments = scene["grains"], scene["duration"] / steps, scene.get("prescribed")
    x, v, w = (np.array([g[name] for g in grains]) for name in ("position", "velocity", "spin"))
    if segments:
        v, w = np.array(segments[0]["velocity"]), np.array(segments[0]["spin"])
    kinds, radii = [material(materials[g["material"]]) for g in grains], [g["radius"] for g in grains]
    law = reference_law.Scene(kinds, radii, x, v, w, dt, scene.get("linear_damping", 0.0), scene.get("neck", 0.0))
    rows = []
    for k in range(steps + 1):
        if k and segments:  # what step() adds is taken away before
            segment = next(s for s in segments if s["until"] > (k - 0.5) * dt)
            law.v = np.array(segment["velocity"]) - dt * law.F / law.mass
            law.w = np.array(segment["spin"]) - dt * law.T / law.inertia
        if k:
            law.step()
        v, w = law.v + dt / 2 * law.F / law.mass, law.w + dt / 2 * law.T / law.inertia
        rows.append((law.x, v, w, law.F[0], law.T, law.energies))
    *arrays, energies = zip(*rows)
    series = dict(zip(("position", "velocity", "spin", "force", "torque"), map(np.array, arrays)))
    channels = {name: np.array([e[key] for e in energies]) for name, key in CHANNELS.items()}
    channels["total"] = np.array([sum(e.values()) for e in energies])
    return {**series, "time": dt * np.arange(steps + 1), "mass": law.mass[:, 0], "channels": channels}


if __name__ == "__main__":
    main("reference law", "of this repository", series_of, sys.argv[1], sys.argv[2:])
