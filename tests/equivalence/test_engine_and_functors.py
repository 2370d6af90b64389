"""JKRWadaEngine against the functors (to rounding, step by step), and against itself: threads, instruction sets, checkpoints, sub-steps."""

import numpy as np
import pytest

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
KINDS = {"like": ([ice()], [1e-7]), "unlike": ([ice(), soft()], [1e-7, 1.6e-7, 1.3e-7]), "drag": ([ice(viscoelasticTime=2e-12)], [1e-7])}
def start(kind, count=27, seed=1, damping=0, limit="held"):
    new_scene(0.1 * unit, damping=damping, limit=limit)
    materials, radii = KINDS[kind]
    converging(count, seed, materials, radii)
"""


@pytest.mark.parametrize("limit", ["held", "cut"])
@pytest.mark.parametrize("kind", ["like", "unlike", "drag"])
def test_engine_and_functors_agree_step_by_step(yade, kind, limit):
    """27 grains fly together: contacts form, slip and break. Rounding grows as trajectories part; while events are few it stays near 1e-15 of a radius."""
    found = yade(
        SCENE
        + """
kind, limit = parameters["kind"], parameters["limit"]
start(kind, limit=limit)
functors, functor_energies = record(401)
start(kind)
fused_engine(limit=limit)
engine, engine_energies = record(400)
result["difference"] = np.abs(functors[:400] - engine).max(axis=(1, 2)) / 1e-7
# O.energy of the functors belongs to the positions before the step
names = [n for n in CHANNELS]
scale = functor_energies[0]["kinetic"]
result["energies"] = [max(abs(functor_energies[k + 1][n] - engine_energies[k][n]) for k in range(400)) / scale for n in names]
result["events"] = O.engines[0].statistics()["events"]
result["lost"] = engine_energies[-1]
""",
        {"kind": kind, "limit": limit},
    )
    assert found["events"] > 100
    assert found["lost"]["slidingDissipation"] > 0 and found["lost"]["connection"] > 0
    difference = np.array(found["difference"])
    assert difference[:100].max() < 1e-12, difference[:100].max()
    assert difference.max() < 1e-9, difference.max()
    assert max(found["energies"]) < 1e-9, found["energies"]


def test_grains_far_apart_meet_their_neighbours(yade):
    """Stragglers 10^5 radii away, many more cells apart than there are grains: those of the crowd find each other as they do without them."""
    found = yade(
        SCENE
        + """
def end(fused):
    start("like")
    for k in range(6):
        grain(1e-2 * np.eye(3)[k % 3] * (1 if k < 3 else -0.7), 1e-7, ice(), velocity=(0, 0, 20))
    if fused: fused_engine()
    O.run(300 + (not fused), True) # functors: O.energy belongs to the positions before the step
    return energies(), O.engines[0].statistics() if fused else {}
(functors, _), (engine, statistics) = end(False), end(True)
result["difference"] = max(abs(functors[name] - engine[name]) for name in CHANNELS) / engine["kinetic"]
result["statistics"] = {k: v for k, v in statistics.items() if k in ("events", "searches")}
"""
    )
    assert found["statistics"]["events"] > 50 and found["statistics"]["searches"] > 0, found
    assert found["difference"] < 1e-9, found


@pytest.mark.parametrize("kind,limit", [("like", "held"), ("unlike", "held"), ("drag", "held"), ("unlike", "cut")])
def test_same_bits_on_one_and_two_threads_and_on_every_run(yade, kind, limit):
    found = yade(
        SCENE
        + """
def end(threads):
    start(parameters["kind"], count=400)
    fused_engine(threads=threads, subSteps=10, limit=parameters["limit"])
    O.dt *= 10
    O.run(120, True)
    return positions(), energies(), O.engines[0].statistics()["events"]
runs = [end(1), end(2), end(1)]
result["same"] = [bool((runs[0][0] == r[0]).all() and runs[0][1] == r[1]) for r in runs[1:]]
result["events"] = runs[0][2]
""",
        {"kind": kind, "limit": limit},
    )
    assert found["same"] == [True, True] and found["events"] > 1000


@pytest.mark.parametrize("limit", ["held", "cut"])
def test_instruction_sets_agree_to_rounding(yade, limit):
    found = yade(
        SCENE
        + """
def run(instructions):
    start("like", count=27)
    fused_engine(instructions=instructions, limit=parameters["limit"])
    O.run(200, True)
result["differences"] = differences_of_instruction_sets(run)
""",
        {"limit": limit},
    )
    for name, difference in found["differences"].items():
        assert difference < 1e-11, name


@pytest.mark.parametrize(
    "kind,format,limit",
    [
        ("like", ".yade.bz2", "held"),
        ("unlike", ".xml.gz", "held"),
        ("drag", ".yade.gz", "held"),
        ("drag", ".yade", "cut"),
    ],
)
def test_checkpoint_continues_to_the_bit(yade, kind, format, limit):
    found = yade(
        SCENE
        + """
start(parameters["kind"], count=100)
fused_engine(subSteps=7, limit=parameters["limit"])
O.dt *= 7
O.run(40, True)
O.save("checkpoint" + parameters["format"])
O.run(60, True)
straight = positions(), energies()
O.load("checkpoint" + parameters["format"])
O.run(60, True)
again = positions(), energies()
result["same"] = bool((straight[0] == again[0]).all())
result["energies"] = [straight[1], again[1]]
""",
        {"kind": kind, "format": format, "limit": limit},
    )
    assert found["same"]
    straight, again = found["energies"]
    assert straight["slidingDissipation"] > 0
    assert again == pytest.approx(straight, rel=1e-12)


def test_sub_steps_are_steps(yade):
    """Ten O.steps of one small step, and one O.step of ten."""
    found = yade(
        SCENE
        + """
start("like"); fused_engine(); O.run(300, True); a = positions()
start("like"); fused_engine(subSteps=10); O.dt *= 10; O.run(30, True); b = positions()
result["difference"] = float(np.abs(a - b).max())
"""
    )
    assert found["difference"] == 0


def test_a_body_moved_by_the_script_is_noticed(yade):
    found = yade(
        SCENE
        + """
start("like", count=8)
fused_engine()
O.run(50, True)
O.bodies[3].state.vel = Vector3(1, 2, 3)
before = np.array(O.bodies[3].state.pos)
O.run(1, True)
result["moved"] = (np.array(O.bodies[3].state.pos) - before) / O.dt
"""
    )
    assert found["moved"] == pytest.approx([1, 2, 3], rel=0.3)


@pytest.mark.parametrize(
    "change,message",
    [
        (
            "O.bodies[2].state.vel = Vector3(float('nan'), 0, 0)",
            "body 2 has a position or velocity that is not a finite number",
        ),
        ("O.engines += [NewtonIntegrator()]", "NewtonIntegrator is among O.engines too; this engine replaces it"),
        ("O.engines[0].subSteps = 0", "subSteps = 0: must be >= 1"),
        ("O.engines[0].instructions = 'sse9'", "instructions = 'sse9': must be here"),
        (
            "O.periodic = True; O.cell.hSize = Matrix3(1, 0.1, 0, 0, 1, 0, 0, 0, 1)",
            "O.cell.hSize has the element (0, 1) = 0.1",
        ),
    ],
)
def test_what_cannot_be_done_is_refused_in_one_line(yade, change, message):
    found = yade(
        SCENE
        + f"""
start("like", count=8)
fused_engine()
{change}
result["message"] = refusal()
"""
    )
    assert message in found["message"] and "\\n" not in found["message"]
