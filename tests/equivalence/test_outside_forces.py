"""Forces of scripts and other engines (O.forces) in JKRWadaEngine: as NewtonIntegrator takes them, and booked as
externalWork."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade
WORKS = ("constraintWork", "externalWork")


def weight():
    return 1e-3 * constants(ice(), 1e-7)["pullOffForce"]


def pushes():
    """Permanent forces and torques on two thirds of the bodies: {id: (force, torque)}."""
    random, w = np.random.default_rng(4), weight()
    return {b.id: (w * random.normal(size=3), 1e-8 * w * random.normal(size=3)) for b in O.bodies if b.id % 3}


def push():
    for k, (force, torque) in pushes().items():
        O.forces.setPermF(k, Vector3(*force))
        O.forces.setPermT(k, Vector3(*torque))


def half_a_step_before():
    """Velocities as YADE's integrator holds them, where forces push from the start."""
    for k, (force, torque) in pushes().items():
        s = O.bodies[k].state
        free = [letter not in s.blockedDOFs for letter in "xyzXYZ"]
        s.vel -= Vector3(*(0.5 * O.dt / s.mass * force * free[:3]))
        s.angVel -= Vector3(*(0.5 * O.dt / s.inertia[0] * torque * free[3:]))


def test_engine_and_functors_agree():
    """Positions to rounding. The functors begin with velocities of half a step before."""

    def end(engine, pushed=True):
        new_scene(0.1 * unit)
        converging(27, 1, [ice(), soft()], [1e-7])
        O.bodies[4].state.blockedDOFs = "xZ"
        if pushed:
            push()
        if engine:
            engine_of_sub_steps(10)
        else:
            half_a_step_before()
        O.run(40 if engine else 400, True)
        return positions()

    functors, engine, without = end(False), end(True), end(True, pushed=False)
    assert np.abs(functors - engine).max() < 1e-9 * 1e-7 and np.abs(engine - without).max() > 1e-3 * 1e-7


def test_free_grains_follow_the_closed_form():
    """A force is held over an O.step: a parabola, its work the force times the way. Gravity by YADE's engine is one.

    A leapfrog's kinetic energy is less than 1/2 m v^2 by m (a dt)^2/8, and so is the work.
    """
    new_scene(0.1 * unit)
    grain((0, 0, 0), 1e-7, ice(), (1, 2, 3))
    grain((0, 9e-7, 0), 1e-7, ice(), (0.5, 0, 0), (0, 1e6, 0))
    O.dt, ends = 3 * unit, []
    O.engines = [GravityEngine(gravity=(0, 0, -1e9)), JKRWadaEngine(subSteps=30)]
    m, inertia = O.bodies[0].state.mass, O.bodies[0].state.inertia[0]
    x, v, w, done = np.array([0, 0, 0.0]), np.array([1, 2, 3.0]), 1e6, 0.0
    for k in range(4):
        f = np.array([(k - 1) * weight(), 0, 0])
        twist = (2 - k) * 1e-9 * weight()
        O.forces.addF(0, Vector3(*f))
        O.forces.addT(1, Vector3(0, twist, 0))
        O.step()
        f = f + np.array([0, 0, -1e9 * m])
        way, turned = v * O.dt + 0.5 * f / m * O.dt**2, w * O.dt + 0.5 * twist / inertia * O.dt**2
        x, v, w = x + way, v + f / m * O.dt, w + twist / inertia * O.dt
        fall = 3 * unit * O.bodies[1].state.vel[2] + 0.5 * 1e9 * O.dt**2
        done += f @ way + twist * turned - 1e9 * m * fall
        assert np.abs(positions()[0] - x).max() < 1e-9 * 1e-7
        assert np.abs(np.array(O.bodies[0].state.vel) - v).max() < 1e-9
        assert O.bodies[1].state.angVel[1] == pytest.approx(w, rel=1e-9)
        less = (0.1 * unit) ** 2 / 8 * (f @ f / m + m * 1e18 + twist**2 / inertia)
        assert O.energy["externalWork"] == pytest.approx(less - done, rel=1e-9)
        ends.append(O.energy.total())  # without the engine's gravWork
    assert O.energy["gravWork"] != 0 and np.ptp(ends) < 1e-9 * energies()["kinetic"]


def test_the_ledger_closes_with_second_order():
    """Through collisions, with forces that change at every O.step, on free and on blocked grains."""
    c = constants(ice(), 1e-7)
    unit_energy = c["pullOffForce"] * c["pullOffOverlap"]

    def closure(step):
        new_scene(step * unit)
        converging(27, 2, [ice(), soft()], [1e-7])
        for k in (3, 8):
            O.bodies[k].state.blockedDOFs = "xyZ"
        held = {k: (30 * force, 30 * torque) for k, (force, torque) in pushes().items()}
        fused_engine(subSteps=round(0.4 / step), domains=3)
        O.dt = 0.4 * unit
        O.engines[0].prepare()

        def pushed():
            for number, (force, torque) in held.items():
                turn = 1 + np.sin(0.1 * O.iter + number)
                O.forces.addF(number, Vector3(*(turn * force)))
                O.forces.addT(number, Vector3(*(turn * torque)))
            O.step()

        return largest_change(150, *WORKS, step=pushed) / unit_energy

    coarse, _, fine = (closure(step) for step in (0.1, 0.05, 0.025))
    work = abs(O.energy["externalWork"]) / unit_energy
    assert work > 1 and O.energy["constraintWork"] != 0
    assert coarse / fine > 8 and fine < 1e-2 * work


def two_grains(*before):
    new_scene(0.1 * unit)
    for y in (0, 9e-7):
        grain((0, y, 0), 1e-7, ice())
    O.engines = [*before, JKRWadaEngine()]


def test_a_force_holds_for_one_step():
    two_grains()
    O.step()
    assert O.energy["externalWork"] == 0
    O.forces.addF(0, Vector3(weight(), 0, 0))
    O.run(2, True)
    v = O.bodies[0].state.vel[0]
    O.step()
    assert v > 0 and O.bodies[0].state.vel[0] == v
    two_grains(ForceResetter())
    O.forces.addF(0, Vector3(weight(), 0, 0))
    O.step()
    assert O.bodies[0].state.vel[0] == 0


def test_forces_that_the_engine_would_not_see_are_refused():
    two_grains()
    O.engines = [*O.engines, GravityEngine(gravity=(0, 0, -1e9))]
    assert refusal().startswith("JKRWadaEngine: GravityEngine comes after this engine in O.engines")
    two_grains()
    O.step()
    O.engines = [JKRWadaEngine()]
    O.forces.addT(1, Vector3(0, weight(), 0))
    words = "a force or torque on body 1 from before this engine's first step: it must be 0 or permanent"
    assert refusal().startswith(f"JKRWadaEngine: O.forces has {words}")
