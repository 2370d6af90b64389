"""Blocked degrees of freedom in JKRWadaEngine: as NewtonIntegrator treats them, and with a ledger that closes."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade


def planar():
    """25 grains in the plane z = 0, flying together, with spins about z only."""
    random = np.random.default_rng(1)
    for k in range(25):
        site = np.array([k % 5 - 2, k // 5 - 2, 0]) * 2.03e-7 + np.append(0.5e-9 * random.normal(size=2), 0)
        velocity = -5 * site / 2e-7 + np.append(random.normal(size=2), 0)
        grain(site, 1e-7, ice(), velocity, (0, 0, 2e7 * random.normal()), blocked="zXY")


def mixed():
    """Every body with other blocked degrees of freedom, moving in the blocked ones too."""
    converging(27, 1, [ice(), soft()], [1e-7])
    for k, b in enumerate(O.bodies):
        b.state.blockedDOFs = "".join(letter for bit, letter in enumerate("xyzXYZ") if (5 * k + 3) % 64 >> bit & 1)


def piston(step, **options):
    """A wall of nine grains moves at 2 m/s into eight free ones that rest on another, resting wall; it also turns."""
    new_scene(step * unit)
    random = np.random.default_rng(5)
    for x, y in np.ndindex(3, 3):
        grain((2.1e-7 * x, 2.1e-7 * y, 0), 1e-7, ice(), blocked="xyzXYZ")
        grain((2.1e-7 * x, 2.1e-7 * y, 5.7e-7), 1e-7, ice(), (0.2, 0, -2), (1e6, 0, 0), blocked="xyzXYZ")
    for x, y, z in np.ndindex(2, 2, 2):
        site = np.array([2.1e-7 * x, 2.1e-7 * y, 0.81e-7 + 1.99e-7 * z])
        grain(1e-7 + site + 2e-9 * random.normal(size=3), 1e-7, ice())
    fused_engine(**options)


@pytest.mark.parametrize("scene, resting", [("planar", True), ("mixed", False)])
def test_engine_and_functors_agree(scene, resting):
    def end(engine, steps):
        new_scene(0.1 * unit)
        globals()[scene]()
        if engine:
            engine_of_sub_steps(10)
        O.run(steps // 10 if engine else steps, True)
        return positions(), energies()

    (a, _), (_, functors), (b, engine) = end(False, 400), end(False, 401), end(True, 400)
    assert engine["connection"] > 0 and engine["slidingDissipation"] > 0
    assert np.abs(a - b).max() < 1e-9 * 1e-7
    if resting:
        assert max(abs(functors[n] - engine[n]) for n in CHANNELS) < 1e-9 * engine["kinetic"]
        assert np.all(b[:, 2] == 0)


def test_work_of_a_moving_wall_is_booked():
    """Kinetic and stored energy, losses and constraintWork add up to a constant, to second order in the step."""
    c = constants(ice(), 1e-7)

    def closure(step):
        piston(step)
        O.engines[0].prepare()
        wall = [k for k, b in enumerate(O.bodies) if b.state.vel[2] < 0]
        x = positions()[wall]
        worst = largest_change(40, "constraintWork", every=round(1.5 / step))
        assert np.abs(positions()[wall] - x - np.array([0.2, 0, -2]) * O.time).max() < 1e-9 * 1e-7
        return worst / (c["pullOffForce"] * c["pullOffOverlap"])

    coarse, _, fine = (closure(step) for step in (0.1, 0.05, 0.025))
    work = abs(O.energy["constraintWork"]) / (c["pullOffForce"] * c["pullOffOverlap"])
    moving, resting = O.bodies[1].state, O.bodies[0].state
    assert [*moving.vel, *moving.angVel, *resting.pos] == [0.2, 0, -2, 1e6, 0, 0, 0, 0, 0]
    assert work > 3 and fine < 2e-3 * work and coarse / fine > 8
