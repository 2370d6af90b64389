"""Ledger errors of many small runs: yade -n -x yade_errors.py SCENES.json ANSWERS.jsonl

SCENES.json: a list of {parameter: value}, as for collide.py, or with strainRate as for compress.py. Appends a line of JSON to ANSWERS.jsonl for each: the
scene's parameters, error and seconds (of the run, once it is prepared). error of a collision: the largest |E(t) - E(0)|/K(0) of the samples that collide.py
would take; the aggregates move for collide.py's duration; d_max [m]. Of a compression: the largest |E(t) - E(0)| over the work of the boundaries up to the end;
byFilling has the same as if the run had ended at these fillings, with the work over the number of grains and F_c delta_c: {filling: [error, work]}.
"""

import json
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import numpy as np

import contact_law
from analysis.measures.compression import maximum_compression
from yade_scripts.experiments import collision, compression
from yade_scripts.packings import PackingError
from yade_scripts.parameters import ParameterError
from yade_scripts.run.schedule import Schedule

FILLINGS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5)


def run(given):
    """The answer's entries of one scene."""
    kind, measure = (compression, compress) if "strainRate" in given else (collision, collide)
    scene = kind.KIND.prepare(kind.KIND.parse(given), 1)
    parameters, constants = scene.parameters, scene.constants
    schedule = Schedule.of(parameters.duration, scene.time_step, scene.interval)
    O.reset()
    scene.build()
    O.trackEnergy = True
    O.dt = scene.time_step * schedule.interval
    fused = JKRWadaEngine(subSteps=schedule.interval, threads=1, limit=parameters.limit, **scene.law)
    O.engines = [fused]
    fused.prepare()
    start = time.perf_counter()
    answer = measure(scene, schedule, constants["pullOffForce"] * constants["pullOffOverlap"])
    return {"step": parameters.stepFraction, **answer, "seconds": round(time.perf_counter() - start, 4)}


def collide(scene, schedule, contact):
    """Largest error of the ledger [K(0)], K(0) over the grains and a contact's energy, and d_max [m], None where no grains are beside a plane."""
    energy, kinetic, grains = total(), O.energy["kinetic"], len(O.bodies)
    error, history = 0.0, History()
    for _ in range(schedule.samples):
        O.step()
        error = max(error, abs(total() - energy) / kinetic)
        state = {**contact_law.snapshot(), "aggregate": scene.aggregate}
        history.take(state["time"], scene.series(state))
    largest = maximum_compression(*(history.recent(name, np.inf) for name in ("time", "d", "v")))
    return {"error": error, "kineticOfGrain": kinetic / (grains * contact), "d_max": largest and largest.length}


def compress(scene, schedule, contact):
    """Largest error of the ledger over the work done, at the end and at FILLINGS."""
    energy, error, found, waiting = total(), 0.0, {}, list(FILLINGS)
    history = History()
    for _ in range(schedule.samples):
        O.step()
        state = contact_law.snapshot()
        history.take(state["time"], scene.series(state))
        error, work = max(error, abs(total() - energy)), -O.energy["boundaryWork"]
        while waiting and history.rows[-1]["filling"] >= waiting[0]:
            found[waiting.pop(0)] = [error / work, work / (len(O.bodies) * contact)]
        if scene.control(history, state):
            break
    return {"error": error / work, "byFilling": found}


class History:
    """What Scene.control asks of a recorder."""

    def __init__(self):
        self.rows = []

    def take(self, time, series):
        self.rows.append({"time": time, **series})

    def recent(self, name, duration=0.0):
        since = self.rows[-1]["time"] - duration
        return np.array([row[name] for row in self.rows if row["time"] >= since])


def total():
    return sum(energy for _, energy in O.energy.items())


with open(sys.argv[1]) as file:
    scenes = json.load(file)
for given in scenes:
    try:
        answer = run(given)
    except (RuntimeError, ParameterError, PackingError) as problem:
        answer = {"failed": " ".join(str(problem).split())}
    with open(sys.argv[2], "a") as file:
        file.write(json.dumps({**given, **answer}) + "\n")
