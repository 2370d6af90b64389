"""Error and cost against the time step, of collisions, compressions and a bounce of two grains: error.csv, a row a run.

ledger: largest error of the sum of all channels, over K(0) (collision) or over the boundaries' work until then (compression; ledgerThin: up to a filling of 0.1).
d_max: of a collision, in grain radii; workThin, work: of a compression's boundaries from a filling of 0.05 to 0.1, and from there to 0.5, over N F_c delta_c: the
pressures. All of these are of one seed (sample) and compared with those of the finest step of the same seed. rebound: relative error of the rebound speed of two
grains against the closed form v^2 - v_stick^2, for initial gaps (samples) that spread the moment of contact over a step. seconds: of the run, one thread.
A step that is refused or blows up is recorded as that, in its own words.
"""

import json
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path

import codes
import numpy as np
import scene_file
import starts
from measured_on import HERE

from analysis.theory import ICE, pair_constants, sticking_velocity_without_drag
from yade_scripts.experiments.collision import CollisionParameters

PAIR_SPEED, GRAIN_RADIUS = 9.0, 1e-7  # m/s, m
BOUNCE = 100  # t0, after which two grains are apart
COMPRESSION_STEPS = (0.05, 0.1, 0.2, 0.3, 0.36)
THIN = (0.05, 0.1)  # fillings
FITTED = (0.02, 0.2)  # t0, between which the order of convergence is fitted


@dataclass(frozen=True)
class ErrorScene:
    """title; parameters as collide.py or compress.py has them (None: two grains); steps [t0]; samples: seeds, or numbers of gaps."""

    title: str
    parameters: dict
    steps: tuple
    samples: tuple


def scenes(settings):
    """{name: ErrorScene}"""
    collision = {"radius": settings.error_radius, "duration": settings.error_duration}
    compression = {"grains": settings.compression_grains, "strainRate": settings.compression_rate, "finalFilling": 0.5}
    seeds = settings.compression_seeds
    return {
        "collision": ErrorScene("collision", collision, settings.error_steps, settings.error_seeds),
        "pair": ErrorScene("pair", None, settings.error_steps, tuple(range(settings.gaps))),
        "compression": ErrorScene(
            "compression, k_n 0.01", {**compression, "linearDamping": 0.01}, COMPRESSION_STEPS, seeds
        ),
        "compression-undamped": ErrorScene(
            "compression, k_n 0", {**compression, "linearDamping": 0.0}, COMPRESSION_STEPS, seeds
        ),
    }


def measure(name, settings):
    """Rows of error.csv of an ErrorScene."""
    scene = scenes(settings)[name]
    found = bounces(scene) if scene.parameters is None else runs(scene)
    return [{"scene": name, "code": "engine", **row} for row in found]


def runs(scene):
    """A row for each step and seed."""
    asked = [{**scene.parameters, "stepFraction": step, "seed": seed} for step in scene.steps for seed in scene.samples]
    return [
        {
            "step": one["stepFraction"],
            "sample": one["seed"],
            **(_of_compression(answer) if "byFilling" in answer else _of_collision(answer)),
        }
        for one, answer in zip(asked, in_yade(asked), strict=True)
    ]


def _of_collision(answer):
    if "failed" in answer:
        return {"refused": answer["failed"]}
    return {"ledger": answer["error"], "d_max": answer["d_max"] / GRAIN_RADIUS, "seconds": answer["seconds"]}


def _of_compression(answer):
    error, work = answer["error"], {float(filling): found for filling, found in answer["byFilling"].items()}
    first, thin, last = (work[filling] for filling in (*THIN, max(work)))
    return {
        "ledger": error,
        "ledgerThin": thin[0],
        "workThin": thin[1] - first[1],
        "work": last[1] - thin[1],
        "seconds": answer["seconds"],
    }


def in_yade(asked):
    """The answers of yade_errors.py to a list of parameters."""
    with tempfile.TemporaryDirectory() as folder:
        given, answers = Path(folder) / "scenes.json", Path(folder) / "answers.jsonl"
        given.write_text(json.dumps(asked))
        command = ["yade", "-n", "-x", "-j1", str(HERE / "yade_errors.py"), str(given), str(answers)]
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            raise codes.CodeFailed(f"yade_errors.py failed:\n{done.stderr[-2000:]}")
        return [json.loads(line) for line in answers.read_text().splitlines()]


def bounces(scene):
    """A row for each step and gap; all pairs of a step in one run."""
    constants = pair_constants(ICE, GRAIN_RADIUS)
    exact = np.sqrt(PAIR_SPEED**2 - sticking_velocity_without_drag(constants) ** 2)
    gaps = 2e-9 + 1e-10 * np.array(scene.samples) / 1.7
    for step in scene.steps:
        made = starts.pairs(gaps, PAIR_SPEED, CollisionParameters.parse({}), step * constants.time_unit)
        try:
            rebound, refused = _rebound(made, int(BOUNCE / step)) / exact - 1, None
        except codes.CodeFailed as error:
            rebound, refused = np.full(len(gaps), np.nan), str(error)
        for sample, one in zip(scene.samples, rebound):
            yield {"step": step, "sample": sample, "rebound": one, "refused": refused}


def _rebound(scene, steps):
    """Speed of separation (n,) [m/s] of each of the pairs of a SceneFile after so many steps, by the engine without YADE. Raises codes.CodeFailed."""
    with tempfile.TemporaryDirectory() as folder:
        begin, end = Path(folder) / "begin.scene", Path(folder) / "end.scene"
        scene_file.save(begin, scene)
        codes.harness(begin, steps=steps, out=end)
        after = scene_file.load(end)
    if len(after.contacts):
        raise codes.CodeFailed(f"{len(after.contacts)} pairs still touch after {BOUNCE} t0")
    return np.diff(after.grains["velocity"][:, 0].reshape(-1, 2), axis=1)[:, 0]


# ---- curves ----


def curve(rows, quantity):
    """(steps (n,), root mean square error (n,)) of a scene's rows; d_max and work against the finest step of the same sample, work as a logarithm."""
    values = rows.pivot(index="step", columns="sample", values=quantity).dropna()
    if quantity.startswith("work"):
        values = np.log(values)
    if quantity == "d_max" or quantity.startswith("work"):
        values = (values - values.iloc[0]).iloc[1:]
    return values.index.to_numpy(float), np.sqrt(np.mean(values.to_numpy(float) ** 2, axis=1))


def order(steps, error, fitted=FITTED):
    """(slope, standard error) of log error against log step between two steps; (nan, nan) where fewer than three lie there."""
    within = (steps >= fitted[0]) & (steps <= fitted[1]) & (error > 0)
    if np.count_nonzero(within) < 3:
        return np.nan, np.nan
    (slope, _), covariance = np.polyfit(np.log(steps[within]), np.log(error[within]), 1, cov=True)
    return slope, np.sqrt(covariance[0, 0])
