"""What a script may change between two steps of JKRWadaEngine, and what follows."""

import pytest
from changes import *

pytestmark = pytest.mark.in_yade


@pytest.mark.parametrize("mover", ["fused", "functors"])
@pytest.mark.parametrize("by", [(0.3, 0, 0), (0, 0.3, 0), (0, 30.0, 0)])
def test_a_touching_body_may_be_moved(mover, by):
    """Its contacts break when they are torn apart, with either way of moving, and the grains stay where one can find
    them."""
    chain(mover=mover)
    steps(200)
    before = energies()
    O.bodies[3].state.pos += Vector3(*by) * 1e-7
    steps(200)
    pairs = contact_law.snapshot()["contact_pairs"].tolist()
    assert sorted(sorted(pair) for pair in pairs) == [[0, 1], [1, 2]] and np.isfinite(positions()).all()
    assert max(b.state.vel.norm() for b in O.bodies) < 1
    if by[1] == 0:  # pulled off along the normal
        c = constants(ice(), 1e-7)
        lost = energies()["disconnection"] - before["disconnection"]
        assert lost == pytest.approx(4 / 45 * c["pullOffForce"] * c["pullOffOverlap"], rel=0.05)


@pytest.mark.parametrize("mover", ["fused", "functors"])
@pytest.mark.parametrize("by", [(0.3, 0, 0), (0, 0.3, 0)])
def test_a_bonded_body_may_be_torn_away(mover, by):
    """Its bond is let go as it was: what it held is booked, to the first order of the step, and nothing is thrown."""

    def torn(step):
        new_scene(step * unit, mover, neck=0.3)
        for k in range(4):
            grain((k * 1.999e-7, 0, 0), 1e-7, O.bodies[0].material if k else ice(), (0, 0.1 * (-1) ** k, 0))
        steps(int(20 / step))
        before = energies()
        O.bodies[3].state.pos += Vector3(*by) * 1e-7
        O.step()
        bond = Ip2_JKRMat_JKRMat_JKRWadaPhys(neck=0.3).bondConstants(ice(), 1e-7, ice(), 1e-7)
        changes = {name: (value - before[name]) / bond["breakingEnergy"] for name, value in energies().items()}
        assert 0 < changes["bondBreaking"] < 1
        steps(int(20 / step))
        assert max(b.state.vel.norm() for b in O.bodies) < 1
        return abs(sum(changes.values()))

    coarse, fine = torn(0.1), torn(0.00625)
    assert fine < coarse / 4 < 1e-3


def test_ids_of_bodies_that_were_erased_are_left_out():
    """The run is that of a scene without them, with the ids of the others; what comes in later has the next id."""

    def end(with_erased):
        chain(5)
        x, speeds = positions(), [b.state.vel for b in O.bodies]
        new_scene(0.1 * unit)
        material = ice()
        for k in range(5):
            if k not in (0, 2) or with_erased:
                grain(x[k], 1e-7, material, speeds[k])
        for k in (0, 2) if with_erased else ():
            O.bodies.erase(k)
        fused_engine()
        steps(20)
        grain((0, 1e-6, 0), 1e-7, material)
        O.step()
        saved_and_loaded("gaps.yade")
        steps(20)
        return [b.id for b in O.bodies], contact_law.snapshot()

    (ids, with_gaps), (_, without) = end(True), end(False)
    assert ids == with_gaps["ids"].tolist() == [1, 3, 4, 5]
    for name in ("position", "velocity", "contact_pairs"):
        assert (with_gaps[name] == without[name]).all(), name


def test_a_body_wrapped_into_the_cell_keeps_its_contacts():
    """A script brings a touching grain back into the periodic cell: its contacts are with the nearest images, as
    before."""
    shift = 1.5e-6 * np.array([1, 0, -2])

    def end(wrapped):
        chain()
        periodic_cell(1.5e-6, 1.5e-6, 1.5e-6)
        steps(100)
        if wrapped:
            O.bodies[2].state.pos += Vector3(*shift)
        steps(100)
        x = positions()
        x[2] -= shift if wrapped else 0
        return x, energies()

    (x, e), (y, f) = end(False), end(True)
    assert np.abs(x - y).max() < 1e-9 * 1e-7
    assert max(abs(e[name] - f[name]) for name in LOST) < 1e-9 * e["kinetic"]


def test_energies_that_were_cleared_count_anew():
    """From O.energy.clear() on, as the functors'; what was lost before stays away."""

    def end(cleared):
        new_scene(0.1 * unit, "fused", subSteps=5)
        converging(27, 1, [ice(viscoelasticTime=1e-12)], [1e-7])
        O.run(40, True)
        before = energies()
        if cleared:
            O.energy.clear()
            saved_and_loaded()
        O.run(20, True)
        return before, energies()

    before, straight = end(False)
    _, anew = end(True)
    assert before["slidingDissipation"] > 0
    lost = {name: straight[name] - (before[name] if name in LOST else 0) for name in CHANNELS}
    assert anew == pytest.approx(lost, rel=1e-9, abs=1e-12 * lost["kinetic"])
