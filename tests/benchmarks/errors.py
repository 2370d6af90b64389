"""Error and cost against the time step: A24's scene in small, and a bounce of two grains.

Collision: largest closure error of the energy ledger over K(0), and |d_max - d_max at the finest step| in grain radii, root mean square over the seeds.
Pair: relative error of the rebound speed, root mean square over initial gaps that spread the moment of contact over a step, against the closed form
v^2 - v_stick^2. Cost: steps a time unit, and seconds of the collisions' runs. A step that is refused or blows up is recorded as that, in its own words.
"""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from measured_on import HERE, TOP
from measured_scenes import GRAIN_RADIUS

from analysis.theory import ICE, pair_constants, sticking_velocity_without_drag

PAIR_SPEED = 9.0  # m/s


def estimate(settings):
    """Seconds that measure() takes about."""
    updates = sum(
        2.4 * settings.error_radius**3 * settings.error_duration / (1.94e-10 * step) for step in settings.error_steps
    )
    return len(settings.error_seeds) * (updates / 90e6 + 2 * len(settings.error_steps)) + pair_estimate(settings)


def pair_estimate(settings):
    return 2 + settings.gaps * sum(1e-3 / step for step in settings.error_steps)


def measure(settings, done):
    """{"collision": {step: [{closure, d_max, seconds} or {"refused": line} of each seed]}, "pair": {step: [relative errors] or the engine's refusal}}"""
    collisions = {}
    for step in settings.error_steps:
        collisions[step] = [collide(settings, step, seed) for seed in settings.error_seeds]
        done((estimate(settings) - pair_estimate(settings)) / len(settings.error_steps))
    pair = bounce(settings)
    done(pair_estimate(settings))
    return {"collision": collisions, "pair": pair}


def bounce(settings):
    """{step: [relative errors of the rebound speed] or the engine's refusal}"""
    with tempfile.TemporaryDirectory() as folder:
        answer = Path(folder) / "answer.json"
        asked = json.dumps(
            {"steps": settings.error_steps, "speed": PAIR_SPEED, "gaps": settings.gaps, "answer": str(answer)}
        )
        done = subprocess.run(
            ["yade", "-n", "-x", "-j1", str(HERE / "yade_pair.py"), asked], capture_output=True, text=True
        )
        if done.returncode:
            raise RuntimeError(f"yade_pair.py failed:\n{done.stderr[-2000:]}")
        speeds = json.loads(answer.read_text())
    exact = np.sqrt(PAIR_SPEED**2 - sticking_velocity_without_drag(pair_constants(ICE, GRAIN_RADIUS)) ** 2)
    return {
        float(step): found if isinstance(found, str) else (np.array(found) / exact - 1).tolist()
        for step, found in speeds.items()
    }


def collide(settings, step, seed):
    """One run of collide.py as a user does it, read by the analysis."""
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder) / "run"
        done = subprocess.run(
            [
                "yade",
                "-n",
                "-x",
                str(TOP / "yade_scripts/collide.py"),
                f"radius={settings.error_radius:g}",
                f"stepFraction={step}",
                f"seed={seed}",
                f"duration={settings.error_duration}",
                f"out={out}",
            ],
            capture_output=True,
            text=True,
        )
        if done.returncode:
            lines = [line for line in done.stderr.splitlines() if line.startswith("collide.py: ")]
            return {"refused": lines[-1] if lines else done.stderr.strip().splitlines()[-1]}
        summary = subprocess.run(
            [sys.executable, "-m", "analysis", "summary", "--json", str(out)],
            cwd=TOP,
            check=True,
            capture_output=True,
            text=True,
        ).stdout
        found, wall = json.loads(summary), json.loads((out / "run.json").read_text())["wallTime"]
        return {"closure": found["energy_closure"], "d_max": found["d_max"] / GRAIN_RADIUS, "seconds": wall}


def curves(settings, results):
    """{name: (steps (n,), error (n,), order, its standard error)} of the three errors; the steps that ran, ascending."""
    ran = sorted(step for step, runs in results["collision"].items() if not any("refused" in run for run in runs))
    finest = [run["d_max"] for run in results["collision"][ran[0]]]
    bounced = sorted(step for step, errors in results["pair"].items() if not isinstance(errors, str))
    found = {
        "ledger": (ran, [rms([run["closure"] for run in results["collision"][step]]) for step in ran]),
        "d_max": (
            ran[1:],
            [rms([run["d_max"] - d for run, d in zip(results["collision"][step], finest)]) for step in ran[1:]],
        ),
        "pair": (bounced, [rms(results["pair"][step]) for step in bounced]),
    }
    return {
        name: (np.array(steps), np.array(error), *order(settings, steps, error))
        for name, (steps, error) in found.items()
    }


def order(settings, steps, error):
    """(slope, standard error) of log error against log step between settings.fit; (nan, nan) where fewer than three steps lie there."""
    least, most = settings.fit
    within = [k for k, step in enumerate(steps) if least <= step <= most and error[k] > 0]
    x, y = np.log(np.array(steps)[within]), np.log(np.array(error)[within])
    if len(x) < 3:
        return np.nan, np.nan
    (slope, _), covariance = np.polyfit(x, y, 1, cov=True)
    return slope, np.sqrt(covariance[0, 0])


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))
