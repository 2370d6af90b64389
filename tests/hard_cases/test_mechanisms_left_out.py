"""Scenes that leave sliding, rolling or twisting out: `sliding`, `rolling` and `twisting` of the law and the engine."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade
MODES = ("sliding", "rolling", "twisting")
SCENES = [(["sliding"], "held"), (["rolling"], "cut"), (["twisting"], "held"), (MODES, "cut")]


@pytest.mark.parametrize("left_out, limit", SCENES)
def test_engine_and_functors_agree_and_the_ledger_closes(left_out, limit):
    """27 grains fly together, in four ways: the ledger's error (root mean square) is of second order."""
    springs = dict.fromkeys(left_out, False)

    def fly(step, seed, mover="fused"):
        new_scene(step * unit, mover, limit=limit, **springs)
        converging(27, seed, [ice(), soft()], [1e-7, 1.6e-7])

    def error(step, seed):
        fly(step, seed)
        O.step()
        kinetic = energies()["kinetic"]
        return largest_change(1000, every=round(0.1 / step)) / kinetic

    fly(0.1, 1, "functors")
    functors, _ = record(401)
    fly(0.1, 1)
    engine, ledger = record(400)
    difference = np.abs(functors[:400] - engine).max(axis=(1, 2)) / 1e-7
    assert difference[:100].max() < 1e-12 and difference.max() < 1e-9
    for name in left_out:
        assert ledger[-1][f"{name}Dissipation"] == ledger[-1][name] == 0
    coarse, fine = (rms(error(step, seed) for seed in range(1, 5)) for step in (0.1, 0.025))
    assert coarse < 1e-3 and coarse > 9 * fine  # second order: 16, first: 4


@pytest.mark.parametrize("mover", ["functors", "fused"])
def test_grains_without_rolling_resistance_turn_on_each_other_without_end(mover):
    """Two unlike grains in contact that turn like gears, twice round: nothing slows them down and nothing is lost."""
    new_scene(0.1 * unit, mover, rolling=False)
    r1, r2, rate = 1e-7, 1.6e-7, 5e7
    overlap = constants(ice(), r1, ice(), r2)["equilibriumOverlap"]
    grain((0, 0, 0), r1, ice(), spin=(0, 0, rate))
    grain((r1 + r2 - overlap, 0, 0), r2, ice(), spin=(0, 0, -rate * r1 / r2))
    O.run(int(2 * 2 * np.pi / rate / O.dt), True)
    spins = np.array([b.state.angVel[2] / rate for b in O.bodies])
    assert np.abs(spins - [1, -1 / 1.6]).max() < 1e-3
    assert max(b.state.vel.norm() for b in O.bodies) < 1e-3 * rate * r1
    assert abs(energies()["slidingDissipation"]) < 1e-3 * energies()["kinetic"]


@pytest.mark.parametrize("wall", [False, True])
@pytest.mark.parametrize("change", ["functors", "functors to engine", "engine", "engine to functors"])
@pytest.mark.parametrize("left_out", [("sliding", "rolling"), ("twisting",)], ids="+".join)
def test_springs_that_come_in_later_have_no_strain(left_out, change, wall):
    """Grains that have turned on each other, or on a wall, far beyond the springs' limits: no spring pulls when it
    comes in, nothing was stored, and the others hold what they held (to the second order of their angles)."""
    without = dict.fromkeys(left_out, False)
    new_scene(0.1 * unit, "functors" if change.startswith("functors") else "fused", **without)
    second = O.bodies.append(utils.wall(0, axis=0, material=ice())) if wall else grain((0, 0, 0), 1e-7, ice())
    radius2 = float("inf") if wall else 1e-7
    c = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice(), 1e-7, ice(), radius2)
    grain(((1 if wall else 2) * 1e-7 - c["equilibriumOverlap"], 0, 0), 1e-7, ice(), blocked="xyzXYZ")
    O.bodies[second].state.blockedDOFs = "xyzXYZ"
    O.bodies[1].state.angVel = Vector3(1e9, 0, 2e9)
    steps(20)
    assert sum(energies()[name] + energies()[name + "Dissipation"] for name in left_out) == 0
    O.bodies[1].state.angVel = Vector3.Zero
    steps(2)
    before = energies()
    if change == "functors":
        for name in left_out:
            setattr(O.engines[2].lawDispatcher.functors[0], name, True)
    else:
        O.engines = functor_engines() if change.endswith("functors") else [JKRWadaEngine()]
    steps(3)
    after = energies()
    most = 1e-4 * c["pullOffForce"] * c["pullOffOverlap"]
    others = [name for name in MODES if name not in left_out]
    assert [after[name] for name in others] == pytest.approx([before[name] for name in others], rel=1e-3)
    assert all(abs(after[name]) + abs(after[name + "Dissipation"]) < most for name in left_out), after
