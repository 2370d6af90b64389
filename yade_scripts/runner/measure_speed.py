"""How fast this machine steps a run: prints one line of JSON; for study.py, which estimates with it.

    yade -n -x yade_scripts/runner/measure_speed.py SCRIPT radius=40 filling=0.3    a run of a script's kind

contactUpdatesPerSecond of the fused engine in the first steps of the run, and setup: seconds of building it. Seconds are
of processor time, so that what else the machine happens to do in this moment counts little; the estimate is for cores
that have nothing else to do.
"""

import json
import os
import sys
import time

top = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))
sys.path.insert(0, top)
from yade_scripts.parameters.errors import one_line_errors
from yade_scripts.run.arguments import from_arguments
from yade_scripts.run.kind import kind_of

SECONDS = 1.0
STEPS = 20

start = time.process_time()
with one_line_errors("measure_speed.py"):
    kind = kind_of(sys.argv[1])
    parameters = kind.parse(from_arguments(sys.argv[2:]))
    import contact_law  # noqa: F401  (the plugin, before anything asks it)

    scene = kind.prepare(parameters, O.numThreads)

scene.build()
threads = min(scene.parameters.threads, 2)
fused = JKRWadaEngine(subSteps=STEPS, threads=threads, **scene.law)
O.dt = STEPS * scene.time_step
O.engines = [fused]
fused.prepare()
ready = time.process_time()
while time.process_time() < ready + SECONDS * threads:
    O.step()
seconds = (time.process_time() - ready) / threads
print(json.dumps({"contactUpdatesPerSecond": fused.statistics()["contactUpdates"] / seconds, "setup": ready - start}))
sys.exit(0)
