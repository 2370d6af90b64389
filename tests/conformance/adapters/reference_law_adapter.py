"""tests/reference_law.py:  /usr/bin/python3 adapters/reference_law_adapter.py RESULTS.json [CASE ...]"""

import importlib.util
import sys
from pathlib import Path

import numpy as np
from answers import NotModelled, main

PATH = Path(__file__).resolve().parents[2] / "reference_law.py"
specification = importlib.util.spec_from_file_location("the_reference_law", PATH)
law = importlib.util.module_from_spec(specification)
specification.loader.exec_module(law)

NAMES = dict(young="young", poisson="poisson", density="density", surfaceEnergy="surface_energy")
NAMES.update(criticalRolling="critical_rolling", viscoelasticTime="viscoelastic_time")


def material(given):
    return {ours: given[theirs] for ours, theirs in NAMES.items()}


def series_of(scene, materials, steps):
    if "plane" in scene:
        raise NotModelled("no planes")
    grains, dt = scene["grains"], scene["duration"] / steps
    x, v, w = (np.array([g[name] for g in grains]) for name in ("position", "velocity", "spin"))
    kinds, segments = [material(materials[g["material"]]) for g in grains], scene.get("prescribed")
    if segments:  # so heavy that contacts do not move them
        v, w = np.array(segments[0]["velocity"]), np.array(segments[0]["spin"])
    own = law.Scene(kinds, [g["radius"] for g in grains], x, v, w, dt, scene.get("linear_damping", 0.0), scene.get("neck", 0.0))  # fmt: skip
    rows = {name: [] for name in ("position", "velocity", "spin", "force", "torque")}
    energies = []
    for k in range(steps + 1):
        if k:
            if segments:
                drive(own, segments, k, dt)
            own.step()
        before = own.v, own.w
        F, T = own.F, own.T
        half = (dt / 2 * F / own.mass, dt / 2 * T / own.inertia) if not segments else (0, 0)
        for name, row in zip(rows, (own.x, before[0] + half[0], before[1] + half[1], F[0], T)):
            rows[name].append(np.array(row))
        energies.append(own.energies)
    channels = {name: np.array([e[key] for e in energies]) for name, key in (("connection", "connection"), ("disconnection", "disconnection"), ("bond breaking", "bondBreaking"))}  # fmt: skip
    channels["total"] = np.array([sum(e.values()) for e in energies])
    series = {name: np.array(row) for name, row in rows.items()}
    return {**series, "time": dt * np.arange(steps + 1), "mass": own.mass[:, 0], "channels": channels}


def drive(own, segments, k, dt):
    """Velocities and spins of the step to come."""
    segment = next(s for s in segments if s["until"] > (k - 0.5) * dt)
    own.v = np.array(segment["velocity"]) - dt * own.F / own.mass  # which step() gives back
    own.w = np.array(segment["spin"]) - dt * own.T / own.inertia


if __name__ == "__main__":
    main("reference law", "of this repository", series_of, sys.argv[1], sys.argv[2:])
