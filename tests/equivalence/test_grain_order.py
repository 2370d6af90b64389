"""Grains that have flown apart are put into a new order, among other domains: nothing changes but the order in which
forces are added."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade
PUSH = np.array([1e-12, 0, 2e-12])


def materials_and_radii(kind):
    return ([ice(), soft()], [1e-7, 1.3e-7]) if kind == "unlike" else KINDS[kind]


def pairs_flying_apart(kind, neck):
    """Pairs about to touch, or bonded, which vibrate, roll, slide and twist; one grain of each third is held, of
    each fifth pushed."""
    random = np.random.default_rng(5)
    new_scene(0.1 * unit, neck=neck)
    gap = -1e-10 if neck else 1e-10
    materials, radii = materials_and_radii(kind)
    for k in range(20):
        a, b = materials[k % len(materials)], materials[-1]
        ra, rb = radii[k % len(radii)], radii[-1]
        place = 6e-7 * np.array([k % 3, k // 3 % 3, k // 9]) + 1e-8 * random.normal(size=3)
        normal = random.normal(size=3)
        normal /= np.linalg.norm(normal)
        fly = 30 * random.normal(size=3)
        grain(place, ra, a, fly + 0.1 * random.normal(size=3), 2e7 * random.normal(size=3))
        other, held = place + (ra + rb + gap) * normal, "Y" if k % 3 == 0 else ""
        grain(other, rb, b, fly - 0.4 * normal, 2e7 * random.normal(size=3), held)
        if k % 5 == 0:
            O.forces.setPermF(2 * k, Vector3(*PUSH))


@pytest.mark.parametrize("kind, neck", [("like", 0), ("drag", 0), ("unlike", 0.3)])
def test_a_new_order_changes_nothing_but_rounding(kind, neck):
    pairs_flying_apart(kind, neck)
    for body in O.bodies:  # velocities of half a step before
        if body.id % 10 == 0:
            body.state.vel -= Vector3(*(0.5 * O.dt / body.state.mass * PUSH))
    O.run(4101, True)
    functors, of_functors = positions(), energies()
    pairs_flying_apart(kind, neck)
    fused_engine(domains=8, threads=2, neck=neck)
    O.run(4100, True)
    of_engine, statistics = energies(), O.engines[0].statistics()
    O.step()
    assert statistics["orders"] >= 1 and (statistics["bonds"] > 10) == (neck > 0)
    assert neck > 0 or of_engine["slidingDissipation"] > 0
    assert np.abs(functors - positions()).max() < 1e-9 * 1e-7
    scale = of_engine["kinetic"] + sum(map(abs, of_engine.values()))
    for name in set(CHANNELS) - {"kinetic"}:  # test_blocked.py has the kinetic one
        assert abs(of_functors[name] - of_engine[name]) < 1e-9 * scale, name
