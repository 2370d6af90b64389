"""From packings and a material to YADE's bodies and engines."""

from math import pi

import numpy as np
from yade import utils
from yade.wrapper import (
    Bo1_Sphere_Aabb,
    ForceResetter,
    Ig2_Sphere_Sphere_ScGeom,
    InsertionSortCollider,
    InteractionLoop,
    Ip2_JKRMat_JKRMat_JKRWadaPhys,
    JKRMat,
    JKRWadaEngine,
    Law2_ScGeom_JKRWadaPhys_JKRWada,
    NewtonIntegrator,
    Omega,
    PyRunner,
)

import contact_law  # noqa: F401  (puts the plugin's classes into yade.wrapper, so it comes first)

# How far, in grain radii, a grain may move before the collider looks for neighbours again: less makes it look
# more often, more makes every step test more pairs that don't touch. Measured at 6,400 grains, a step costs
# the same to a few per cent from 0.02 to 0.1, and an eighth more at 0.3.
VERLET_DISTANCE = 0.1
DERIVED_FROM_CONTACT = ("equilibriumContactRadius", "equilibriumOverlap", "pullOffOverlap", "pullOffForce", "timeUnit")
DERIVED_FROM_BOND = (
    "shrunkRadius",
    "neckRadius",
    "neckLength",
    "normalStiffness",
    "slidingStiffness",
    "rollingStiffness",
    "twistingStiffness",
    "breakingEnergy",
)
COLOURS = ((0.35, 0.60, 0.85), (0.90, 0.60, 0.25))


def material_of(values, material):
    """The plugin's material for a row of materials.py and the parameters of a run."""
    return JKRMat(
        young=material.young,
        poisson=material.poisson,
        density=material.density,
        surfaceEnergy=material.surfaceEnergy,
        criticalRolling=material.criticalRolling,
        viscoelasticTime=values["viscoelasticTime"],
        label=values["material"],
    )


def pair_constants(values, material):
    """The plugin's constants (SI) of a contact between two grains of the run, and of a bond under 'bond'.

    The former are of grains that have not sintered, as packings and the time unit have them; 'bond' is None when
    nothing is sintered, else the attributes of JKRWadaBond and shrunkRadius [m] of the grains.
    """
    grains = 2 * (material_of(values, material), material.grainRadius)
    constants = {**Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(*grains), "bond": None}
    if values["neck"]:
        sintered = Ip2_JKRMat_JKRMat_JKRWadaPhys(neck=values["neck"])
        constants["bond"] = {
            **sintered.bondConstants(*grains),
            "shrunkRadius": sintered.pairConstants(*grains)["radius1"],
        }
    return constants


def placements(values, grain_radius):
    """Centre and velocity, ((3,), (3,)), of both aggregates: A24 section 3, offset as in A22 eq 27.

    Centres at -/+(R_agg + r) in x and -/+ impact (R_agg + r) in y; velocities +/- velocity/2 in x.
    """
    reach = (values["radius"] + 1) * grain_radius
    centre = np.array([reach, values["impact"] * reach, 0.0])
    velocity = np.array([values["velocity"] / 2, 0.0, 0.0])
    return (-centre, velocity), (centre, -velocity)


def aggregate_of_grain(packings):
    """The number of the aggregate that each grain belongs to, (N,)."""
    return np.repeat(np.arange(len(packings)), [packing.grains for packing in packings])


def build(packings, velocities, plugin_material, time_step, planar=False):
    """Make bodies of the packings, each with its velocity (3,) [m/s]; planar: that never leave their plane z = 0."""
    omega = Omega()
    plugin_material_id = omega.materials.append(plugin_material)
    for packing, velocity, colour in zip(packings, velocities, COLOURS):
        bodies = [
            utils.sphere(centre, radius, material=plugin_material_id, color=colour)
            for centre, radius in zip(packing.position.tolist(), packing.radius.tolist())
        ]
        for body in bodies:
            body.state.vel = velocity
            body.state.blockedDOFs = "zXY" if planar else ""
        omega.bodies.append(bodies)
    omega.dt = time_step
    omega.trackEnergy = True


def start(values, grain_radius, schedule, history):
    """Choose the engines that sample into history: (O.steps to take, the sampling PyRunner, what to do first).

    The fused engine takes the steps between two samples in one O.step, and its start is sampled first. With the
    functors a sample comes at the beginning of a step, so that one more step is taken to sample the end.
    """
    omega = Omega()
    runner = PyRunner(command="history.sample()", iterPeriod=schedule.interval, initRun=True)
    if values["engine"] == "functors":
        omega.engines = functor_engines(grain_radius, runner, values["neck"])
        return schedule.steps + 1, runner, lambda: None
    runner.iterPeriod = 1
    fused = JKRWadaEngine(subSteps=schedule.interval, threads=values["threads"], neck=values["neck"])
    omega.dt *= schedule.interval
    omega.engines = [fused, runner]
    return schedule.steps // schedule.interval, runner, lambda: (fused.prepare(), history.sample())


def go_on(values, schedule, saved):
    """The same for a scene out of a checkpoint, which has its engines and whose start has been sampled."""
    omega = Omega()
    saved.load_scene()
    fused, runner = omega.engines[0], omega.engines[-1]
    if values["engine"] == "functors":
        return schedule.steps + 1, runner, lambda: None
    fused.threads = values["threads"]
    return schedule.steps // schedule.interval, runner, lambda: None


def functor_engines(grain_radius, runner, neck=0.0):
    """YADE's own engines with the plugin's law; runner comes last, after a whole step."""
    return [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=VERLET_DISTANCE * grain_radius),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom()],
            [Ip2_JKRMat_JKRMat_JKRWadaPhys(neck=neck)],
            [Law2_ScGeom_JKRWadaPhys_JKRWada()],
        ),
        NewtonIntegrator(damping=0),
        runner,
    ]


def derived(values, material, constants, schedule, time_step):
    """What run.json calls derived: the material, and what follows from it and the parameters (SI)."""
    return {
        "young": material.young,
        "poisson": material.poisson,
        "surfaceEnergy": material.surfaceEnergy,
        "density": material.density,
        "criticalRolling": material.criticalRolling,
        "viscoelasticTime": values["viscoelasticTime"],
        "grainRadius": material.grainRadius,
        "grainMass": 4 / 3 * pi * material.grainRadius**3 * material.density,
        **{name: constants[name] for name in DERIVED_FROM_CONTACT},
        **({name: constants["bond"][name] for name in DERIVED_FROM_BOND} if constants["bond"] else {}),
        "timeStep": time_step,
        "steps": schedule.steps,
        "aggregateRadius": values["radius"] * material.grainRadius,
        "grainsPerAggregate": values["grains"],
    }
