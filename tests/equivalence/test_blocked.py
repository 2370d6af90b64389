"""Blocked degrees of freedom in JKRWadaEngine: as NewtonIntegrator treats them, and with a ledger that closes."""

import pytest

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
def state():
    return positions(), np.array([b.state.vel for b in O.bodies]), np.array([b.state.angVel for b in O.bodies])
def planar(count=25, seed=1):
    'Grains in the plane z = 0, flying together, with spins about z only.'
    random = np.random.default_rng(seed)
    for k in range(count):
        site = np.array([k % 5 - 2, k // 5 - 2, 0]) * 2.03e-7 + np.append(0.5e-9 * random.normal(size=2), 0)
        grain(site, 1e-7, ice(), -5 * site / 2e-7 + np.append(random.normal(size=2), 0), (0, 0, 2e7 * random.normal()), blocked="zXY")
def mixed():
    'Every body with other blocked degrees of freedom, moving in the blocked ones too.'
    converging(27, 1, [ice(), soft()], [1e-7])
    for k, b in enumerate(O.bodies):
        b.state.blockedDOFs = "".join(letter for bit, letter in enumerate("xyzXYZ") if (5 * k + 3) % 64 >> bit & 1)
def piston(step, engine=True):
    'A wall of nine grains moves at 2 m/s into eight free ones that rest on another, resting wall; it also turns.'
    new_scene(step * unit)
    random = np.random.default_rng(5)
    for x in range(3):
        for y in range(3):
            grain((2.1e-7 * x, 2.1e-7 * y, 0), 1e-7, ice(), blocked="xyzXYZ")
            grain((2.1e-7 * x, 2.1e-7 * y, 5.7e-7), 1e-7, ice(), (0.2, 0, -2), (1e6, 0, 0), blocked="xyzXYZ")
    for x in range(2):
        for y in range(2):
            for z in range(2):
                grain(1e-7 + np.array([2.1e-7 * x, 2.1e-7 * y, 0.81e-7 + 1.99e-7 * z]) + 2e-9 * random.normal(size=3), 1e-7, ice())
    if engine:
        fused_engine()
def total():
    return total_energy() + dict(O.energy.items()).get("constraintWork", 0)
"""


@pytest.mark.parametrize("scene,resting", [("planar()", True), ("mixed()", False)])
def test_engine_and_functors_agree(yade, scene, resting):
    found = yade(
        SCENE
        + f"""
def run(engine, steps):
    new_scene(0.1 * unit)
    {scene}
    if engine: fused_engine(subSteps=10)
    if engine: O.dt *= 10
    O.run(steps // 10 if engine else steps, True)
    return positions(), energies()
(a, _), (b, engine) = run(False, 400), run(True, 400)
result["difference"] = float(np.abs(a - b).max() / 1e-7)
_, functors = run(False, 401)
result["energies"] = max(abs(functors[n] - engine[n]) for n in CHANNELS) / engine["kinetic"]
result["lost"] = engine
result["z"] = float(np.abs(b[:, 2]).max())
result["work"] = dict(O.energy.items()).get("constraintWork", 0.0)
"""
    )
    assert found["lost"]["connection"] > 0 and found["lost"]["slidingDissipation"] > 0
    assert found["difference"] < 1e-9, found
    if resting:
        assert found["energies"] < 1e-9 and found["z"] == 0, found


def test_work_of_a_moving_wall_is_booked(yade):
    """Kinetic and stored energy, losses and constraintWork add up to a constant, to second order in the step."""
    found = yade(
        SCENE
        + """
def closure(step):
    piston(step)
    O.engines[0].prepare()
    first, kinetic = total(), []
    wall = [k for k, b in enumerate(O.bodies) if b.state.vel[2] < 0]
    x = positions()[wall]
    worst = 0
    for _ in range(40):
        O.run(round(1.5 / step), True)
        worst = max(worst, abs(total() - first))
    moved = positions()[wall] - x
    result["straight"] = float(np.abs(moved - np.array([0.2, 0, -2]) * O.time).max() / 1e-7)
    return worst
unit_energy = constants(ice(), 1e-7)["pullOffForce"] * constants(ice(), 1e-7)["pullOffOverlap"]
result["errors"] = [closure(step) / unit_energy for step in (0.1, 0.05, 0.025)]
result["work"] = O.energy["constraintWork"] / unit_energy
result["wall"] = [list(O.bodies[1].state.vel), list(O.bodies[1].state.angVel), list(O.bodies[0].state.pos)]
result["lost"] = {name: value / unit_energy for name, value in energies().items()}
"""
    )
    assert found["wall"] == [[0.2, 0, -2], [1e6, 0, 0], [0, 0, 0]] and found["straight"] < 1e-9
    assert abs(found["work"]) > 3, found
    errors = found["errors"]
    assert errors[-1] < 2e-3 * abs(found["work"]) and errors[0] / errors[2] > 8, found


def test_a_body_blocked_and_freed_in_the_middle_of_a_run(yade):
    found = yade(
        SCENE
        + """
new_scene(0.1 * unit)
d = 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]
for k in range(3):
    grain((k * d, 0, 0), 1e-7, ice(), ((-1) ** k * 0.1, 0.01 * k, 0))
fused_engine()
O.run(50, True)
result["before"] = sorted(O.energy.keys())
b = O.bodies[1].state
b.blockedDOFs = "xY"
kept = b.vel[0]
y = b.vel[1]
first = total()
O.run(100, True)
result["kept"] = [kept, b.vel[0]]
result["moved"] = abs(b.vel[1] - y)
result["change"] = (total() - first) / energies()["kinetic"]
b.blockedDOFs = ""
O.run(20, True)
result["freed"] = abs(b.vel[0] - kept)
"""
    )
    assert "constraintWork" not in found["before"]
    assert found["kept"][0] == found["kept"][1] and found["moved"] > 0 and found["freed"] > 0
    assert abs(found["change"]) < 1e-2, found


def test_checkpoint_with_blocked_bodies_continues_to_the_bit(yade):
    found = yade(
        SCENE
        + """
piston(0.1)
O.engines = [JKRWadaEngine(subSteps=7)]
O.dt *= 7
O.run(40, True)
O.save("checkpoint.yade.bz2")
O.run(60, True)
straight = positions(), dict(O.energy.items())
O.load("checkpoint.yade.bz2")
O.run(60, True)
result["same"] = bool((positions() == straight[0]).all())
result["energies"] = [straight[1], dict(O.energy.items())]
"""
    )
    straight, again = found["energies"]
    assert found["same"] and straight["constraintWork"] != 0 and again == pytest.approx(straight, rel=1e-12)
