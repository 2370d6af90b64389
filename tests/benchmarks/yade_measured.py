"""Runs inside YADE and measures on request: yade -n -x yade_measured.py LAW KIND RADIUS SPEED (of measured_scenes.make)

LAW: jkr-wada, or stock (YADE's cohesive law CohFrictPhys with moments: sliding, rolling, twisting). Reads a request a line (JSON: {"do": name, ...})
and answers with a line "ANSWER " + JSON, until its input ends. It keeps the scene between requests, so that measurements of several codes can alternate.
"""

import ctypes
import json
import os
import sys
import time

sys.path[:0] = [
    os.path.dirname(os.path.abspath(sys.argv[0])),
    os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))),
]
import measured_scenes  # noqa: E402
from yade import utils  # noqa: E402
from yade.wrapper import *  # noqa: E402,F403

import contact_law  # noqa: E402,F401
from analysis.measures.fragments import fragment_labels, fragment_sizes  # noqa: E402
from yade_scripts.run.scene import VERLET_DISTANCE, functor_engines  # noqa: E402

SUB_STEPS = 50
LAW, KIND, RADIUS, SPEED = sys.argv[1], sys.argv[2], float(sys.argv[3]), float(sys.argv[4])
scene = measured_scenes.make(KIND, RADIUS, SPEED)


def build():
    for material in scene.materials:
        if LAW == "stock":
            O.materials.append(
                CohFrictMat(
                    young=material.young,
                    poisson=material.poisson,
                    density=material.density,
                    frictionAngle=0.5,
                    isCohesive=True,
                    normalCohesion=1e9,
                    shearCohesion=1e9,
                    momentRotationLaw=True,
                    alphaKr=1,
                    alphaKtw=1,
                )
            )
        else:
            O.materials.append(
                JKRMat(
                    young=material.young,
                    poisson=material.poisson,
                    density=material.density,
                    surfaceEnergy=material.surface_energy,
                    criticalRolling=material.critical_rolling,
                )
            )
    O.bodies.append(
        [
            utils.sphere(x, r, material=m)
            for x, r, m in zip(scene.position.tolist(), scene.radius.tolist(), scene.material.tolist())
        ]
    )
    restart()
    O.trackEnergy = LAW != "stock"


def restart():
    for body, x, v in zip(O.bodies, scene.position.tolist(), scene.velocity.tolist()):
        body.state.pos, body.state.vel, body.state.angVel = x, v, (0, 0, 0)


def fused(threads, instructions=""):
    """Engine, lists and contacts made for the grains at the start."""
    restart()
    O.engines, O.dt = (
        [JKRWadaEngine(threads=threads, subSteps=SUB_STEPS, instructions=instructions)],
        scene.step * SUB_STEPS,
    )
    O.step()
    return O.engines[0]


def loop():
    """YADE's own loop, with this repository's law or the stock one; continues from where it was after the last request for it."""
    if any(engine.label == "measured loop" for engine in O.engines):  # YADE starts with engines of its own
        return
    restart()
    O.dt = scene.step
    if LAW == "stock":
        O.engines = [
            ForceResetter(),
            InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=VERLET_DISTANCE * measured_scenes.GRAIN_RADIUS),
            InteractionLoop(
                [Ig2_Sphere_Sphere_ScGeom6D()],
                [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True)],
                [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(useIncrementalForm=True)],
            ),
            NewtonIntegrator(damping=0),
        ]
    else:
        O.engines = functor_engines(measured_scenes.GRAIN_RADIUS, PyRunner(command="pass", iterPeriod=10**9))
    O.engines[0].label = "measured loop"
    O.step()


def timed(seconds, small_steps, contacts):
    """Steps for at least that long, after a third of it unmeasured; contacts: function that counts them. fraction: processor seconds a second, all threads together.

    Unmeasured: while other codes had their turn this process was idle, and some machines take the memory of such away: what came first of two measurements was slower by a tenth."""
    warm = time.perf_counter() + seconds / 3
    while time.perf_counter() < warm:
        O.step()
    before, steps, processor, start = contacts(), 0, time.process_time(), time.perf_counter()
    while steps == 0 or time.perf_counter() - start < seconds:
        O.step()
        steps += small_steps
    elapsed, processor = time.perf_counter() - start, time.process_time() - processor
    mean = (before + contacts()) / 2
    return {
        "contacts": mean,
        "grains": scene.grains,
        "steps": steps,
        "seconds": elapsed,
        "rate": mean * steps / elapsed,
        "fraction": processor / elapsed,
    }


def measure_fused(seconds, threads, instructions=""):
    engine = fused(threads, instructions)
    return {
        **timed(seconds, SUB_STEPS, lambda: engine.statistics()["contacts"]),
        "instructions": engine.statistics()["instructions"],
    }


def measure_loop(seconds):
    loop()
    return timed(seconds, 1, O.interactions.countReal)


def measure_memory():
    """Bytes that the process holds after 100 small steps with two threads, beyond those that it held for the scene."""
    O.engines = []  # one that was measured before frees its arrays
    ctypes.CDLL("libc.so.6").malloc_trim(0)
    before = resident()
    engine = fused(2)
    O.step()
    return {"contacts": engine.statistics()["contacts"], "bytes": resident() - before}


def resident():
    return 1024 * next(int(line.split()[1]) for line in open("/proc/self/status") if line.startswith("VmRSS"))


def measure_collision(duration, parts):
    """Speed in each of the equally long parts of a collision, one and two threads by turns of SUB_STEPS small steps."""
    engine, result, start_time = fused(1), [], O.time
    steps_of_part = max(2, round(duration / O.dt / parts))
    for _ in range(parts):
        updates, seconds = {1: 0, 2: 0}, {1: 0.0, 2: 0.0}
        for step in range(steps_of_part):
            engine.threads = 1 + step % 2
            contacts, start = engine.statistics()["contacts"], time.perf_counter()
            O.step()
            seconds[engine.threads] += time.perf_counter() - start
            updates[engine.threads] += contacts * SUB_STEPS
        contacts = contact_law.snapshot()["contact_pairs"]
        result.append(
            {
                "until": O.time - start_time,
                "contacts": len(contacts),
                "pieces": len(fragment_sizes(fragment_labels(scene.grains, contacts))),
                "events": engine.statistics()["events"],
                **{f"rate{n}": updates[n] / seconds[n] for n in (1, 2)},
            }
        )
    return result


def serve():
    requests = {"fused": measure_fused, "loop": measure_loop, "memory": measure_memory, "collision": measure_collision}
    print("ANSWER " + json.dumps({"grains": scene.grains, "contacts": measured_scenes.touching(scene)}), flush=True)
    for line in sys.stdin:
        request = json.loads(line)
        answer = requests[request.pop("do")](**request)
        print("ANSWER " + json.dumps(answer), flush=True)


build()
serve()
