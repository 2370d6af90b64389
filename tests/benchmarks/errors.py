"""Error and cost against the time step, of collisions, and of scenes that all codes run: error.csv, a row a run.

ledger: largest error of the sum of all channels, over K(0). d_max: in grain radii, compared with that of the finest step and
the same seed (sample). kinetic: of an aggregate that rings and of pairs that meet, by any code: root mean square
difference of K(t) from that of the code's own finest step, over K(0); ledger as far as the code has one. seconds: of the run,
one thread; of ringing and meeting the processor's, by the share of the finest run. A step that is refused or blows up is
recorded as that, in its own words.
"""

import json
import sys
import tempfile
from pathlib import Path

import codes
import numpy as np
import scene_file
import starts
from measured_on import HERE, TOP
from measured_scenes import CPE, EVERY, Scene

sys.path.insert(0, str(HERE.parent))
from yade_server import YadeServer

from analysis import open_run
from analysis.measures import ledger
from analysis.measures.compression import maximum_compression
from analysis.theory import ICE, pair_constants
from yade_scripts.experiments.collision import CollisionParameters

PAIR_SPEED, GRAIN_RADIUS = 9.0, 1e-7  # m/s, m
FOLLOWED, INTERVAL = ("ringing", "meeting"), 0.5e-9  # by all codes; s, from a moment to the next
RINGING_RATE = 2e5  # 1/s: 0.4 m/s at the surface; no contact is made, broken or slips
FIRST_GAP, PAIRS = 2e-9, 100
FILLINGS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5)
MEETING = f"{PAIRS} pairs that meet and part"
TITLES = {"collision": "collision", "ringing": "an aggregate that rings", "meeting": MEETING}
FITTED = (0.02, 0.2)  # t0, between which the order of convergence is fitted


def measure(name, settings):
    """Rows of error.csv of one of TITLES."""
    found = followed(name, settings) if name in FOLLOWED else runs(settings)
    return [{"scene": name, "code": "engine", **row} for row in found]


def runs(settings):
    """A row for each step and seed of a collision."""
    given, seeds = {"radius": settings.error_radius, "duration": settings.error_duration}, range(1, settings.seeds + 1)
    asked = [{**given, "stepFraction": step, "seed": seed} for step in settings.error_steps for seed in seeds]
    for one, found in zip(asked, of_scripts(asked), strict=True):
        found["refused"] = found.pop("failed", None)
        yield {"step": one["stepFraction"], "sample": one["seed"], **found}


def of_scripts(asked):
    """What runs of collide.py, or with strainRate of compress.py, gave: a list of dictionaries for one of parameters.

    ledger, seconds; d_max; byFilling of a compression: {filling: [ledger, work [J]] as if the run had ended there}. Of a run
    that did not come to its end only {"failed": its last words}.
    """
    yade = YadeServer()
    with tempfile.TemporaryDirectory() as folder:
        for k, given in enumerate(asked):
            script = TOP / "yade_scripts" / ("compress.py" if "strainRate" in given else "collide.py")
            place = Path(folder) / str(k)
            place.mkdir()
            given = {"threads": 1, **given, "out": "run"}
            yade.run(script, place, arguments=[f"{name}={value}" for name, value in given.items()])
        return [_of_run(Path(folder) / str(k)) for k in range(len(asked))]


def _of_run(place):
    path = place / "run"
    if not (path / "ended").exists():
        printed = (place / "stdout").read_text() + (place / "stderr").read_text()
        return {"failed": printed.strip().splitlines()[-1]}
    history, seconds = open_run(path).history, json.loads((path / "run.json").read_text())["wallTime"]
    if "filling" not in history:
        largest = maximum_compression(history["time"], history["d"], history["v"])
        d_max = largest.length / GRAIN_RADIUS if largest else None
        return {"ledger": ledger.closure(history), "d_max": d_max, "seconds": seconds}
    total, work, by_filling = ledger.total_energy(history), -ledger.work_on_boundaries(history), {}
    error = np.maximum.accumulate(np.abs(total - total[0]))
    for filling in FILLINGS:
        if history["filling"][0] < filling <= history["filling"].max():
            end = np.argmax(history["filling"] >= filling)
            by_filling[filling] = [error[end] / work[end], work[end]]
    return {"ledger": error[-1] / work[-1], "byFilling": by_filling, "seconds": seconds}


def followed(name, settings):
    """A row for each code that is here and step, the finest first."""
    given, time_unit = CollisionParameters.parse({}), pair_constants(ICE, GRAIN_RADIUS).time_unit
    radius, moments, small_steps = settings.rung
    if name == "ringing":
        made = starts.rung(starts.of(Scene("", "collision", {**CPE, "radius": radius})), RINGING_RATE)
    else:
        made = starts.pairs(FIRST_GAP + 6e-11 * np.arange(PAIRS), PAIR_SPEED, given, INTERVAL)
        small_steps = settings.met
    for code in (code for code in EVERY if not codes.missing(code, made)):
        finest = None
        for each in small_steps:
            made.head["step"] = INTERVAL / each
            found = _follow(code, made, moments, each, settings)
            kinetic, energy = np.array(found["kinetic"]), found.get("energy")
            finest = finest or (kinetic, found["seconds"] / each)
            row = {"code": code, "step": round(INTERVAL / each / time_unit, 4), "sample": 0}
            row |= {"kinetic": np.sqrt(np.mean((kinetic - finest[0]) ** 2)) / kinetic[0], "seconds": finest[1] * each}
            yield {**row, "ledger": np.ptp(energy[1:]) / kinetic[0] if energy else None}


def _follow(code, scene, samples, each, settings):
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "rung.scene"
        scene_file.save(path, scene)
        opened = codes.open_code(code, path, each, settings)
        try:
            return opened.follow(samples, each)
        finally:
            opened.close()


def curve(rows, quantity):
    """(steps (n,), root mean square error (n,)) of a scene's rows; see the module's head."""
    values = rows.pivot(index="step", columns="sample", values=quantity).dropna()
    if quantity == "d_max":
        values = (values - values.iloc[0]).iloc[1:]
    return values.index.to_numpy(float), np.sqrt(np.mean(values.to_numpy(float) ** 2, axis=1))


def order(steps, error, fitted=FITTED):
    """(slope, standard error) of log error against log step between two steps; (nan, nan) where fewer than three lie
    there."""
    within = (steps >= fitted[0]) & (steps <= fitted[1]) & (error > 0)
    if np.count_nonzero(within) < 3:
        return np.nan, np.nan
    (slope, _), covariance = np.polyfit(np.log(steps[within]), np.log(error[within]), 1, cov=True)
    return slope, np.sqrt(covariance[0, 0])
