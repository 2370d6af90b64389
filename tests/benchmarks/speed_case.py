"""One measurement of speed, for bench.py: yade -n -x speed_case.py MOVER RADIUS SECONDS ANSWER.json

Two CPE aggregates (filling 0.4) of RADIUS grain radii on their way to each other at 10^0.5 m/s, moved for about SECONDS by MOVER: fused1, fused2 (threads),
functors, or stock (YADE's own loop with its cohesive law CohFrictPhys with moments, sliding, rolling and twisting). Writes {contacts, steps, seconds, rate}.
"""
import json
import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import contact_law  # noqa: E402,F401
from yade.wrapper import *  # noqa: E402,F403

from yade_scripts import packings, scene  # noqa: E402
from yade_scripts.materials import MATERIALS  # noqa: E402

mover, radius, seconds, answer = sys.argv[1], float(sys.argv[2]), float(sys.argv[3]), sys.argv[4]
material = MATERIALS["ice"]
values = {"radius": radius, "impact": 0.0, "velocity": 10**0.5, "viscoelasticTime": 0.0, "material": "ice"}
constants = scene.pair_constants(values, material)
centres, velocities = zip(*scene.placements(values, material.grainRadius))
aggregates = [packings.moved(packings.cpe(0.4, radius * material.grainRadius, material.grainRadius, constants["equilibriumOverlap"], 1, index), centre)
              for index, centre in enumerate(centres)]
step = 0.1 * constants["timeUnit"]
stock_material = CohFrictMat(young=7e9, poisson=0.25, density=1000, frictionAngle=0.5, isCohesive=True, normalCohesion=1e9, shearCohesion=1e9,
                             momentRotationLaw=True, alphaKr=1, alphaKtw=1)
scene.build(aggregates, velocities, stock_material if mover == "stock" else scene.material_of(values, material), step)
O.trackEnergy = mover != "stock"
if mover.startswith("fused"):
    O.engines = [JKRWadaEngine(threads=int(mover[5:]), subSteps=50)]
    O.dt *= 50
elif mover == "functors":
    O.engines = scene.functor_engines(material.grainRadius, PyRunner(command="pass", iterPeriod=10**9))
else:
    O.engines = [ForceResetter(), InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=scene.VERLET_DISTANCE * material.grainRadius),
                 InteractionLoop([Ig2_Sphere_Sphere_ScGeom6D()], [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True)],
                                 [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(useIncrementalForm=True)]),
                 NewtonIntegrator(damping=0)]
small_steps = 50 if mover.startswith("fused") else 1
O.step()  # lists are made, contacts found
contacts = O.engines[0].statistics()["contacts"] if mover.startswith("fused") else O.interactions.countReal()
start, steps = time.perf_counter(), 0
while time.perf_counter() - start < seconds or steps == 0:
    O.step()
    steps += small_steps
elapsed = time.perf_counter() - start
with open(answer, "w") as file:
    json.dump({"contacts": contacts, "steps": steps, "seconds": elapsed, "rate": contacts * steps / elapsed}, file)
