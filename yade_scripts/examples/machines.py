"""Two blocks of grains collide in several processes, on several machines, by YADE's own MPI (yade.mpy).

yade -n -x yade_scripts/examples/machines.py 0                 # one process
yade -n -x yade_scripts/examples/machines.py 2                 # a master and two workers, started by it
mpiexec --hostfile HOSTS -n 3 yade -n -x yade_scripts/examples/machines.py 2      # the same on several machines

The numbers are those of one process but for rounding (of positions 1e-15): forces across domains are added in another
order. Energies and record() are for one process, and so is the fused engine, which with one core takes 0.13 ms for a
step of 3,456 grains. YADE's own loop takes 3 to 7 ms in one process, and 8 ms with two workers on two busy cores: by
these numbers some fifty cores would be as fast.
"""

import os
import sys
import time

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import numpy as np

import contact_law  # noqa: F401 (makes JKRMat and the other classes known)

os.environ.setdefault("OMPI_MCA_mpi_yield_when_idle", "1")  # where there are fewer cores than processes
WORKERS, STEPS = int(sys.argv[1]), 400
RADIUS, SIDE, VELOCITY = 1e-7, 8, 5.0  # m, grains along an edge, m/s
ice = JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9)
constants = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice, RADIUS, ice, RADIUS)
stream = np.random.default_rng(1)
O.materials.append(ice)
for site in np.ndindex(2 * SIDE, SIDE, SIDE):
    right = site[0] >= SIDE
    centre = np.array(site) * (2 * RADIUS - constants["equilibriumOverlap"]) + (0.2 * RADIUS * right, 0, 0)
    centre += stream.uniform(-1, 1, 3) * 0.2 * constants["equilibriumOverlap"]
    O.bodies.append(utils.sphere(centre, RADIUS, material=ice))
    O.bodies[-1].state.vel = (-VELOCITY if right else VELOCITY, 0, 0)
O.engines = [  # with the labels that yade.mpy looks for
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.1 * RADIUS, label="collider"),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom()],
        [Ip2_JKRMat_JKRMat_JKRWadaPhys()],
        [Law2_ScGeom_JKRWadaPhys_JKRWada()],
        label="interactionLoop",
    ),
    NewtonIntegrator(damping=0, label="newton"),
]
O.dt = 0.1 * constants["timeUnit"]

begun, rank = time.monotonic(), 0
if WORKERS:
    from yade import mpy

    mpy.DOMAIN_DECOMPOSITION = True
    mpy.ERASE_REMOTE_MASTER = False  # the master keeps all grains, whose states the workers send it at the end
    mpy.mpirun(STEPS, WORKERS + 1, True)
    rank = mpy.rank
else:
    O.run(STEPS, True)
if rank == 0:
    grains = [body.state for body in O.bodies if isinstance(body.shape, Sphere)]
    kinetic, seconds = sum(state.mass * state.vel.squaredNorm() / 2 for state in grains), time.monotonic() - begun
    print(f"{len(grains)} grains, {STEPS} steps, {WORKERS} workers: {kinetic:.10e} J kinetic, {seconds:.1f} s")
