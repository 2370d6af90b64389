"""Two ice grains bounce, at several steps and gaps; runs inside YADE for errors.py: yade -n -x yade_pair.py '{"steps", "speed", "gaps", "answer"}'

Writes {step: [speed of separation [m/s] of each gap], or the engine's refusal} to the file `answer`. steps in t0, speed in m/s; the gaps spread the moment of contact over a step.
"""

import json
import os
import sys

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [os.path.dirname(os.path.dirname(HERE)), os.path.dirname(HERE), HERE]
import contact_law  # noqa: E402,F401  (makes the classes known that scenes imports)

# isort: split
import numpy as np  # noqa: E402
from measured_scenes import GRAIN_RADIUS  # noqa: E402
from scenes import constants, fused_engine, grain, ice, new_scene  # noqa: E402
from yade.wrapper import *  # noqa: E402,F403

asked = json.loads(sys.argv[1])


def pause_when_apart(after):
    if O.time > after and not O.energy["disconnection"] == 0:
        O.pause()


def start(step, gap):
    new_scene(step * constants(ice(), GRAIN_RADIUS)["timeUnit"])
    grain((0, 0, 0), GRAIN_RADIUS, ice())
    grain((2 * GRAIN_RADIUS + gap, 0, 0), GRAIN_RADIUS, ice(), (-asked["speed"], 0, 0))
    fused_engine()


def bounce(step, gap):
    start(step, gap)
    O.engines += [PyRunner(command=f"pause_when_apart({2 * gap / asked['speed']!r})", iterPeriod=max(1, int(1 / step)))]
    O.run(int(100 / step), True)
    return O.bodies[1].state.vel[0] - O.bodies[0].state.vel[0]


def refusal(step):
    """What the engine says to this step, None if it takes it."""
    start(step, 2e-9)
    try:
        O.engines[0].prepare()
    except RuntimeError as error:
        return str(error)


gaps = 2e-9 + 1e-10 * np.arange(asked["gaps"]) / 1.7
result = {step: refusal(step) or [bounce(step, gap) for gap in gaps] for step in asked["steps"]}
with open(asked["answer"], "w") as file:
    json.dump(result, file)
