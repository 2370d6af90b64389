"""Collide two dust aggregates of equal size and write a run folder.

    yade -n -x yade_scripts/collide.py                     A24's scene at 20 grain radii
    yade -n -x yade_scripts/collide.py velocity=10 seed=3  any parameter by its name
    yade -n -x yade_scripts/collide.py table=yade_scripts/studies/seeds.table:4   one row of a table
    python3 yade_scripts/run_table.py yade_scripts/studies/seeds.table            all rows (with yade-batch)
    yade -n -x yade_scripts/collide.py --help              the parameters

Exit status: 0 when the run came to its planned end, 2 for a wrong parameter (one line on stderr, and nothing
was run), 1 when the run failed, 130 or 143 when Ctrl-C or SIGTERM stopped it. The last two leave a run folder
that can be read, with a checkpoint; a killed run leaves its last one. resume=1 goes on from there.
"""

import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))  # the repository's top
from yade_scripts import aggregates, arguments, packings, parameters, sampling
from yade_scripts.errors import one_line_errors
from yade_scripts.materials import MATERIALS

start = time.monotonic()
if "--help" in sys.argv[1:]:
    print(__doc__ + "\n" + parameters.help_text())
    sys.exit(0)

with one_line_errors("collide.py"):
    values = parameters.parse(*arguments.gather(sys.argv[1:]))
    from yade_scripts import checkpoint, recorder, report, run_folder, run_loop, scene  # these need the plugin

    # What is made of what
    material = MATERIALS[values["material"]]
    constants = scene.pair_constants(values, material)
    values = parameters.complete(values, constants, O.numThreads)
    step_chosen = parameters.step_chosen(values, constants)
    aggregate_radius = values["radius"] * material.grainRadius

    # Two aggregates on their way to each other
    centres, velocities = zip(*scene.placements(values, material.grainRadius))
    pair = [
        packings.moved(aggregates.make(values, material.grainRadius, constants["equilibriumOverlap"], index), centre)
        for index, centre in enumerate(centres)
    ]
    packings.require_apart(*pair)
    folder = run_folder.RunFolder(values["out"], values["overwrite"], values["resume"])
    saved = folder.checkpoint
    if saved:
        saved.require_agreement(values, report.made_with())

# YADE's scene, and what is recorded of it
time_step = values["stepFraction"] * constants["timeUnit"]
schedule = sampling.Schedule.of(values["duration"], time_step)
history = recorder.Recorder(folder, schedule, scene.aggregate_of_grain(pair), aggregate_radius)
if saved:
    history.go_on(saved.rows)
    steps, runner, begin = scene.go_on(values, schedule, saved)
else:
    scene.build(pair, velocities, scene.material_of(values, material), time_step, values["planar"])
    steps, runner, begin = scene.start(values, material.grainRadius, schedule, history)
run = report.Report(
    folder,
    values,
    {**scene.derived(values, material, constants, schedule, time_step), "stepChoice": step_chosen},
    start,
    saved.wallTime if saved else 0.0,
)
checkpoints = checkpoint.Writer(folder.path, run.run, history, run.wall_time, values["checkpointInterval"])

# The run
if values["tolerance"] is not None:
    print(f"step: {step_chosen}", flush=True)
outcome, status = run_loop.run(steps, history, runner, begin, checkpoints)
history.write_history()
run.end(outcome)
sys.exit(status)
