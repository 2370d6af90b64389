"""Within YADE: yade -n -x adapters/yade_codes.py functors|engine|stock RESULTS.json [CASE ...]"""

import os
import sys

HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
sys.path[:0] = [HERE, os.path.dirname(os.path.dirname(os.path.dirname(HERE)))]
import numpy as np
from answers import NotModelled, main
from yade import config, utils
from yade.wrapper import *

import contact_law

CHANNELS = {"connection": "connection", "disconnection": "disconnection", "bond breaking": "bondBreaking"}
ATTRIBUTES = {"surface_energy": "surfaceEnergy", "critical_rolling": "criticalRolling"}
ATTRIBUTES["viscoelastic_time"] = "viscoelasticTime"
LEDGER = [name for name, kind in contact_law.channels if kind != "work"]
CODES = {"functors": "functors in YADE's loop", "engine": "JKRWadaEngine", "stock": "YADE's CohFrictPhys with moments"}


def own_material(given, c):
    if CODE == "stock":
        return stock_material(given, c)
    return JKRMat(**{ATTRIBUTES.get(name, name): value for name, value in given.items()})


def stock_material(given, c):
    """A linear spring of JKR's slope at equilibrium (A24 eq 38), the pull F_c, springs of W07; for like grains."""
    r, ks = 2 * c["reduced_radius"], c["sliding_stiffness"]
    kn, shear = 6 * c["pull_off_force"] / (5 * c["equilibrium_overlap"]), ks * c["critical_sliding"]
    springs = dict(young=kn / r, poisson=ks / kn, alphaKr=c["rolling_stiffness"] / 4 / ks, momentRotationLaw=True)
    springs |= dict(alphaKtw=c["twisting_stiffness"] / (ks * r**2), etaRoll=-1, etaTwist=-1, frictionAngle=0.0)
    strengths = dict(normalCohesion=c["pull_off_force"] / r**2, shearCohesion=shear / r**2, isCohesive=True)
    return CohFrictMat(density=given["density"], **springs, **strengths)


def engines(law):
    if CODE == "engine":
        return [JKRWadaEngine(exportInteractions=True, **law)]
    shapes, constants = [Ig2_Sphere_Sphere_ScGeom(), Ig2_Wall_Sphere_ScGeom()], Ip2_JKRMat_JKRMat_JKRWadaPhys(**law)
    law = Law2_ScGeom_JKRWadaPhys_JKRWada()
    if CODE == "stock":
        shapes, law = [Ig2_Sphere_Sphere_ScGeom6D()], Law2_ScGeom6D_CohFrictPhys_CohesionMoment(useIncrementalForm=True)
        constants = Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionOnNewContacts=True)
    collider = InsertionSortCollider([Bo1_Sphere_Aabb(), Bo1_Wall_Aabb()], verletDist=2e-9)
    driving = PyRunner(command="drive()", iterPeriod=1, initRun=True)
    loop = InteractionLoop(shapes, [constants], [law])
    return [ForceResetter(), collider, loop, driving, NewtonIntegrator(damping=0)]


def place(scene, materials):
    """The scene's bodies in an empty Omega: ids of the grains."""
    O.reset()
    own = lambda name: own_material(materials[name], scene["contact"])
    walls = [utils.wall(0, axis=0, material=own(scene["plane"]["material"]))] if "plane" in scene else []
    bodies = [utils.sphere(g["position"], g["radius"], material=own(g["material"])) for g in scene["grains"]]
    for body, g in zip(bodies, scene["grains"]):
        body.state.vel, body.state.angVel = g["velocity"], g["spin"]
        body.state.blockedDOFs = "xyzXYZ" if "prescribed" in scene else ""
    return O.bodies.append(walls + bodies)[len(walls) :]


def series_of(scene, materials, steps):
    drag = scene["contact"]["linear_drag"] or scene["contact"]["viscous_drag_per_contact_radius"]
    bonds = "not tried: CohFrictPhys with stiffnesses and strengths of bonds"
    for there, why in ((scene.get("neck"), bonds), (drag, "no such drag"), ("plane" in scene, "not tried: walls")):
        if CODE == "stock" and there:
            raise NotModelled(why)
    grains, law = place(scene, materials), dict(linearDamping=scene.get("linear_damping", 0.0))
    law["neck"] = scene.get("neck", 0.0)
    O.dt, O.trackEnergy, O.engines = scene["duration"] / steps, True, engines(law)

    def drive():
        """Velocities of the step to come."""
        segment = next((s for s in scene.get("prescribed", ()) if s["until"] > (O.iter + 0.5) * O.dt), None)
        for k, i in enumerate(grains if segment else ()):
            O.bodies[i].state.vel, O.bodies[i].state.angVel = segment["velocity"][k], segment["spin"][k]

    sys.modules["__main__"].drive = drive
    moved = lambda: np.array([[s.pos, s.vel, s.angVel] for s in (O.bodies[i].state for i in grains)])
    acting = lambda: np.array([[O.forces.f(i), O.forces.t(i)] for i in grains])
    if CODE == "engine":  # all of one moment
        O.engines[0].prepare(), O.engines[0].writeInteractions()
        rows = [(moved(), acting(), dict(O.energy.items()))]
        for _ in range(steps):
            drive(), O.step()
            rows.append((moved(), acting(), dict(O.energy.items())))
    else:  # forces of the positions before the step, velocities of half a step before and after
        rows = []
        for _ in range(steps + 1):
            before, _ = moved(), O.step()
            both = (before + moved()) / 2
            both[:, 0] = before[:, 0]
            rows.append((both, acting(), dict(O.energy.items())))
    states, forces = (np.array([row[k] for row in rows]) for k in (0, 1))
    found = dict(zip(("position", "velocity", "spin"), np.moveaxis(states, 2, 0)), time=O.dt * np.arange(steps + 1))
    found |= dict(force=forces[:, 0, 0], torque=forces[:, :, 1], mass=[O.bodies[i].state.mass for i in grains])
    channels = {name: np.array([row[2].get(key, 0.0) for row in rows]) for name, key in CHANNELS.items()}
    channels["total"] = np.array([sum(row[2].get(name, 0.0) for name in LEDGER) for row in rows])
    return {**found, "channels": channels} if CODE != "stock" else found


if __name__ == "__main__":
    CODE, path, *names = sys.argv[1:]
    main(CODES[CODE], f"YADE {config.version}", series_of, path, names)
    sys.exit(0)
