"""A scene of a file (scene_file.py) in YADE: bodies, contacts, cell, and a code at its start. Imported within YADE."""

import numpy as np
from yade import utils, wrapper
from yade.minieigenHP import Matrix3, Vector3

import contact_law  # noqa: F401  (puts the plugin's classes into wrapper)
from analysis.theory import Material, pair_constants
from yade_scripts.run.scene import VERLET_DISTANCE, functor_engines

BLOCKED = {1: "x", 2: "y", 4: "z", 8: "X", 16: "Y", 32: "Z"}


def stock_material(given, radius):
    """Of the stock law, for like grains: springs of JKR's slope at equilibrium (A24 eq 38) and of W07, which break at JKR's
    pull; no limit of sliding."""
    c = pair_constants(given, radius)
    kn, ks = 6 * c.pull_off_force / (5 * c.equilibrium_overlap), c.sliding_stiffness
    springs = {
        "young": kn / radius,
        "poisson": ks / kn,
        "alphaKr": c.rolling_stiffness / 4 / ks,
        "etaRoll": -1,
        "etaTwist": -1,
    }
    springs |= {"alphaKtw": c.twisting_stiffness / (ks * radius**2), "momentRotationLaw": True, "frictionAngle": 0.5}
    pull = c.pull_off_force / radius**2
    cohesion = {"isCohesive": True, "normalCohesion": pull, "shearCohesion": 1e3 * pull}
    return wrapper.CohFrictMat(density=given.density, **springs, **cohesion)


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
    _settle(scene.grains)


def _settle(grains):
    """Let grains (GRAIN,) of the stock law touch now without a force: a step adds to their springs the way of the step before
    it, which a step backwards takes away, after which all is where it was."""
    omega = wrapper.Omega()

    def place(sign):
        columns = (
            grains["position"].tolist(),
            *((sign * grains[name]).tolist() for name in ("velocity", "angularVelocity")),
        )
        for body, now in zip(omega.bodies, zip(*columns)):
            body.state.pos, body.state.vel, body.state.angVel = now

    place(-1)
    omega.step()
    for contact in omega.interactions:
        contact.phys.unp = contact.geom.penetrationDepth
    place(1)


def add_bodies(scene, law="fused"):
    omega = wrapper.Omega()
    for material in scene.materials:
        given = {name: float(material[name]) for name in material.dtype.names}
        stock = law == "stock" and stock_material(Material(*material.tolist()), float(scene.grains["radius"][0]))
        omega.materials.append(stock or wrapper.JKRMat(**given))
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
