"""A scene of a file (scene_file.py) inside YADE: bodies, contacts, cell, a code at its start, and measurements of it.

    yade -n -x in_yade.py '{"path": scene, "together", "law", "instructions"}'

law: fused (the engine, `together` small steps in an O.step) or functors. Reads requests, a line of JSON each
({"threads", "seconds", "most"}), until its input ends, and prints a line "ANSWER " + JSON for each. The scene goes on
from request to request, so that measurements of several codes can alternate.
"""

import json
import os
import sys
import time

import numpy as np

if __name__ == "__main__":
    HERE = os.path.dirname(os.path.abspath(sys.argv[0]))
    sys.path[:0] = [HERE, os.path.dirname(os.path.dirname(HERE))]
import scene_file
from yade import O, utils
from yade.minieigenHP import Matrix3, Vector3
from yade.wrapper import *

import contact_law  # noqa: F401 (YADE's wrapper has its classes)
from yade_scripts.run.scene import functor_engines

BLOCKED = {1: "x", 2: "y", 4: "z", 8: "X", 16: "Y", 32: "Z"}


# ---- bodies and contacts ----


def add_bodies(scene):
    """Append the grains of a SceneFile to O.bodies."""
    for material in scene.materials:
        O.materials.append(JKRMat(**{name: float(material[name]) for name in material.dtype.names}))
    columns = [scene.grains[name].tolist() for name in scene.grains.dtype.names]
    bodies = []
    for position, velocity, spin, radius, mass, inertia, material, blocked in zip(*columns):
        body = utils.sphere(position, radius, material=material)
        state = body.state
        state.vel, state.angVel, state.mass, state.inertia = velocity, spin, mass, (inertia, inertia, inertia)
        if blocked:
            state.blockedDOFs = "".join(letter for bit, letter in BLOCKED.items() if blocked & bit)
        bodies.append(body)
    O.bodies.append(bodies)


def add_contacts(contacts, law):
    """Interactions with the springs of contacts (scene_file.CONTACT,), for the engine to take over."""
    functors = [Ig2_Sphere_Sphere_ScGeom(interactionDetectionFactor=2)], [Ip2_JKRMat_JKRMat_JKRWadaPhys(**law)]
    O.engines = [InteractionLoop(*functors, [Law2_ScGeom_JKRWadaPhys_JKRWada()])]
    columns = [contacts[name].tolist() for name in contacts.dtype.names]
    for first, second, bonded, pointer1, pointer2, twist, overlap, drag, rest in zip(*columns):
        interaction = utils.createInteraction(first, second)
        if interaction.id1 != first:
            pointer1, pointer2 = pointer2, pointer1
        history = {"pointer1": Vector3(*pointer1), "pointer2": Vector3(*pointer2), "twist": twist, "overlap": overlap}
        state = {"touching": True, "current": True, "bonded": bool(bonded), "dragForce": drag, "restDistance": rest}
        interaction.phys.updateAttrs({**history, **state})


# ---- codes at their start ----


def start_engine(scene, sub_steps, threads=1, instructions=""):
    """The fused engine with a SceneFile whose bodies are there, prepared: O.step() makes sub_steps small steps."""
    head = scene.head
    O.trackEnergy = True
    O.dt = float(head["step"]) * sub_steps
    if scene.periodic:
        O.periodic = True
        O.cell.setBox(*head["cellSize"].tolist())
        O.cell.homoDeform = 0  # the mean flow is in the velocities
    law = {"linearDamping": float(head["linearDamping"]), "neck": float(head["neck"])}
    if len(scene.contacts):
        add_contacts(scene.contacts, law)
    if scene.periodic:
        # by its name: "O.cell.velGrad = " would hold from the next step on, and the first forces be of a cell at rest
        O.cell.updateAttrs({"velGrad": Matrix3(*np.diag(head["strainRate"]).flatten().tolist())})
    O.engines = [JKRWadaEngine(subSteps=sub_steps, threads=threads, instructions=instructions, **law)]
    O.engines[0].prepare()


def start_functors(scene):
    """This repository's functors in YADE's own loop, for grains without contacts."""
    O.dt, O.trackEnergy = float(scene.head["step"]), True
    radius = float(scene.grains["radius"].max())
    O.engines = functor_engines(radius, PyRunner(command="pass", iterPeriod=10**9))


# ---- measurements ----


def run(seconds, most):
    """(O.steps, seconds) until this many seconds have passed, or `most` O.steps are done."""
    steps, begin = 0, time.perf_counter()
    while steps == 0 or (steps < most and time.perf_counter() - begin < seconds):
        O.step()
        steps += 1
    return steps, time.perf_counter() - begin


def measure(fused, small_steps, threads, seconds, most):
    """A measurement of so many seconds, or of a share of `most` small steps, after a third of it unmeasured.

    Unmeasured: while other codes had their turn this process was idle, and some machines take the memory of such away:
    the first of two measurements was slower by a tenth.
    """
    if fused:
        O.engines[0].threads = threads
    contacts = lambda: O.engines[0].statistics()["contacts"] if fused else O.interactions.countReal()
    share = max(1, most // small_steps // 4)
    run(seconds / 3, share)
    before = contacts()
    steps, elapsed = run(seconds, 3 * share)
    return {"contacts": (before + contacts()) / 2, "steps": steps * small_steps, "seconds": elapsed}


def main(path, together, law, instructions):
    scene, fused = scene_file.load(path), law == "fused"
    add_bodies(scene)
    if fused:
        start_engine(scene, together, threads=2, instructions=instructions)
    else:
        start_functors(scene)
    O.step(), O.step()
    for line in sys.stdin:
        print("ANSWER " + json.dumps(measure(fused, together if fused else 1, **json.loads(line))), flush=True)


if __name__ == "__main__":
    main(**json.loads(sys.argv[1]))
    sys.exit(0)
