"""Grains that have flown apart are put into a new order, among other domains: nothing changes but the order in which forces are added.
Results do not depend on the number of threads, however many domains there are."""

import pytest

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
KINDS = {"like": ([ice()], [1e-7]), "unlike": ([ice(), soft()], [1e-7, 1.3e-7]), "drag": ([ice(viscoelasticTime=2e-12)], [1e-7])}
PUSH = Vector3(1e-12, 0, 2e-12)
def pairs_flying_apart(kind, neck=0, count=20):
    "Pairs about to touch, or bonded, which vibrate, roll, slide and twist; one grain of each third is held, of each fifth pushed."
    random = np.random.default_rng(5)
    new_scene(0.1 * unit, neck=neck)
    gap = -1e-10 if neck else 1e-10
    materials, radii = KINDS[kind]
    for k in range(count):
        a, b = materials[k % len(materials)], materials[-1]
        ra, rb = radii[k % len(radii)], radii[-1]
        place = 6e-7 * np.array([k % 3, k // 3 % 3, k // 9]) + 1e-8 * random.normal(size=3)
        normal = random.normal(size=3)
        normal /= np.linalg.norm(normal)
        fly = 30 * random.normal(size=3)
        grain(place, ra, a, fly + 0.1 * random.normal(size=3), 2e7 * random.normal(size=3))
        grain(place + (ra + rb + gap) * normal, rb, b, fly - 0.4 * normal, 2e7 * random.normal(size=3), "Y" if k % 3 == 0 else "")
        if k % 5 == 0: O.forces.setPermF(2 * k, PUSH)
"""


@pytest.mark.parametrize("kind, neck", [("like", 0), ("unlike", 0), ("drag", 0), ("like", 0.3), ("unlike", 0.3)])
def test_a_new_order_changes_nothing_but_rounding(yade, kind, neck):
    found = yade(
        SCENE
        + """
pairs_flying_apart(**parameters)
for body in O.bodies:  # velocities of half a step before
    if body.id % 10 == 0: body.state.vel -= 0.5 * O.dt / body.state.mass * PUSH
O.run(4101, True)
functors, functor_energies = positions(), energies()
pairs_flying_apart(**parameters)
fused_engine(domains=8, threads=2, neck=parameters["neck"])
O.run(4100, True)
engine, engine_energies = positions(), energies()
result["statistics"] = O.engines[0].statistics()
O.engines[0].handOver()
result["difference"] = np.abs(functors - positions()).max() / 1e-7
scale = engine_energies["kinetic"] + sum(abs(v) for v in engine_energies.values())
result["energies"] = {n: abs(functor_energies[n] - engine_energies[n]) / scale for n in CHANNELS if n != "kinetic"}  # test_blocked.py has the kinetic one
result["lost"] = engine_energies
""",
        {"kind": kind, "neck": neck},
    )
    assert found["statistics"]["orders"] >= 1
    assert (found["statistics"]["bonds"] > 10) == (neck > 0)
    assert neck > 0 or found["lost"]["slidingDissipation"] > 0
    assert found["difference"] < 1e-9, found["difference"]
    assert max(found["energies"].values()) < 1e-9, found["energies"]


@pytest.mark.parametrize("kind", ["like", "unlike", "drag"])
def test_same_bits_on_any_number_of_threads_and_after_a_checkpoint(yade, kind):
    found = yade(
        SCENE
        + """
def start(threads):
    new_scene(0.2 * unit)
    converging(300, 1, *KINDS[parameters["kind"]], speed=12.0)
    fused_engine(threads=threads, domains=8, subSteps=50)
    O.dt *= 50
def state():
    statistics = O.engines[0].statistics()
    return positions(), energies(), {k: statistics[k] for k in ("events", "formed", "orders", "domains")}
def end(threads):
    start(threads)
    O.run(30, True)
    if threads == 2: O.save("half.yade.gz")
    O.run(90, True)
    return state()
one = end(1)
others = [end(threads) for threads in (2, 3, 8)]
O.load("half.yade.gz")
O.engines[0].threads = 3
O.run(90, True)
others.append(state())
result["same"] = [bool((one[0] == other[0]).all()) and one[2] == other[2] for other in others]
result["energies"] = [one[1] == other[1] for other in others[:-1]]
result["statistics"] = one[2]
""",
        {"kind": kind},
    )
    assert found["statistics"]["orders"] >= 1 and found["statistics"]["domains"] == 8
    assert found["statistics"]["events"] > 1000
    assert found["same"] == [True] * 4
    assert found["energies"] == [True] * 3


def test_contacts_form_after_a_new_order(yade):
    """Dimers that meet only after the grains have been put into a new order: as many contacts as with the functors. Which rows
    touched in the old order says nothing of the grains in those rows now."""
    found = yade(
        SCENE
        + """
def dimers_flying_apart(count=60):
    "Two dimers each, which close at 2 m/s and touch after some 3,000 steps, while the groups of two fly apart."
    random = np.random.default_rng(7)
    new_scene(0.1 * unit)
    for k in range(count):
        place = 1.2e-6 * np.array([k % 4, k // 4 % 4, k // 16]) + 1e-8 * random.normal(size=3)
        fly = 4e7 * (place - 1.2e-6 * np.array([1.5, 1.5, 1.375]))  # from the middle: no group meets another one
        for side in (-1, 1):
            for place_in_dimer in (0, 1):  # beside each other in x at first, in y when the order is made anew
                at = place + np.array([side * 1.6e-7, side * 0.3e-7 + (place_in_dimer - 0.5) * (2e-7 - 1e-9), 0])
                grain(at, 1e-7, ice(), fly - np.array([side * 1.0, 0, 0]), np.zeros(3))
dimers_flying_apart()
fused_engine(domains=2, threads=1)
O.run(2900, True)
result["before"] = [O.engines[0].statistics()[name] for name in ("contacts", "orders")]
O.run(1600, True)
result["after"] = O.engines[0].statistics()["contacts"]
dimers_flying_apart()
O.run(4501, True)
result["functors"] = sum(i.isReal for i in O.interactions)
"""
    )
    assert found["before"][0] == 120 and found["before"][1] >= 1
    assert found["after"] == found["functors"] > 200
