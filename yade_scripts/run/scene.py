"""From packings and parameters to YADE's bodies and engines."""

import os
from math import inf

import numpy as np
import yade.wrapper as yade
from yade import utils
from yade.wrapper import Omega

import contact_law  # noqa: F401  (puts the plugin's classes into yade.wrapper)
from yade_scripts.materials import OF_MATERIAL, OF_PAIRS
from yade_scripts.run import recorder as sampling
from yade_scripts.run.parameters import SPRINGS

# How far, in grain radii, a grain may move before the collider looks for neighbours again: less makes it look
# more often, more makes every step test more pairs that don't touch. Measured at 6,400 grains, a step costs
# the same to a few per cent from 0.02 to 0.1, and an eighth more at 0.3.
VERLET_DISTANCE = 0.1
COLOURS = ((0.35, 0.60, 0.85), (0.90, 0.60, 0.25))


def material_of(grains):
    """The plugin's material of materials.GrainParameters, of two the first."""
    return yade.JKRMat(label=grains.material_names[0], **{name: getattr(grains, name) for name in OF_MATERIAL})


def materials_of(grains):
    """The plugin's materials of materials.GrainParameters, in a list."""
    return [material_of(own) for own in grains.of_each()]


def pair_constants(grains, neck=0.0, linearDamping=0.0):
    """The plugin's constants (SI) of a contact of two grains; under 'bond' those of a sintered one, or None.

    grains: materials.GrainParameters with the OF_PAIRS."""
    two = 2 * (material_of(grains), grains.grainRadius)
    constants = {**_functor(grains, linearDamping).pairConstants(*two), "bond": None}
    if neck:
        sintered = yade.Ip2_JKRMat_JKRMat_JKRWadaPhys(neck=neck)
        constants["bond"] = {**sintered.bondConstants(*two), "shrunkRadius": sintered.pairConstants(*two)["radius1"]}
    return constants


def plane_constants(grains, linearDamping=0.0):
    """The same of a contact between a grain of the run and a plane of its material; no bond."""
    material = material_of(grains)
    return _functor(grains, linearDamping).pairConstants(material, grains.grainRadius, material, inf)


def _functor(grains, damping):
    return yade.Ip2_JKRMat_JKRMat_JKRWadaPhys(
        linearDamping=damping, **{name: getattr(grains, name) for name in OF_PAIRS}
    )


def add_bodies(packings, velocities, materials, planar=False, spins=None):
    """Make bodies of the packings, each with its velocity (3,) [m/s] and spin (3,) [rad/s] about its centre of mass;
    planar: that never leave their plane z = 0."""
    omega = Omega()
    ids = [omega.materials.append(material) for material in materials]
    for number, (packing, velocity) in enumerate(zip(packings, velocities)):
        colour = COLOURS[number % len(COLOURS)]
        kinds = packing.grains * [0] if packing.kind is None else packing.kind.tolist()
        bodies = [
            utils.sphere(centre, radius, material=ids[kind], color=colour)
            for centre, radius, kind in zip(packing.position.tolist(), packing.radius.tolist(), kinds)
        ]
        motion = packing.motion(velocity, np.zeros(3) if spins is None else spins[number])
        for body, own, spin in zip(bodies, *motion):
            body.state.vel, body.state.angVel = own, spin
            body.state.blockedDOFs = "zXY" if planar else ""
        omega.bodies.append(bodies)


def add_plane(axis, position, material, velocity=0.0):
    """A plane across an axis (0, 1, 2) at that coordinate [m], which moves along it [m/s]."""
    plane = utils.wall(position, axis=axis, material=material)
    plane.state.vel = [velocity if k == axis else 0.0 for k in range(3)]
    return Omega().bodies.append(plane)


def start(scene, schedule, recorder):
    """Build a run.kind.Scene and its engines: (O.steps to take, the sampling PyRunner, a function to call first).

    The fused engine takes the steps between two samples in one O.step. With the functors a sample comes at the
    beginning of a step, so that one more is taken to sample the end."""
    omega, parameters = Omega(), scene.parameters
    scene.build()
    omega.trackEnergy = True
    omega.dt = scene.time_step
    sampling.current = recorder
    runner = yade.PyRunner(command=sampling.COMMAND, iterPeriod=schedule.interval, initRun=True)
    law = {**{name: getattr(parameters, name) for name in OF_PAIRS}, **scene.law}
    contacts = {"limit": parameters.limit, **{name: bool(getattr(parameters, name)) for name in SPRINGS}}
    if parameters.engine == "functors":
        omega.engines = functor_engines(parameters.grainRadius, runner, contacts, **law)
        return schedule.steps + 1, runner, lambda: None
    runner.iterPeriod = 1
    fused = yade.JKRWadaEngine(subSteps=schedule.interval, threads=parameters.threads, **contacts, **law)
    omega.dt *= schedule.interval
    omega.engines = [fused, runner]
    return schedule.samples, runner, lambda: (fused.prepare(), recorder.sample())


def resume(scene, schedule, recorder, saved):
    """The same for the scene of a checkpoint, which has its engines and whose start has been sampled."""
    Omega().load(os.path.join(saved.run_folder, saved.scene))
    sampling.current = recorder
    engines = Omega().engines
    if scene.parameters.engine == "functors":
        return schedule.steps + 1, engines[-1], lambda: None
    engines[0].threads = scene.parameters.threads
    return schedule.samples, engines[-1], lambda: None


def functor_engines(grain_radius, runner, contacts={}, **law):
    """YADE's own engines with the plugin's law: attributes of its Law2 functor, and of the others; runner comes
    last."""
    return [
        yade.ForceResetter(),
        yade.InsertionSortCollider(
            [yade.Bo1_Sphere_Aabb(), yade.Bo1_Wall_Aabb()], verletDist=VERLET_DISTANCE * grain_radius
        ),
        yade.InteractionLoop(
            [yade.Ig2_Sphere_Sphere_ScGeom(), yade.Ig2_Wall_Sphere_ScGeom()],
            [yade.Ip2_JKRMat_JKRMat_JKRWadaPhys(**law)],
            [yade.Law2_ScGeom_JKRWadaPhys_JKRWada(**contacts)],
        ),
        yade.NewtonIntegrator(damping=0),
        runner,
    ]
