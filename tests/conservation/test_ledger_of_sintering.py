"""Energy and momentum through contact_law.sinter(), and what is there after it: unstrained bonds, shrunk grains."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade
STORED = ("normal", "sliding", "rolling", "twisting")


def closure(step, seed, mover):
    """Largest change of the sum of energies over the first kinetic energy in 8 t0, with sintering at half of the time;
    what happens there is checked."""
    new_scene(step * unit, mover)
    cluster(8, seed, [ice()], [1e-7], speed=4.0, spin=3e7)
    record(2)
    first, kinetic, momentum = total_energy(), energies()["kinetic"], momenta()
    half = int(round(4 / step))
    _, sums = record(half)
    before = energies()
    contact_law.sinter(0.5)
    after = energies()
    if mover == "fused":  # which closes to rounding across the call itself, that takes what the contacts held
        assert abs(sum(after.values()) - sum(before.values())) < 1e-12 * kinetic
        assert [after[mode] for mode in STORED] == pytest.approx([0, 0, 0, 0], abs=1e-12 * kinetic)
        held, lost = sum(before[mode] for mode in STORED), after["disconnection"] - before["disconnection"]
        assert lost == pytest.approx(held, abs=2e-2 * kinetic)
        assert after["kinetic"] == pytest.approx(before["kinetic"], abs=2e-2 * kinetic)
    sums += record(half)[1]
    for was, now, scale in zip(momentum, momenta(), momentum_scales()):
        assert np.linalg.norm(now - was) < 2e-14 * np.sqrt(O.iter) * scale
    return max(abs(sum(one.values()) - first) for one in sums) / kinetic


@pytest.mark.parametrize("mover", ["functors", "fused"])
def test_ledger_closes_with_second_order_and_momenta_stay(mover):
    """Root mean square over six clusters of the largest closure error, at steps a factor 4 apart: second order gives
    16, first order 4."""
    coarse, fine = (rms(closure(step, seed, mover) for seed in range(6)) for step in (0.1, 0.025))
    assert coarse < 5e-3 and coarse / fine > 9


@pytest.mark.parametrize("mover", ["functors", "fused"])
def test_bonds_are_made_as_the_contacts_are_and_new_contacts_are_of_shrunk_grains(mover):
    """A pair out of equilibrium and turned against each other is at rest after sintering; a third grain then meets it
    at 2R', not at 2R."""

    def stop():
        for k in (0, 1):
            O.bodies[k].state.vel = O.bodies[k].state.angVel = Vector3.Zero

    def contacts():
        return len(contact_law.snapshot()["contact_pairs"])

    new_scene(0.05 * unit, mover)
    distance = 2e-7 - 0.3 * constants(ice(), 1e-7)["equilibriumOverlap"]
    grain((0, 0, 0), 1e-7, ice(), spin=(3e7, 2e7, 1e7))
    grain((distance, 0, 0), 1e-7, ice())
    grain((distance / 2, 2.2e-7, 0), 1e-7, ice(), velocity=(0, -2, 0))
    record(20)
    stop()
    contact_law.sinter(0.6)
    if mover == "functors":
        O.step()  # takes hold
        stop()
    place = positions()[:2]
    record(100)
    assert np.abs(positions()[:2] - place).max() < (1e-9 if mover == "fused" else 1e-5) * 1e-7
    assert contacts() == 1
    while contacts() == 1 and O.iter < 6000:
        O.step()
    x = positions()
    shrunk = Ip2_JKRMat_JKRMat_JKRWadaPhys(neck=0.6).pairConstants(ice(), 1e-7, ice(), 1e-7)["radius1"]
    touch = np.linalg.norm(x[2] - x[:2], axis=1).min()
    assert touch == pytest.approx(2 * shrunk, abs=2e-3 * 1e-7) and shrunk < 0.96e-7
