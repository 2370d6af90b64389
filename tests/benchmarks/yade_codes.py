"""Runs inside YADE: a code on a scene of a file, measured on request.

    yade -n -x yade_codes.py '{"path": scene, "together", "law", "instructions"}'

law: fused (the engine, `together` small steps in an O.step), functors, or stock (YADE's cohesive law CohFrictPhys with
moments: sliding, rolling, twisting). Prints a line "ANSWER " + JSON for each request, a line of JSON ({"threads", "seconds",
"most"}), until its input ends. The scene goes on from request to request, so that measurements of several codes can
alternate.
"""

import ctypes
import json
import os
import sys
import time

import numpy as np

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(os.path.dirname(HERE))]
import scene_file
import yade_scene
from yade.wrapper import *

import contact_law

COUNTED = ("searches", "distanceChecks", "events", "formed", "broken", "contactUpdates")


def resident():
    """Bytes that the process holds."""
    return 1024 * next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith("VmRSS"))


def start(path, together, law, instructions, warm=True):
    """Make everything, and touch memory for the first time: (whether it is the engine, small steps in an O.step, bytes that
    the engine took, None where there were interactions before)."""
    scene = scene_file.load(path)
    yade_scene.add_bodies(scene, law)
    ctypes.CDLL("libc.so.6").malloc_trim(0)
    before = resident()
    if law == "fused":
        yade_scene.start_engine(scene, together, threads=2, instructions=instructions)
    else:
        yade_scene.start_loop(scene, law)
    if warm:
        O.step(), O.step()
    taken = resident() - before if law == "fused" and not len(scene.contacts) else None
    return law == "fused", together if law == "fused" else 1, taken


def contacts():
    return O.engines[0].statistics()["contacts"] if fused else O.interactions.countReal()


def velocities():
    return np.array([[*body.state.vel, *body.state.angVel] for body in O.bodies])


def follow(samples, each):
    """{kinetic: energy, rotation's too, at the start and after each of so many times `each` small steps [J]; energy: sum of all
    channels (None: no ledger); seconds: of the processor in the steps}; each is what an O.step of the engine makes."""
    inertia = np.array([[body.state.mass] * 3 + list(body.state.inertia) for body in O.bodies])
    if fused:
        O.engines[0].threads = 1
    kinetic, energy, seconds = [], [], 0.0
    for k in range(samples + 1):
        before, begin = velocities(), time.process_time()
        if not fused or k < samples:
            O.step()
        # a loop has velocities of half a step before its positions and after
        kinetic.append(np.sum(inertia * (before if fused else (before + velocities()) / 2) ** 2) / 2)
        for _ in range(each - 1 if not fused and k < samples else 0):
            O.step()
        seconds += time.process_time() - begin
        energy.append(sum(dict(O.energy.items()).values()))
    return {"kinetic": kinetic, "energy": energy if any(energy) else None, "seconds": seconds}


def run(seconds, most):
    """(steps, seconds, processor seconds) of O.steps until this many seconds have passed, or `most` of them are done."""
    steps, processor, begin = 0, time.process_time(), time.perf_counter()
    while steps == 0 or (steps < most and time.perf_counter() - begin < seconds):
        O.step()
        steps += 1
    return steps, time.perf_counter() - begin, time.process_time() - processor


def counted():
    """What adds up from the start on, with the sum of all channels [J]; of the engine."""
    if not fused:
        return {}
    statistics, energy = O.engines[0].statistics(), dict(O.energy.items())
    sums = {"energyChange": sum(energy.values()), "boundaryWork": energy.get("boundaryWork", 0.0)}
    return {**{name: statistics[name] for name in COUNTED}, **sums}


def measure(threads, seconds, most):
    """A measurement of that many seconds, or of a share of `most` small steps, after a third of it unmeasured.

    Unmeasured: while other codes had their turn this process was idle, and some machines take the memory of such away: what
    came first of two measurements was slower by a tenth."""
    if fused:
        O.engines[0].threads = threads
    share = max(1, most // small_steps // 4)
    run(seconds / 3, share)
    before, first, kinetic = contacts(), counted(), O.energy["kinetic"] if fused else None
    steps, elapsed, processor = run(seconds, 3 * share)
    last, version = counted(), O.engines[0].statistics()["instructions"] if fused else ""
    found = {"grains": len(O.bodies), "contacts": (before + contacts()) / 2, "steps": steps * small_steps}
    found |= {"seconds": elapsed, "fraction": processor / elapsed, "version": version, "kinetic": kinetic}
    found |= {"commit": contact_law.commit, "bytes": taken}
    return {**found, **{name: last[name] - first[name] for name in last}}


fused, small_steps, taken = start(**json.loads(sys.argv[1]))
for line in sys.stdin:
    asked = json.loads(line)
    print("ANSWER " + json.dumps((follow if "each" in asked else measure)(**asked)), flush=True)
sys.exit(0)
