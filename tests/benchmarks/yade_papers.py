"""Runs inside YADE: the speed of the fused engine from a scene of a file on. yade -n -x yade_papers.py REQUEST (JSON), answers with a line "ANSWER " + JSON.

REQUEST: {"scene": file, "together": small steps in an O.step, "rounds", "seconds": of one measurement, "most": small steps of all measurements}.
One and two threads take turns within one run, so that both do the same work; each turn is timed by itself.
"""

import json
import os
import sys
import time

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(os.path.dirname(HERE))]
import scene_file  # noqa: E402
import yade_scene  # noqa: E402

import contact_law  # noqa: E402,F401  (the plugin, before anything asks it)

THREADS = (1, 2)


def turn(engine, threads, o_steps):
    """Seconds of so many O.steps, and processor seconds a second."""
    engine.threads = threads
    processor, start = time.process_time(), time.perf_counter()
    for _ in range(o_steps):
        O.step()
    seconds = time.perf_counter() - start
    return seconds, (time.process_time() - processor) / seconds


def measure(scene, together, rounds, seconds, most):
    engine = yade_scene.build(scene_file.load(scene), together)
    start = time.perf_counter()
    turn(engine, 2, 2)  # unmeasured: memory is touched for the first time
    o_steps = max(1, round(2 * seconds / (time.perf_counter() - start)))
    o_steps = max(1, min(o_steps, most // (together * rounds * len(THREADS))))
    turn(engine, 1, max(1, o_steps // 3))
    before, energies = engine.statistics(), dict(O.energy.items())
    contacts, turns = [before["contacts"]], []
    for _ in range(rounds):
        for threads in THREADS:
            elapsed, fraction = turn(engine, threads, o_steps)
            contacts.append(engine.statistics()["contacts"])
            mean = (contacts[-1] + contacts[-2]) / 2
            turns.append(
                {
                    "threads": threads,
                    "seconds": elapsed,
                    "steps": o_steps * together,
                    "contacts": mean,
                    "fraction": fraction,
                }
            )
    after, now = engine.statistics(), dict(O.energy.items())
    counted = ("searches", "looks", "events", "formed", "broken", "contactUpdates")
    return {
        "grains": len(O.bodies),
        "contacts": sum(turn["contacts"] for turn in turns) / len(turns),
        "turns": turns,
        **{name: after[name] - before[name] for name in counted},
        "energyChange": sum(now.values()) - sum(energies.values()),
        "kinetic": energies["kinetic"],
        "boundaryWork": now.get("boundaryWork", 0.0) - energies.get("boundaryWork", 0.0),
        "instructions": after["instructions"],
        "commit": contact_law.commit,
    }


print("ANSWER " + json.dumps(measure(**json.loads(sys.argv[1]))), flush=True)
sys.exit(0)
