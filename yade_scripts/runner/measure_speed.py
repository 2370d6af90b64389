"""How fast this machine steps a run: prints one line of JSON; for study.py, which estimates with it.

    yade -n -x yade_scripts/runner/measure_speed.py SCRIPT radius=40 filling=0.3    a run of a script's kind

setup: seconds of building the run; step: seconds of a small step of the fused engine, among its first `steps`. Both of the
clock, as the runs will take them: on a machine that is busy with other work, more than of processor time.
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

SECONDS = 1.0  # of processor time: so that what else runs has its turns, too
STEPS = 20

with one_line_errors("measure_speed.py"):
    kind = kind_of(sys.argv[1])
    parameters = kind.parse(from_arguments(sys.argv[2:]))
    import contact_law  # noqa: F401  (the plugin, before anything asks it)

    start = time.monotonic()
    scene = kind.prepare(parameters, O.numThreads)

scene.build()
threads = scene.parameters.threads
fused = JKRWadaEngine(subSteps=STEPS, threads=threads, **scene.law)
O.dt = STEPS * scene.time_step
O.engines = [fused]
fused.prepare()
ready = time.monotonic()
end = time.process_time() + SECONDS * threads
while time.process_time() < end:
    O.step()
steps = STEPS * O.iter
print(json.dumps({"setup": ready - start, "step": (time.monotonic() - ready) / steps, "steps": steps}))
sys.exit(0)
