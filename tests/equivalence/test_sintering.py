"""contact_law.sinter() on running scenes: engine against functors step by step, against bonds made at the start, and
what is refused."""

import pytest
from refused import refused
from scenes import *

pytestmark = pytest.mark.in_yade


def start(kind="like", count=27, speed=20.0, periodic=False, grains=converging, **options):
    new_scene(0.05 * unit, **options)
    if periodic:
        periodic_cell(1e-5, 1e-5, 1e-5)
    grains(count, 1, *KINDS[kind], speed=speed)


def necks():
    return sorted(set(contact_law.snapshot()["contact_neck"].tolist()))


def run(steps, sinterings):
    """record(steps) with sinterings: {before step: neck}."""
    return record(steps, before=lambda k: k in sinterings and contact_law.sinter(sinterings[k]))


@pytest.mark.parametrize(
    "kind,speed,sinterings,options",
    [
        ("like", 20, {80: 0.5, 180: 0.3}, {}),
        ("unlike", 15, {80: 0.4, 178: 0.6}, {}),
        ("drag", 30, {80: 0.5, 178: 0.3}, {"limit": "cut"}),
        ("unlike", 15, {80: 0.4, 178: 0.6}, {"periodic": True}),
    ],
)
def test_engine_and_functors_agree_through_two_sinterings(kind, speed, sinterings, options):
    """Contacts of 27 grains that fly together become bonds, and later those that have formed since become bonds of
    another neck: two necks and ordinary contacts in one scene. The second-order part of `disconnection` that the
    functors leave out stays a constant."""
    start(kind, speed=speed, **options)
    functors, of_functors = run(301, sinterings), broken()
    start(kind, speed=speed, mover="fused", **options)
    engine, of_engine = run(300, sinterings), broken()
    assert necks() == [0, *sorted(sinterings.values())] and O.engines[0].neck == max(sinterings.values())
    assert sum(of_functors) > 8 and np.abs(np.subtract(of_functors, of_engine)).sum() <= 1
    (tracks, sums), (others, other_sums) = functors, engine
    # the engine's energies of a sintering moment are before the call, the functors' after it
    for step in sinterings:
        sums[step] = other_sums[step - 1]
    difference, energy = compared((tracks, sums), (others, other_sums), set(CHANNELS) - {"disconnection"})
    assert difference[:100].max() < 1e-11 and difference.max() < 1e-7 and max(energy.values()) < 1e-7
    before, first, still, second, last = (
        (sums[k + 1]["disconnection"] - other_sums[k]["disconnection"]) / sums[0]["kinetic"]
        for k in (78, 80, 176, 180, 299)
    )
    assert abs(before) < 1e-9 and abs(still - first) < 1e-7 and abs(last - second) < 1e-7
    assert 0 < abs(first) < 1e-2


def test_sintering_at_the_start_is_a_start_with_a_neck():
    start("unlike", grains=cluster, mover="fused", neck=0.4)
    bonded, e_bonded = run(150, {})
    start("unlike", grains=cluster, mover="fused")
    sintered, e_sintered = run(150, {0: 0.4})
    assert sum(broken()) > 3
    assert np.abs(bonded - sintered).max() < 1e-10 * 1e-7
    for c in set(CHANNELS) - {"disconnection"}:
        assert max(abs(a[c] - b[c]) for a, b in zip(e_bonded, e_sintered)) < 1e-9 * e_bonded[0]["kinetic"], c


def test_grains_placed_side_by_side_are_sintered():
    """Neighbours of a chain are two radii apart, but for rounding. (Ig2 doesn't find them.)"""
    new_scene(0.05 * unit, "fused", neck=0.4)
    for k in range(12):
        grain((k * 2e-7, 0, 0), 1e-7, ice())
    O.step()
    assert np.count_nonzero(contact_law.snapshot()["contact_neck"]) == 11


def test_sintered_twice_at_once_a_contact_keeps_the_first_neck():
    """With no step between, the second call finds bonds of the first already."""
    bonds = {}
    for mover in ("functors", "fused"):
        start(mover=mover)
        record(80)
        contact_law.sinter(0.3)
        contact_law.sinter(0.5)
        O.step()
        neck = contact_law.snapshot()["contact_neck"]
        bonds[mover] = np.count_nonzero(neck)
        owner = O.engines[0] if mover == "fused" else O.engines[2].physDispatcher.functors[0]
        assert set(neck[neck > 0].tolist()) == {0.3} and owner.neck == 0.5
        if mover == "functors":  # R' of the largest neck
            radii = [i.phys.constants.radius1 / 1e-7 for i in O.interactions if i.isReal]
            assert radii == pytest.approx([0.9806] * len(radii), rel=1e-4)
    assert bonds["functors"] == bonds["fused"] > 5


def test_grains_sintered_while_they_are_pressed_together_get_that_energy_back():
    """Contacts far beyond equilibrium hold more than their bonds do when these break: bondBreaking falls, all
    channels together stay, and the run goes on."""
    new_scene(0.02 * unit, "fused")
    converging(27, 0, [ice()], [1e-7], speed=25)
    record(62)
    before = energies()
    contact_law.sinter(0.2)
    _, sums = record(300)
    assert -min(e["bondBreaking"] for e in sums) > 0.2 * before["kinetic"]
    total = np.array([sum(e.values()) for e in sums])
    assert np.abs(total - sum(before.values())).max() < 1e-3 * before["kinetic"]


@pytest.mark.parametrize("mover", ["functors", "fused"])
def test_necks_that_cannot_be_and_steps_too_long_for_bonds_are_refused(mover):
    start(count=8, mover=mover)
    O.run(5, True)
    with refused((RuntimeError, ValueError), "sinter(): neck = ", "must be > 0 and up to 0.7"):
        contact_law.sinter(0.8)
    if mover == "fused":
        O.dt = 0.35 * unit
        with refused((RuntimeError, ValueError), "the small step O.dt/subSteps is"):
            contact_law.sinter(0.3)
        assert O.engines[0].neck == 0 and refusal() == ""
