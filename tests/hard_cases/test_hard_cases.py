"""Scenes that break careless codes, each with what must happen. Both ways of moving grains where that is quick."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade
BOTH = pytest.mark.parametrize("mover", ["fused", "functors"])


def closure(steps, every):
    """Largest change of the energy sum, over the first kinetic energy."""
    O.step()
    kinetic = energies()["kinetic"]
    return largest_change(steps // every, every=every) / kinetic


@BOTH
def test_impact_at_100_metres_a_second(mover):
    """Two clusters of 32 grains: overlaps of many delta0, slips of many limits in one step. The ledger closes, and
    better at a smaller step."""

    def impact(step):
        new_scene(step * unit, mover)
        random = np.random.default_rng(2)
        for side in (-1, 1):
            for k in range(32):
                site = np.array([k % 4, k // 4 % 4, k // 16]) * 2.01e-7 + 1e-9 * random.normal(size=3)
                grain(site + np.array([side * 4.6e-7 - 3e-7, 0, 0]), 1e-7, ice(), (-side * 50, 0, 0))
        return closure(int(40 / step), 1)

    coarse, fine = impact(0.05), impact(0.0125)
    assert coarse < 2e-2 and fine < coarse / 3


@BOTH
def test_grains_overlapping_far_beyond_contact_fly_apart_and_energy_stays(mover):
    new_scene(0.005 * unit, mover)
    for x, y in ((0, 0), (1.5e-7, 0), (0, 1.6e-7)):
        grain((x, y, 0), 1e-7, ice())
    O.run(1, True)
    first = total_energy()
    O.run(2000, True)
    assert energies()["kinetic"] > 0.5 * first > 0
    assert total_energy() == pytest.approx(first, rel=1e-3)


@BOTH
def test_size_ratio_ten(mover):
    """Dust of 0.1 um settling on a grain of 1 um with some speed: sticks, and the ledger closes."""
    new_scene(0.05 * unit, mover)
    grain((0, 0, 0), 1e-6, ice())
    random = np.random.default_rng(4)
    for k in range(12):
        n = random.normal(size=3)
        n /= np.linalg.norm(n)
        grain(1.103e-6 * n, 1e-7, ice(), -2 * n + 0.5 * random.normal(size=3), 1e7 * random.normal(size=3))
    assert closure(4000, 40) < 2e-3 and energies()["connection"] > 0


def unstable_step(damping, *pair, spring_damping=0):
    """MODEL.md, "Step limits" [s]."""
    c = constants(*pair, damping=damping)
    stiffness = max(3.5 * c["slidingStiffness"], 2.5 * c["rollingStiffness"])
    stiffness = max(stiffness, 2.5 * c["twistingStiffness"] / c["reducedRadius"] ** 2)
    ringing = 2 * (np.hypot(spring_damping, np.sqrt(c["reducedMass"] / stiffness)) - spring_damping)
    drag = c["dragPerContactRadius"] * c["equilibriumContactRadius"] + c["linearDrag"]
    of_drag = c["reducedMass"] / drag if drag else np.inf
    return min(0.5 * c["timeUnit"], of_drag, ringing if spring_damping else np.inf)


@BOTH
def test_a_step_that_is_unstable_for_damped_springs(mover):
    def touching():
        for x in (0, 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]):
            grain((x, 0, 0), 1e-7, ice())

    limit = unstable_step(0, ice(), 1e-7, spring_damping=1e-10)
    assert limit < 0.9 * unstable_step(0, ice(), 1e-7)
    assert refuses_from(limit, touching, mover=mover, spring_damping=1e-10)


def refuses_from(limit, make, **options):
    """Whether a scene, of make(), is refused a step right above the limit, and not one right below."""

    def refused(factor):
        new_scene(factor * limit, **options)
        make()
        return "of these grains is unstable" in refusal()

    return refused(1.001) and not refused(0.999)


@BOTH
@pytest.mark.parametrize("name, value", [("viscoelasticTime", 1e-9), ("surfaceEnergy", 10.0)])
def test_a_step_that_is_unstable_for_unlike_grains_only(mover, name, value):
    """A large grain makes the contact of a small one stiffer than among its like."""
    small, large = (ice(), 1e-7), (ice(**{name: value}), 1e-6)

    def touching():
        grain((0, 0, 0), 1e-6, large[0])
        grain((1.1e-6 - constants(*small, *large)["equilibriumOverlap"], 0, 0), 1e-7, small[0])

    limit = unstable_step(0, *small, *large)
    assert limit < 0.8 * min(unstable_step(0, *small, *small), unstable_step(0, *large, *large))
    assert refuses_from(limit, touching, mover=mover)


@pytest.mark.parametrize("damping", [0, 0.3])
def test_the_engine_refuses_from_the_least_limit_of_all_pairs_on(damping):
    """Of many radii; in every scene a pair of other grains has it."""
    random = np.random.default_rng(4)
    for _ in range(12):
        materials = [
            JKRMat(
                young=10 ** random.uniform(8, 11),
                poisson=0.25,
                density=10 ** random.uniform(2, 4),
                surfaceEnergy=10 ** random.uniform(-3, 1),
                criticalRolling=1e-9,
                viscoelasticTime=10 ** random.uniform(-13, -9) if k else 0,
            )
            for k in range(3)
        ]
        kinds = [(material, 1e-7 * 10 ** random.uniform(0, 1.5)) for material in materials for _ in range(5)]
        limit = min(unstable_step(damping, *one, *other) for one in kinds for other in kinds)

        def far_apart():
            for k, (material, radius) in enumerate(kinds):
                grain((1e-5 * k, 0, 0), radius, material)

        assert refuses_from(limit, far_apart, mover="fused", damping=damping)


def test_a_million_steps_at_rest():
    """A cluster at equilibrium, given a slow rigid rotation and drift: energy and angular momentum after a million
    steps are those of the start."""
    from yade_scripts import packings

    new_scene(0.1 * unit, "fused", subSteps=1000)
    c = constants(ice(), 1e-7)
    w = np.array([1e4, 2e4, -1e4])
    for x in packings.cpe(0.4, 4e-7, 1e-7, c["equilibriumOverlap"], 1, 0).position:
        grain(x, 1e-7, ice(), np.cross(w, x) + np.array([0.01, 0, 0]), w)
    O.run(1, True)
    (p0, l0), e0, kinetic = momenta(), total_energy(), energies()["kinetic"]
    O.run(1000, True)
    p1, l1 = momenta()
    assert np.linalg.norm(p1 - p0) < 1e-10 * np.linalg.norm(p0)
    assert np.linalg.norm(l1 - l0) < 1e-8 * np.linalg.norm(l0)
    assert abs(total_energy() - e0) < 1e-4 * kinetic
    assert sum(energies()[name] for name in LOST) < 1e-6 * c["pullOffForce"] * c["pullOffOverlap"]


@BOTH
def test_contacts_flickering_at_pull_off(mover):
    """A chain pulled apart again and again by its grains' vibration: many contacts form and break, all of them in
    the ledger."""
    new_scene(0.05 * unit, mover)
    random = np.random.default_rng(7)
    c = constants(ice(), 1e-7)
    for k in range(20):
        grain((k * (2e-7 + 0.5 * c["pullOffOverlap"]), 0, 0), 1e-7, ice(), (random.uniform(-8, 8), 0, 0))
    assert closure(8000, 20) < 2e-3
    assert energies()["disconnection"] > 10 * 4 / 45 * c["pullOffForce"] * c["pullOffOverlap"]
