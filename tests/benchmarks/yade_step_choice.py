"""Ledger errors of many small collisions, for step_choice.py: yade -n -x yade_step_choice.py SCENES.json ANSWERS.jsonl

SCENES.json: a list of {parameter: value}, as for collide.py. Appends a line of JSON to ANSWERS.jsonl for each: the
scene's parameters, error (the largest |E(t) - E(0)|/K(0) of the samples that collide.py would take), errorAtHalf (the
same up to half of the time), births and breaks of contacts per grain, and seconds. The aggregates move for the time
until they meet and collide.py's duration.
"""

import json
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
from yade_scripts import packings, parameters, sampling, scene  # noqa: E402
from yade_scripts.materials import MATERIALS  # noqa: E402

GAP = 2.0  # grain radii between the aggregates' surfaces at the start (scene.placements)


def collide(given):
    """The answer's entries of one scene."""
    start = time.perf_counter()
    values = parameters.parse(given)
    material = MATERIALS[values["material"]]
    constants = scene.pair_constants(values, material)
    values = parameters.complete(values, constants, 1)
    centres, velocities = zip(*scene.placements(values, material.grainRadius))
    aggregates = [
        packings.moved(
            packings.cpe(
                values["filling"],
                values["radius"] * material.grainRadius,
                material.grainRadius,
                constants["equilibriumOverlap"],
                values["seed"],
                index,
            ),
            centre,
        )
        for index, centre in enumerate(centres)
    ]
    time_step = values["stepFraction"] * constants["timeUnit"]
    schedule = sampling.Schedule.of(GAP * material.grainRadius / values["velocity"] + values["duration"], time_step)
    O.reset()
    scene.build(aggregates, velocities, scene.material_of(values, material), time_step * schedule.interval)
    fused = JKRWadaEngine(subSteps=schedule.interval, threads=1)
    O.engines = [fused]
    fused.prepare()
    energy, kinetic = total(), O.energy["kinetic"]
    errors = []
    for _ in range(schedule.steps // schedule.interval):
        O.step()
        errors.append(abs(total() - energy) / kinetic)
    per_grain = 2 * values["grains"] * constants["pullOffForce"] * constants["pullOffOverlap"]
    booked = dict(O.energy.items())
    return {
        "error": max(errors),
        "errorAtHalf": max(errors[: len(errors) // 2]),
        "births": booked.get("connection", 0.0) / (8 / 15 * 2 ** (2 / 3) * per_grain),  # A22 eq 9
        "breaks": booked.get("disconnection", 0.0) / (4 / 45 * per_grain),  # A22 eq 10
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
    except (RuntimeError, parameters.ParameterError) as problem:
        answer = {"failed": " ".join(str(problem).split())}
    with open(sys.argv[2], "a") as file:
        file.write(json.dumps({**given, **answer}) + "\n")
