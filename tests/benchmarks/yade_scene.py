"""A scene of a file (scene_file.py) in YADE: bodies, contacts, cell, and a code at its start. Imported within YADE."""

import numpy as np
from yade import utils, wrapper
from yade.minieigenHP import Matrix3, Vector3

import contact_law  # noqa: F401  (puts the plugin's classes into wrapper)
from yade_scripts.run.scene import VERLET_DISTANCE, functor_engines

BLOCKED = {1: "x", 2: "y", 4: "z", 8: "X", 16: "Y", 32: "Z"}
STOCK = {"frictionAngle": 0.5, "isCohesive": True, "normalCohesion": 1e9, "shearCohesion": 1e9}
STOCK.update(momentRotationLaw=True, alphaKr=1, alphaKtw=1)


def start_engine(scene, sub_steps, threads=1, instructions=""):
    """The fused engine with a SceneFile whose bodies are there, prepared: O.step() makes sub_steps small steps."""
    omega, head = wrapper.Omega(), scene.head
    omega.trackEnergy = True
    omega.dt = float(head["step"]) * sub_steps
    if scene.periodic:
        omega.periodic = True
        omega.cell.setBox(*head["cellSize"].tolist())
        omega.cell.homoDeform = 0  # the mean flow is in the velocities
    law = {"linearDamping": float(head["linearDamping"]), "neck": float(head["neck"])}
    if len(scene.contacts):
        add_contacts(scene.contacts, law)
    if scene.periodic:
        # by its name: "O.cell.velGrad = " would hold from the next step on, and the first forces be those of a cell at rest
        omega.cell.updateAttrs({"velGrad": Matrix3(*np.diag(head["strainRate"]).flatten().tolist())})
    omega.engines = [wrapper.JKRWadaEngine(subSteps=sub_steps, threads=threads, instructions=instructions, **law)]
    omega.engines[0].prepare()


def start_loop(scene, law):
    """YADE's own loop, with this repository's law (functors) or the stock one, for grains that have no contacts yet."""
    omega, radius = wrapper.Omega(), float(scene.grains["radius"].max())
    omega.dt, omega.trackEnergy = float(scene.head["step"]), law == "functors"
    if law == "functors":
        omega.engines = functor_engines(radius, wrapper.PyRunner(command="pass", iterPeriod=10**9))
        return
    omega.engines = [
        wrapper.ForceResetter(),
        wrapper.InsertionSortCollider([wrapper.Bo1_Sphere_Aabb()], verletDist=VERLET_DISTANCE * radius),
        wrapper.InteractionLoop(
            [wrapper.Ig2_Sphere_Sphere_ScGeom6D()],
            [wrapper.Ip2_CohFrictMat_CohFrictMat_CohFrictPhys(setCohesionNow=True)],
            [wrapper.Law2_ScGeom6D_CohFrictPhys_CohesionMoment(useIncrementalForm=True)],
        ),
        wrapper.NewtonIntegrator(damping=0),
    ]


def add_bodies(scene, law="fused"):
    omega = wrapper.Omega()
    for material in scene.materials:
        given = {name: float(material[name]) for name in material.dtype.names}
        elastic = {name: given[name] for name in ("young", "poisson", "density")}
        stock = law == "stock"
        omega.materials.append(wrapper.CohFrictMat(**elastic, **STOCK) if stock else wrapper.JKRMat(**given))
    grains = scene.grains
    columns = [grains[name].tolist() for name in grains.dtype.names]
    bodies = []
    for position, velocity, spin, radius, mass, inertia, material, blocked in zip(*columns):
        body = utils.sphere(position, radius, material=material)
        state = body.state
        state.vel, state.angVel, state.mass, state.inertia = velocity, spin, mass, (inertia, inertia, inertia)
        if blocked:
            state.blockedDOFs = "".join(letter for bit, letter in BLOCKED.items() if blocked & bit)
        bodies.append(body)
    omega.bodies.append(bodies)


def add_contacts(contacts, law):
    """Interactions with the springs of contacts (CONTACT,), for the engine to take over; functors only make them."""
    wrapper.Omega().engines = [
        wrapper.InteractionLoop(
            [wrapper.Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=2)],
            [wrapper.Ip2_JKRMat_JKRMat_JKRWadaPhys(**law)],
            [wrapper.Law2_ScGeom_JKRWadaPhys_JKRWada()],
        )
    ]
    columns = [contacts[name].tolist() for name in contacts.dtype.names]
    for first, second, bonded, pointer1, pointer2, twist, overlap, drag, rest in zip(*columns):
        interaction = utils.createInteraction(first, second)
        if interaction.id1 != first:
            pointer1, pointer2 = pointer2, pointer1
        history = {"pointer1": Vector3(*pointer1), "pointer2": Vector3(*pointer2), "twist": twist, "overlap": overlap}
        state = {"touching": True, "current": True, "bonded": bool(bonded), "dragForce": drag, "restDistance": rest}
        interaction.phys.updateAttrs({**history, **state})
