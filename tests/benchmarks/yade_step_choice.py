"""Ledger errors of many small runs, for step_choice.py: yade -n -x yade_step_choice.py SCENES.json ANSWERS.jsonl

SCENES.json: a list of {parameter: value}, as for collide.py, or with strainRate as for compress.py. Appends a line of
JSON to ANSWERS.jsonl for each: the scene's parameters, error and seconds. error of a collision: the largest
|E(t) - E(0)|/K(0) of the samples that collide.py would take; the aggregates move for collide.py's duration. Of a
compression: the largest |E(t) - E(0)| over the work of the boundaries up to the end; byFilling has the same as if the
run had ended at these fillings, with the work over the number of grains and F_c delta_c: {filling: [error, work]}.
"""

import json
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import numpy as np  # noqa: E402

import contact_law  # noqa: E402
from yade_scripts.experiments import collision, compression  # noqa: E402
from yade_scripts.packings import PackingError  # noqa: E402
from yade_scripts.parameters import ParameterError  # noqa: E402
from yade_scripts.run.schedule import Schedule  # noqa: E402

FILLINGS = (0.05, 0.1, 0.2, 0.3, 0.4, 0.5)


def run(given):
    """The answer's entries of one scene."""
    start = time.perf_counter()
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
    answer = measure(scene, schedule, constants["pullOffForce"] * constants["pullOffOverlap"])
    return {"step": parameters.stepFraction, **answer, "seconds": round(time.perf_counter() - start, 2)}


def collide(scene, schedule, contact):
    """Largest error of the ledger [K(0)], and K(0) over the grains and a contact's energy."""
    energy, kinetic, grains = total(), O.energy["kinetic"], len(O.bodies)
    error = 0.0
    for _ in range(schedule.samples):
        O.step()
        error = max(error, abs(total() - energy) / kinetic)
    return {"error": error, "kineticOfGrain": kinetic / (grains * contact)}


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
