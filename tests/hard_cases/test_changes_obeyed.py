"""What a script may change between two steps of JKRWadaEngine, and what follows."""

import pytest
from changes import *

pytestmark = pytest.mark.in_yade


def flying_together(**options):
    """27 grains that collide, under the fused engine: five small steps each O.step."""
    new_scene(0.1 * unit, "fused", subSteps=5, **options)
    converging(27, 1, [ice(viscoelasticTime=1e-12)], [1e-7])


def close_to(energies, unit):
    return pytest.approx(energies, rel=1e-9, abs=1e-12 * energies[unit])


@pytest.mark.parametrize("orientations", [False, True])
def test_what_a_script_sets_after_loading_holds(orientations):
    """Velocities, positions, blocked degrees of freedom and orientations: as if they had been set in the run that
    was never saved."""

    def change():
        O.bodies[1].state.vel += Vector3(3, -1, 2)
        O.bodies[2].state.angVel += Vector3(1e7, 2e7, -1e7)
        O.bodies[3].state.pos += Vector3(1e-10, -1e-10, 3e-10)
        O.bodies[0].state.blockedDOFs = "xyZ"
        O.bodies[3].state.ori = Quaternion((0, 1, 0), 0.3)

    chain(subSteps=7, orientations=orientations)
    steps(20)
    O.save("saved.yade.gz")
    unchanged = all_states()
    change()
    assert all_states() != unchanged
    steps(20)
    straight = all_states(), energies()
    O.load("saved.yade.gz")
    assert all_states() == unchanged
    change()
    steps(20)
    assert all_states() == straight[0] and energies() == pytest.approx(straight[1], rel=1e-12)


def test_what_is_saved_before_the_next_step_is_not_lost():
    """What a script has set since the last step; and a checkpoint that is saved again before its first step, and
    goes on."""
    chain(subSteps=5)
    steps(10)
    O.bodies[1].state.vel = Vector3(3, -1, 2)
    O.forces.setPermF(1, Vector3(0, 1e-9, 0))
    O.save("straight.yade")
    steps(10)
    straight = positions()
    O.load("straight.yade")
    saved_and_loaded("saved.yade.gz")
    O.save("again.yade")
    steps(10)
    assert (positions() == straight).all()


@pytest.mark.parametrize("mover", ["fused", "functors"])
@pytest.mark.parametrize("by", [(0.3, 0, 0), (0, 0.3, 0), (0.02, 0, 0), (-8.0, 1.0, 0), (0, 30.0, 0)])
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
@pytest.mark.parametrize("by", [(0.3, 0, 0), (0, 0.3, 0), (0, 2.0, 0)])
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


def test_a_moved_body_leaves_its_neighbours_as_the_functors_have_it():
    """Torn away in a run with drag: the loss that is booked is the functors', to the first order of the step by
    which forces lag."""

    def torn(mover, step):
        chain(mover=mover)
        O.dt *= step
        for b in O.bodies:
            b.material.viscoelasticTime = 1e-12
        steps(int(20 / step))
        before = energies()
        O.bodies[3].state.pos += Vector3(0, 0.3e-7, 0)
        steps(int(20 / step))
        return positions(), energies()["disconnection"] - before["disconnection"]

    differences = []
    for step in (1.0, 0.25):
        (x, lost), (y, booked) = torn("functors", step), torn("fused", step)
        differences.append((np.abs(x - y).max() / 1e-7, abs(booked / lost - 1)))
    (moved, lost), (moved_less, lost_less) = differences
    assert moved_less < 0.5 * moved < 1e-2 and lost_less < 0.5 * lost < 1e-3


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


def test_energies_may_be_asked_for_late_or_with_a_pause():
    """O.trackEnergy switched on, off and on again, after loading: what O.energy then has is what it has when it was
    on all the time."""

    def end(tracked, load=False):
        flying_together()
        for k in range(60):
            O.trackEnergy = tracked(k)
            O.step()
            if load and k == 35:
                saved_and_loaded()
        O.trackEnergy = True
        engine().prepare()
        return energies()

    always = end(lambda k: True)
    assert always["slidingDissipation"] > 0 and always["disconnection"] > 0
    for tracked in (lambda k: k > 40, lambda k: k < 30 or k > 40, lambda k: k < 30):
        for load in (False, True):
            assert end(tracked, load) == close_to(always, "connection")


def test_energies_that_were_cleared_count_anew():
    """From O.energy.clear() on, as the functors'; what was lost before stays away."""

    def end(cleared):
        flying_together()
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
    assert anew == close_to(lost, "kinetic")


def test_a_slip_after_a_move_is_the_functors():
    """A grain that is moved within its contact, so far that it slips."""

    def lost(mover):
        chain(mover=mover)
        steps(200)
        before = energies()["slidingDissipation"]
        O.bodies[3].state.pos += Vector3(0, 2e-9, 0)
        steps(2)
        return energies()["slidingDissipation"] - before

    assert lost("fused") == pytest.approx(lost("functors"), rel=0.05) and lost("fused") > 0


def test_homo_deform_is_another_from_the_next_step_on():
    O.reset()
    periodic_cell(2e-6, 2e-6, 2e-6, homo=2, velocity_gradient=(-1e6, 0, 0))
    grain((3e-7, 1e-6, 1e-6), 1e-7, ice(), (1, 0, 0))
    O.dt = 0.1 * unit
    engine_of_sub_steps(100)
    steps(2)
    O.cell.homoDeform, before = 0, Vector3(O.bodies[0].state.vel)
    steps(1)
    assert O.bodies[0].state.vel[0] == pytest.approx(before[0], rel=1e-12)


@pytest.mark.parametrize("mover", ["fused", "functors"])
def test_steps_that_are_too_long_for_light_grains_are_refused(mover):
    new_scene(0.3 * unit, mover)
    d = 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]
    for k in range(2):
        grain((k * d, 0, 0), 1e-7, ice())
        O.bodies[k].state.mass *= 0.1
        O.bodies[k].state.inertia *= 0.1
    assert "must be above 0 and below" in message_of(lambda: steps(2))
