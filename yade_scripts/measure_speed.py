"""How fast this machine moves a collision: prints one line of JSON; for study.py, which estimates with it.

    yade -n -x yade_scripts/measure_speed.py radius=40 filling=0.3    a scene, as for collide.py

contactUpdatesPerSecond of the fused engine in the first steps of the collision, setup: seconds of building it,
and timeUnit [s], t0 of each material. Seconds are of processor time, so that what else the machine happens to do
in this moment counts little; the estimate is for cores that have nothing else to do.
"""

import json
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))  # the repository's top
from yade_scripts import aggregates, arguments, packings, parameters
from yade_scripts.errors import one_line_errors
from yade_scripts.materials import MATERIALS

SECONDS = 1.0
STEPS = 20

start = time.process_time()
with one_line_errors("measure_speed.py"):
    values = parameters.parse(*arguments.gather(sys.argv[1:]))
    from yade_scripts import scene  # needs the plugin

    material = MATERIALS[values["material"]]
    constants = scene.pair_constants(values, material)
    values = parameters.complete(values, constants, O.numThreads)
    centres, velocities = zip(*scene.placements(values, material.grainRadius))
    pair = [
        packings.moved(aggregates.make(values, material.grainRadius, constants["equilibriumOverlap"], index), centre)
        for index, centre in enumerate(centres)
    ]

scene.build(
    pair,
    velocities,
    scene.material_of(values, material),
    STEPS * values["stepFraction"] * constants["timeUnit"],
    values["planar"],
)
fused = JKRWadaEngine(subSteps=STEPS, threads=values["threads"], neck=values["neck"])
O.engines = [fused]
fused.prepare()
ready = time.process_time()
while time.process_time() < ready + SECONDS * values["threads"]:
    O.step()
seconds = (time.process_time() - ready) / values["threads"]
print(
    json.dumps(
        {
            "contactUpdatesPerSecond": fused.statistics()["contactUpdates"] / seconds,
            "setup": ready - start,
            "timeUnit": {name: scene.pair_constants(values, row)["timeUnit"] for name, row in MATERIALS.items()},
        }
    )
)
sys.exit(0)
