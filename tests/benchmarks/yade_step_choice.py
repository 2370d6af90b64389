"""Ledger errors of many small collisions, for step_choice.py: yade -n -x yade_step_choice.py SCENES.json ANSWERS.jsonl

SCENES.json: a list of {parameter: value}, as for collide.py. Appends a line of JSON to ANSWERS.jsonl for each: the
scene's parameters, error (the largest |E(t) - E(0)|/K(0) of the samples that collide.py would take), errorAtHalf (the
same up to half of the time), formed and broken: contacts per grain, and seconds. The aggregates move for
collide.py's duration.
"""

import json
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import contact_law  # noqa: E402, F401
from yade_scripts.experiments.collision import KIND  # noqa: E402
from yade_scripts.packings import PackingError  # noqa: E402
from yade_scripts.parameters import ParameterError  # noqa: E402
from yade_scripts.run.schedule import Schedule  # noqa: E402


def collide(given):
    """The answer's entries of one scene."""
    start = time.perf_counter()
    scene = KIND.prepare(KIND.parse(given), 1)
    parameters, constants = scene.parameters, scene.constants
    schedule = Schedule.of(parameters.duration, scene.time_step)
    O.reset()
    scene.build()
    O.trackEnergy = True
    O.dt = scene.time_step * schedule.interval
    fused = JKRWadaEngine(subSteps=schedule.interval, threads=1)
    O.engines = [fused]
    fused.prepare()
    energy, kinetic = total(), O.energy["kinetic"]
    errors = []
    for _ in range(schedule.steps // schedule.interval):
        O.step()
        errors.append(abs(total() - energy) / kinetic)
    per_grain = 2 * parameters.grains * constants["pullOffForce"] * constants["pullOffOverlap"]
    booked = dict(O.energy.items())
    return {
        "error": max(errors),
        "errorAtHalf": max(errors[: len(errors) // 2]),
        "formed": booked.get("connection", 0.0) / (8 / 15 * 2 ** (2 / 3) * per_grain),  # A22 eq 9
        "broken": booked.get("disconnection", 0.0) / (4 / 45 * per_grain),  # A22 eq 10
        "kineticOverPullOff": kinetic / per_grain,
        "seconds": round(time.perf_counter() - start, 2),
    }


def total():
    return sum(energy for _, energy in O.energy.items())


with open(sys.argv[1]) as file:
    scenes = json.load(file)
for given in scenes:
    try:
        answer = collide(given)
    except (RuntimeError, ParameterError, PackingError) as problem:
        answer = {"failed": " ".join(str(problem).split())}
    with open(sys.argv[2], "a") as file:
        file.write(json.dumps({**given, **answer}) + "\n")
