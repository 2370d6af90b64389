"""Within YADE, the functors, the fused engine or YADE's stock cohesive law:

yade -n -x adapters/yade_codes.py functors|engine|stock RESULTS.json [CASE ...]
"""

import os
import sys

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(os.path.dirname(os.path.dirname(HERE)))]
import numpy as np
from answers import NotModelled, main
from yade import config, utils
from yade.wrapper import *

import contact_law

NAMES = dict(young="young", poisson="poisson", density="density", surfaceEnergy="surface_energy")
NAMES.update(criticalRolling="critical_rolling", viscoelasticTime="viscoelastic_time")
CHANNELS = {"connection": "connection", "disconnection": "disconnection", "bond breaking": "bondBreaking"}
LEDGER = [name for name, kind in contact_law.channels if kind != "work"]
CODES = {"functors": "functors in YADE's loop", "engine": "JKRWadaEngine", "stock": "YADE's CohFrictPhys with moments"}


def material(given, radius):
    ours = JKRMat(**{our: given[their] for our, their in NAMES.items()})
    return ours if CODE != "stock" else stock_material(ours, radius)


def stock_material(ours, r):
    """A linear spring of JKR's slope at equilibrium (A24 eq 38), pull of F_c, springs of W07; of like grains of radius r."""
    c = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ours, r, ours, r)
    kn, ks = 6 * c["pullOffForce"] / (5 * c["equilibriumOverlap"]), c["slidingStiffness"]
    bending, twisting = c["rollingStiffness"] / 4 / ks, c["twistingStiffness"] / (ks * r**2)
    limits = dict(
        normalCohesion=c["pullOffForce"] / r**2, shearCohesion=ks * c["criticalSliding"] / r**2, frictionAngle=0.0
    )
    springs = dict(young=kn / r, poisson=ks / kn, alphaKr=bending, alphaKtw=twisting, momentRotationLaw=True)
    return CohFrictMat(density=ours.density, isCohesive=True, etaRoll=-1, etaTwist=-1, **springs, **limits)


def engines(scene):
    law = dict(linearDamping=scene.get("linear_damping", 0.0), neck=scene.get("neck", 0.0))
    if CODE == "engine":
        return [JKRWadaEngine(exportInteractions=True, **law)]
    if CODE == "stock":
        shapes, law = (
            [Ig2_Sphere_Sphere_ScGeom6D()],
            [Law2_ScGeom6D_CohFrictPhys_CohesionMoment(useIncrementalForm=True)],
        )
        constants = [Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionOnNewContacts=True)]
    else:
        shapes, constants = (
            [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()],
            [Ip2_JKRMat_JKRMat_JKRWadaPhys(**law)],
        )
        law = [Law2_ScGeom_JKRWadaPhys_JKRWada()]
    collider = InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=2e-9)
    driving = PyRunner(command="drive()", iterPeriod=1, initRun=True)
    return [ForceResetter(), collider, InteractionLoop(shapes, constants, law), driving, NewtonIntegrator(damping=0)]


def place(scene, materials):
    O.reset()
    if "plane" in scene:
        O.bodies.append(utils.wall(0, axis=0, material=material(materials[scene["plane"]["material"]], 1e-7)))
    first = len(O.bodies)
    for g in scene["grains"]:
        body = utils.sphere(g["position"], g["radius"], material=material(materials[g["material"]], g["radius"]))
        body.state.vel, body.state.angVel = g["velocity"], g["spin"]
        body.state.blockedDOFs = "xyzXYZ" if "prescribed" in scene else ""
        O.bodies.append(body)
    return range(first, len(O.bodies))


def series_of(scene, materials, steps):
    drag = scene.get("linear_damping") or any(materials[g["material"]]["viscoelastic_time"] for g in scene["grains"])
    if CODE == "stock" and ("plane" in scene or scene.get("neck") or drag):
        raise NotModelled(
            "planes not tried" if "plane" in scene else "no sintered bonds" if scene.get("neck") else "no such drag"
        )
    grains, segments = place(scene, materials), scene.get("prescribed")
    O.dt, O.trackEnergy, O.engines = scene["duration"] / steps, True, engines(scene)

    def drive():
        """Velocities of the step to come."""
        segment = next((s for s in segments or () if s["until"] > (O.iter + 0.5) * O.dt), None)
        for k, i in enumerate(grains if segment else ()):
            O.bodies[i].state.vel, O.bodies[i].state.angVel = segment["velocity"][k], segment["spin"][k]

    sys.modules["__main__"].drive = drive
    moved = lambda: np.array([[s.pos, s.vel, s.angVel] for s in (O.bodies[i].state for i in grains)])
    acting = lambda: np.array([[O.forces.f(i), O.forces.t(i)] for i in grains])
    states, forces, ledger = [], [], []
    if CODE == "engine":  # all of one moment
        O.engines[0].prepare()
        O.engines[0].writeInteractions()
        states.append(moved()), forces.append(acting()), ledger.append(energies())
    for _ in range(steps + (CODE != "engine")):
        if CODE == "engine":
            drive()
        before = moved()
        O.step()
        after = moved()
        if CODE != "engine":  # forces of the positions before the step, velocities of half a step before and after
            after[:, 0], after[:, 1:] = before[:, 0], (before[:, 1:] + after[:, 1:]) / 2
        states.append(after), forces.append(acting()), ledger.append(energies())
    states, forces = np.array(states), np.array(forces)
    found = dict(
        time=O.dt * np.arange(steps + 1), position=states[:, :, 0], velocity=states[:, :, 1], spin=states[:, :, 2]
    )
    found |= dict(force=forces[:, 0, 0], torque=forces[:, :, 1], mass=[O.bodies[i].state.mass for i in grains])
    channels = {name: np.array([one.get(key, 0.0) for one in ledger]) for name, key in CHANNELS.items()}
    channels["total"] = np.array([sum(one.get(name, 0.0) for name in LEDGER) for one in ledger])
    return {**found, "channels": channels} if CODE != "stock" else found


def energies():
    return dict(O.energy.items())


if __name__ == "__main__":
    CODE, path, *names = sys.argv[1:]
    main(CODES[CODE], f"YADE {config.version}", series_of, path, names)
    sys.exit(0)
