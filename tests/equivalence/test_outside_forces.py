"""Forces of scripts and other engines (O.forces) in JKRWadaEngine: as NewtonIntegrator takes them, and booked as externalWork."""

import pytest

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
weight = 1e-3 * constants(ice(), 1e-7)["pullOffForce"]
def total():
    return total_energy() + sum(dict(O.energy.items()).get(name, 0.0) for name in ("constraintWork", "externalWork"))
def state():
    return [[list(b.state.pos), list(b.state.vel), list(b.state.angVel)] for b in O.bodies]
def pushes(seed=4):
    'Permanent forces and torques on two thirds of the bodies: {id: (force, torque)}.'
    random = np.random.default_rng(seed)
    return {b.id: (weight * random.normal(size=3), 1e-8 * weight * random.normal(size=3)) for b in O.bodies if b.id % 3}
def push():
    for k, (force, torque) in pushes().items():
        O.forces.setPermF(k, Vector3(*force)); O.forces.setPermT(k, Vector3(*torque))
"""


def test_engine_and_functors_agree(yade):
    """Positions to rounding. The functors begin with velocities of half a step before."""
    found = yade(
        SCENE
        + """
def run(engine, pushed=True, steps=400):
    new_scene(0.1 * unit)
    converging(27, 1, [ice(), soft()], [1e-7])
    O.bodies[4].state.blockedDOFs = "xZ"
    if pushed: push()
    if engine: fused_engine(subSteps=10); O.dt *= 10
    for k, (force, torque) in pushes().items() if pushed and not engine else ():
        s = O.bodies[k].state
        free = [not s.blockedDOFs or letter not in s.blockedDOFs for letter in "xyzXYZ"]
        s.vel -= Vector3(*(0.5 * O.dt / s.mass * force * free[:3])); s.angVel -= Vector3(*(0.5 * O.dt / s.inertia[0] * torque * free[3:]))
    O.run(steps // 10 if engine else steps, True)
    return positions()
a, b, without = run(False), run(True), run(True, False)
result["difference"] = float(np.abs(a - b).max() / 1e-7)
result["moved"] = float(np.abs(b - without).max() / 1e-7)
"""
    )
    assert found["difference"] < 1e-9 and found["moved"] > 1e-3, found


def test_to_the_engine_and_back_in_the_middle_of_a_run(yade):
    found = yade(
        SCENE
        + """
def run(*parts):
    new_scene(0.1 * unit)
    converging(27, 1, [ice()], [1e-7])
    push()
    for engine, steps in parts:
        if engine: fused_engine(); O.run(steps, True); O.engines[0].handOver(); O.engines = functor_engines()
        else: O.run(steps, True)
    return positions()
straight, with_engine = run((0, 350)), run((0, 150), (1, 149), (0, 50))
result["difference"] = float(np.abs(straight - with_engine).max() / 1e-7)
"""
    )
    assert found["difference"] < 1e-8, found


def test_free_grains_follow_the_closed_form(yade):
    """A force is held over an O.step: a parabola, its work the force times the way. Gravity by YADE's engine is one.

    A leapfrog's kinetic energy is less than 1/2 m v^2 by m (a dt)^2/8, and so is the work.
    """
    found = yade(
        SCENE
        + """
new_scene(0.1 * unit)
grain((0, 0, 0), 1e-7, ice(), (1, 2, 3))
grain((0, 9e-7, 0), 1e-7, ice(), (0.5, 0, 0), (0, 1e6, 0))
O.dt, ends = 3 * unit, []
O.engines = [GravityEngine(gravity=(0, 0, -1e9)), JKRWadaEngine(subSteps=30)]
m, inertia = O.bodies[0].state.mass, O.bodies[0].state.inertia[0]
x, v, w, done = np.array([0, 0, 0.0]), np.array([1, 2, 3.0]), 1e6, 0.0
for k in range(4):
    f = np.array([(k - 1) * weight, 0, 0])
    twist = (2 - k) * 1e-9 * weight
    O.forces.addF(0, Vector3(*f)); O.forces.addT(1, Vector3(0, twist, 0))
    O.step()
    f = f + np.array([0, 0, -1e9 * m])
    way, turned = v * O.dt + 0.5 * f / m * O.dt**2, w * O.dt + 0.5 * twist / inertia * O.dt**2
    x, v, w = x + way, v + f / m * O.dt, w + twist / inertia * O.dt
    fall = 3 * unit * O.bodies[1].state.vel[2] + 0.5 * 1e9 * O.dt**2
    done += f @ way + twist * turned - 1e9 * m * fall
    result[f"x{k}"] = float(np.abs(positions()[0] - x).max() / 1e-7)
    result[f"v{k}"] = float(np.abs(np.array(O.bodies[0].state.vel) - v).max())
    result[f"w{k}"] = abs(O.bodies[1].state.angVel[1] / w - 1)
    less = (0.1 * unit) ** 2 / 8 * (f @ f / m + m * 1e18 + twist**2 / inertia)
    result[f"work{k}"] = abs(O.energy["externalWork"] / (less - done) - 1)
    ends.append(total())
result["closure"] = (max(ends) - min(ends)) / energies()["kinetic"]
"""
    )
    assert max(found.values()) < 1e-9, found


def test_the_ledger_closes_with_second_order(yade):
    """Through collisions, with forces that change at every O.step, on free and on blocked grains; on one thread as on three."""
    found = yade(
        SCENE
        + """
unit_energy = constants(ice(), 1e-7)["pullOffForce"] * constants(ice(), 1e-7)["pullOffOverlap"]
def run(step, threads=1):
    new_scene(step * unit)
    converging(27, 2, [ice(), soft()], [1e-7])
    for k in (3, 8): O.bodies[k].state.blockedDOFs = "xyZ"
    held = {k: (30 * force, 30 * torque) for k, (force, torque) in pushes().items()}
    fused_engine(subSteps=round(0.4 / step), threads=threads, domains=3)
    O.dt = 0.4 * unit
    O.engines[0].prepare()
    first, worst = total(), 0
    for k in range(150):
        for number, (force, torque) in held.items():
            turn = 1 + math.sin(0.1 * k + number)
            O.forces.addF(number, Vector3(*(turn * force))); O.forces.addT(number, Vector3(*(turn * torque)))
        O.step()
        worst = max(worst, abs(total() - first))
    return worst / unit_energy
result["errors"] = [run(step) for step in (0.1, 0.05, 0.025)]
result["works"] = [O.energy["externalWork"] / unit_energy, O.energy["constraintWork"] / unit_energy]
one = state()
run(0.025, 3)
result["same"] = one == state()
"""
    )
    errors = found["errors"]
    assert abs(found["works"][0]) > 1 and found["works"][1] != 0 and found["same"], found
    assert errors[0] / errors[2] > 8 and errors[2] < 1e-2 * abs(found["works"][0]), found


@pytest.mark.parametrize(
    "scene",
    ["cluster(7, 3, [ice()], [1e-7], 3.0, 3e7)", "cluster(7, 3, [ice(viscoelasticTime=1e-12)], [1e-7], 3.0, 3e7)"],
)
def test_a_checkpoint_with_permanent_forces_resumes_to_the_same_bits(yade, scene):
    """YADE does not save O.forces: the engine does. What a script sets after loading holds instead."""
    found = yade(
        SCENE
        + f"""
new_scene(unit)
{scene}
push()
fused_engine(subSteps=10)
O.run(20, True)
O.save("saved.xml")
O.run(20, True)
straight, sums = state(), dict(O.energy.items())
O.load("saved.xml")
O.run(20, True)
result["same"] = state() == straight and dict(O.energy.items()) == sums
result["work"] = sums["externalWork"]
O.load("saved.xml")
O.forces.setPermF(1, Vector3(0, 0, 0))
O.run(20, True)
result["without"] = state() == straight
"""
    )
    assert found["same"] and found["work"] != 0 and not found["without"], found


@pytest.mark.parametrize("loaded", [False, True])
def test_permanent_forces_that_are_saved_before_the_first_step_hold(yade, loaded):
    """Of a scene that was never stepped, and of one that was loaded and not stepped since."""
    found = yade(
        SCENE
        + """
def run(saved):
    new_scene(unit)
    cluster(5, 1, [ice()], [1e-7], 1.0, 0)
    fused_engine(subSteps=10)
    if parameters["loaded"]:
        O.run(3, True)
        O.save("stepped.xml"); O.load("stepped.xml")
    push()
    if saved: O.save("pushed.xml"); O.load("pushed.xml")
    O.run(10, True)
    return state()
result["same"] = run(True) == run(False)
result["work"] = O.energy["externalWork"]
""",
        {"loaded": loaded},
    )
    assert found["same"] and found["work"] != 0, found


def test_what_holds_and_what_is_refused(yade):
    found = yade(
        SCENE
        + """
def start(*before):
    new_scene(0.1 * unit)
    grain((0, 0, 0), 1e-7, ice())
    grain((0, 9e-7, 0), 1e-7, ice())
    O.engines = [*before, JKRWadaEngine()]
start()
O.step()
result["plain"] = sorted(O.energy.keys())
O.forces.addF(0, Vector3(weight, 0, 0))
O.step(); O.step(); v = O.bodies[0].state.vel[0]; O.step()
result["over"] = v > 0 and O.bodies[0].state.vel[0] == v
start(ForceResetter())
O.forces.addF(0, Vector3(weight, 0, 0))
O.step()
result["reset"] = O.bodies[0].state.vel[0]
start()
O.forces.addF(1, Vector3(float("nan"), 0, 0))
result["nan"] = refusal()
start()
O.step()
O.engines = [JKRWadaEngine()]
O.forces.addT(1, Vector3(0, weight, 0))
result["left"] = refusal()
"""
    )
    assert "externalWork" not in found["plain"] and found["over"] and found["reset"] == 0
    assert found["nan"] == "JKRWadaEngine: O.forces has a force or torque on body 1 that is not a finite number"
    assert found["left"].startswith(
        "JKRWadaEngine: O.forces has a force or torque on body 1 from before this engine's first step: it must be 0 or permanent"
    )
