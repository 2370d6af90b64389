"""Runs inside YADE: a code on a scene of a file, measured on request. yade -n -x yade_codes.py '{"scene", "together", "law", "instructions"}'

law: fused (the engine, `together` small steps in an O.step), functors, or stock (YADE's cohesive law CohFrictPhys with moments: sliding, rolling, twisting).
Prints a line "ANSWER " + JSON when it is ready, and one for each request, a line of JSON, until its input ends: {"do": "turn", ...} or {"do": "through", ...}.
The scene goes on from request to request, so that measurements of several codes can alternate.
"""

import ctypes
import json
import os
import sys
import time

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(os.path.dirname(HERE))]
import scene_file
import yade_scene
from yade.wrapper import *

import contact_law
from analysis.measures.fragments import fragment_labels, fragment_sizes

COUNTED = ("searches", "looks", "events", "formed", "broken", "contactUpdates")


def resident():
    """Bytes that the process holds."""
    return 1024 * next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith("VmRSS"))


def prepare(law, together, instructions):
    """(small steps in an O.step, bytes that the engine took, None where interactions came from a file): everything made, and touched for the first time."""
    if law != "fused":
        yade_scene.start_loop(scene, law)
        O.step()
        return 1, None
    ctypes.CDLL("libc.so.6").malloc_trim(0)
    before = resident()
    yade_scene.start_engine(scene, together, threads=2, instructions=instructions)
    O.step(), O.step()
    return together, None if len(scene.contacts) else resident() - before


def contacts():
    return O.engines[0].statistics()["contacts"] if fused else O.interactions.countReal()


def run(seconds, most):
    """(steps, seconds, processor seconds) of O.steps until this many seconds have passed, or `most` of them are done."""
    steps, processor, start = 0, time.process_time(), time.perf_counter()
    while steps == 0 or (steps < most and time.perf_counter() - start < seconds):
        O.step()
        steps += 1
    return steps, time.perf_counter() - start, time.process_time() - processor


def counted():
    """What adds up from the start on, with the sum of all channels [J]; of the engine."""
    if not fused:
        return {}
    statistics, energy = O.engines[0].statistics(), dict(O.energy.items())
    sums = {"energyChange": sum(energy.values()), "boundaryWork": energy.get("boundaryWork", 0.0)}
    return {**{name: statistics[name] for name in COUNTED}, **sums}


def turn(threads, seconds, most):
    """A measurement of that many seconds, or a share of `most` small steps, after a third of it unmeasured.

    Unmeasured: while other codes had their turn this process was idle, and some machines take the memory of such away: what came first of two measurements was
    slower by a tenth."""
    if fused:
        O.engines[0].threads = threads
    share = max(1, most // small_steps // 4)
    run(seconds / 3, share)
    before, first, kinetic = contacts(), counted(), O.energy["kinetic"] if fused else None
    steps, elapsed, processor = run(seconds, 3 * share)
    last = counted()
    return {
        "grains": len(O.bodies),
        "contacts": (before + contacts()) / 2,
        "steps": steps * small_steps,
        "seconds": elapsed,
        "fraction": processor / elapsed,
        "version": O.engines[0].statistics()["instructions"] if fused else "",
        "kinetic": kinetic,
        **{name: last[name] - first[name] for name in last},
    }


def through(flight, parts):
    """Of a collision: its flight (O.steps), and each of its parts (a list of O.steps): [{until [s], contacts, pieces, events, rates: {threads: contact updates a second}}];
    one and two threads by turns, so that both do the same work."""
    engine, result, start = O.engines[0], [], O.time + flight * O.dt
    for o_steps in [flight, *parts]:
        updates, seconds = {1: 0, 2: 0}, {1: 0.0, 2: 0.0}
        for step in range(o_steps):
            engine.threads = 1 + step % 2
            now = contacts()
            _, elapsed, _ = run(0, 1)
            seconds[engine.threads] += elapsed
            updates[engine.threads] += now * small_steps
        pairs = contact_law.snapshot()["contact_pairs"]
        result.append(
            {
                "until": O.time - start,
                "contacts": len(pairs),
                "pieces": len(fragment_sizes(fragment_labels(len(O.bodies), pairs))),
                "events": engine.statistics()["events"],
                "rates": {n: updates[n] / seconds[n] for n in (1, 2)},
            }
        )
    return result


asked = json.loads(sys.argv[1])
scene, fused = scene_file.load(asked["scene"]), asked["law"] == "fused"
yade_scene.add_bodies(scene, asked["law"])
small_steps, taken = prepare(asked["law"], asked["together"], asked["instructions"])
print("ANSWER " + json.dumps({"commit": contact_law.commit, "bytes": taken}), flush=True)
for line in sys.stdin:
    request = json.loads(line)
    answer = {"turn": turn, "through": through}[request.pop("do")](**request)
    print("ANSWER " + json.dumps(answer), flush=True)
sys.exit(0)
