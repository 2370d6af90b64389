"""From the functors to JKRWadaEngine and back in the middle of a run: trajectory and ledger continue as if nothing had been."""

import pytest

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
KINDS = {"like": ([ice()], [1e-7]), "unlike": ([ice(), soft()], [1e-7, 1.6e-7, 1.3e-7]), "drag": ([ice(viscoelasticTime=2e-12)], [1e-7])}
def start(kind, count=27, seed=1):
    new_scene(0.1 * unit)
    O.engines[2].loopOnSortedInteractions = True
    converging(count, seed, *KINDS[kind])
def to_engine(sub_steps=1, **options):
    fused_engine(subSteps=sub_steps, **options)
    O.dt *= sub_steps
def to_functors():
    O.engines[0].handOver()
    O.engines = functor_engines()
def state():
    return positions(), np.array([b.state.vel for b in O.bodies]), np.array([b.state.angVel for b in O.bodies])
def difference(a, b):
    return float(np.abs(a - b).max() / np.abs(b).max())
"""


@pytest.mark.parametrize("kind", ["like", "unlike", "drag"])
def test_functors_then_engine_then_functors_is_one_run(yade, kind):
    """A collision whose hundred steps in the middle are the engine's, in sub-steps. There are strained springs, and contacts that form and slip, in the middle."""
    first = 700 if kind == "unlike" else 100
    found = yade(
        SCENE
        + """
kind, first = parameters["kind"], parameters["first"]
start(kind)
O.run(first + 200, True)
straight, straight_energies, contacts = state(), energies(), O.interactions.countReal()

start(kind)
O.run(first, True)
result["contacts_taken_over"] = O.interactions.countReal()
to_engine(11)
O.run(9, True)
result["events"] = O.engines[0].statistics()["events"]
result["emptied"] = len(O.interactions)
to_functors()
result["moment"] = [O.time / O.dt, O.dt / (0.1 * unit)]
O.run(100, True)
switched, switched_energies = state(), energies()
result["steps"] = O.time / O.dt
result["differences"] = [difference(a, b) for a, b in zip(switched, straight)]
scale = straight_energies["kinetic"] + straight_energies["connection"]
result["energies"] = {n: (switched_energies[n] - straight_energies[n]) / scale for n in CHANNELS}
result["lost"] = straight_energies
result["contacts"] = [contacts, O.interactions.countReal()]
""",
        {"kind": kind, "first": first},
    )
    assert found["contacts_taken_over"] > 8 and found["events"] > 8 and found["emptied"] == 0
    assert found["moment"] == pytest.approx([first + 100, 1], rel=1e-12) and found["steps"] == pytest.approx(
        first + 200, rel=1e-12
    )
    assert found["lost"]["slidingDissipation"] > 0
    # with drag, grains whose contacts formed or broke in the functors' last step are taken over to second order only
    tolerance = 1e-6 if kind == "drag" else 1e-9
    assert max(found["differences"]) < tolerance, found["differences"]
    assert max(map(abs, found["energies"].values())) < tolerance, found["energies"]
    assert found["contacts"][0] == found["contacts"][1]


def test_a_saved_scene_of_the_functors_continues_with_the_engine(yade):
    found = yade(
        SCENE
        + """
start("unlike")
O.run(500, True)
O.save("functors.xml.bz2")
O.run(60, True)
straight = state()
O.load("functors.xml.bz2")
to_engine(6)
O.run(9, True)
result["contacts"] = O.engines[0].statistics()["contacts"]
to_functors()
O.run(5, True)
result["differences"] = [difference(a, b) for a, b in zip(state(), straight)]
"""
    )
    assert found["contacts"] > 8 and max(found["differences"]) < 1e-9, found


def test_an_engine_takes_over_from_an_engine_that_wrote_its_interactions(yade):
    """With another number of sub-steps, say. Everything is of one moment then; only impulses of events within the last small step are forgotten."""
    found = yade(
        SCENE
        + """
start("like")
to_engine(10, exportInteractions=True)
O.run(15, True)
O.run(15, True)
straight = positions()
start("like")
to_engine(10, exportInteractions=True)
O.run(15, True)
O.dt *= 1.5
O.engines = [JKRWadaEngine(subSteps=15)]
O.run(10, True)
taken = positions()
start("like")
to_engine(10)
O.run(15, True)
O.engines = [JKRWadaEngine(subSteps=10)]  # springs unstrained
O.run(15, True)
result.update(taken=difference(taken, straight), forgotten=difference(positions(), straight), left=len(O.interactions))
"""
    )
    assert found["taken"] < 1e-6 < found["forgotten"], found
    assert found["left"] == 0


def test_what_cannot_be_handed_over_is_refused(yade):
    found = yade(
        SCENE
        + """
start("like", count=8)
fused_engine()
try:
    O.engines[0].handOver()
except RuntimeError as error:
    result["message"] = str(error)
"""
    )
    assert "before the first step" in found["message"]
