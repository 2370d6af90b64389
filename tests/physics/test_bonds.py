"""Sintered bonds in YADE (functors): breaking of a pair against closed forms, the ledger and momenta of clusters that
break."""

from math import sin

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade
STORED = ("normal", "sliding", "rolling", "twisting")


def functor(neck):
    return Ip2_JKRMat_JKRMat_JKRWadaPhys(neck=neck)


def pair(neck, step, velocity=(0, 0, 0), spin1=(0, 0, 0), spin2=(0, 0, 0), blocked=""):
    """Two bonded grains along x; step in t0. Returns the bond's constants."""
    new_scene(step * unit, neck=neck)
    grain((0, 0, 0), 1e-7, ice(), spin=spin1, blocked=blocked)
    grain((1.99e-7, 0, 0), 1e-7, ice(), velocity, spin2, blocked=blocked)
    return functor(neck).bondConstants(ice(), 1e-7, ice(), 1e-7)


def distance():
    return np.linalg.norm(O.bodies[1].state.pos - O.bodies[0].state.pos)


# How a grain is moved against the other, which is held; the mode; its displacement after time t at unit rate.
DRIVEN = {
    "stretch": (dict(velocity=(1.0, 0, 0)), 0, lambda t: 1.0 * t, "normalStiffness"),
    "press": (dict(velocity=(-1.0, 0, 0)), 0, lambda t: 1.0 * t, "normalStiffness"),
    "slide": (dict(spin1=(0, 0, 1e7), spin2=(0, 0, 1e7)), 1, lambda t: 2e-7 * sin(1e7 * t), "slidingStiffness"),
    "roll": (dict(spin1=(0, 0, 1e7), spin2=(0, 0, -1e7)), 2, lambda t: 1e-7 * sin(1e7 * t), "rollingStiffness"),
    "twist": (dict(spin1=(1e7, 0, 0), spin2=(-1e7, 0, 0)), 3, lambda t: 2e7 * t, "twistingStiffness"),
}


@pytest.mark.parametrize("mode", DRIVEN)
@pytest.mark.parametrize("neck, shrunk", [(0.2, 0.99956), (0.6, 0.9575)])
def test_each_mode_breaks_for_good_at_its_breaking_energy(mode, neck, shrunk):
    """Two grains moved at given rates (all degrees of freedom blocked): the bond breaks in the step in which one mode's
    energy passes pi a^2 gamma, the books have what it held, and what is left is an ordinary contact of the shrunk
    grains if these overlap (beta = 0.2), and nothing if they don't (0.6)."""
    how, which, displacement, stiffness = DRIVEN[mode]
    b = pair(neck, 0.02, **how, blocked="xyzXYZ")
    sums = []
    while not sum(broken()) and O.iter < 20000:
        O.step()
        sums.append(energies())
    t = (O.iter - 1) * O.dt  # the positions that the law saw last
    before, after = (0.5 * b[stiffness] * displacement(at) ** 2 / b["breakingEnergy"] for at in (t - O.dt, t))
    assert before <= 1 + 1e-9 < 1 + 2e-9 <= after + 1e-9
    left = [i.phys for i in O.interactions if i.isReal]
    left = [(phys.bonded, phys.bond, phys.constants.radius1) for phys in left]
    assert broken() == [int(k == which) for k in range(4)]
    O.step()
    assert broken() == [int(k == which) for k in range(4)]
    assert sum(sums[-2][name] for name in STORED) == pytest.approx(b["breakingEnergy"], rel=0.1)
    stored = [sums[-1][name] for name in STORED]
    if neck == 0.2 and mode != "stretch":
        ((bonded, bond, radius),) = left
        assert not bonded and bond is None and radius == pytest.approx(shrunk * 1e-7, rel=1e-4)
        assert stored[0] < 0 and sum(map(abs, stored[1:])) < 1e-2 * b["breakingEnergy"]
    elif neck == 0.6:
        assert left == [] and stored == [0, 0, 0, 0]


def test_new_contacts_are_ordinary_and_of_shrunk_grains():
    """Two lone grains in a scene with necks: nothing at 2 R', sticking as JKR grains of radius R', unchanged mass."""
    new_scene(0.02 * unit, neck=0.6)
    grain((0, 0, 0), 1e-7, ice())
    grain((2.001e-7, 0, 0), 1e-7, ice(), (-2.0, 0, 0))
    touched = []
    while O.iter < 20000 and len(touched) < 50:
        O.step()
        touched += [(distance(), i.phys.bonded, i.phys.overlap) for i in O.interactions if i.isReal and i.phys.touching]
    c = functor(0.6).pairConstants(ice(), 1e-7, ice(), 1e-7)
    apart, bonded, overlap = touched[0]
    assert not bonded and broken() == [0, 0, 0, 0]
    assert c["radius1"] == pytest.approx(0.9575e-7, rel=1e-4)
    assert c["reducedMass"] == pytest.approx(O.bodies[0].state.mass / 2, rel=1e-12)
    assert 0 < overlap < 2.0 * 0.02 * 2e-10 and apart < 2 * c["radius1"]
    connection = 8 / 15 * 2 ** (2 / 3) * c["pullOffForce"] * c["pullOffOverlap"]
    assert energies()["connection"] == pytest.approx(connection, rel=1e-2)


@pytest.mark.parametrize("neck,speed", [(0.3, 10.0), (0.6, 30.0)])
def test_ledger_of_breaking_clusters_closes_with_second_order_and_momenta_stay(neck, speed):
    """Eight bonded grains that fly apart, bump into each other and break. Root mean square over six clusters of the
    largest closure error; second order gives 16."""
    breaks = 0

    def closure(step, seed):
        nonlocal breaks
        new_scene(step * unit, neck=neck)
        cluster(8, seed, [ice()], [1e-7], speed=speed, spin=1e7 * speed)
        O.run(1, True)
        before, kinetic = momenta(), energies()["kinetic"]
        worst = largest_change(round(40 / step)) / kinetic
        for was, now, scale in zip(before, momenta(), momentum_scales()):
            assert np.linalg.norm(now - was) < 2e-14 * np.sqrt(O.iter) * scale
        assert not sum(broken()) or energies()["bondBreaking"] > 0
        breaks += sum(broken())
        return worst

    coarse, fine = (rms(closure(step, seed) for seed in range(6)) for step in (0.1, 0.025))
    assert breaks > 30 and coarse < 2e-2 and coarse / fine > 9


def test_bonds_continue_from_a_checkpoint():
    def end():
        O.run(300, True)
        bonds = [(i.id1, i.id2, i.phys.bonded, i.phys.restDistance) for i in O.interactions if i.isReal]
        return positions().tolist(), sorted(bonds), energies()

    new_scene(0.05 * unit, neck=0.4)
    cluster(8, 3, [ice()], [1e-7], speed=10.0, spin=1e8)
    O.engines[2].loopOnSortedInteractions = True
    O.run(60, True)
    O.save("half.xml.gz")
    *straight, energy = end()
    O.load("half.xml.gz")
    *again, its_energy = end()
    assert straight == again and its_energy == pytest.approx(energy, rel=1e-12)
    assert any(bonded for _, _, bonded, _ in straight[1])
