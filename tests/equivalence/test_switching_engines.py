"""From the functors to JKRWadaEngine and back in the middle of a run: trajectory and ledger continue as if nothing had been."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade


def start(kind):
    meeting(kind)
    O.engines[2].loopOnSortedInteractions = True


def to_functors():
    O.engines[0].handOver()
    O.engines = functor_engines()


def difference_from(other):
    """The largest one of motion() from another, over the largest position, velocity or spin."""
    a, b = np.array(motion()), np.array(other)
    return (np.abs(a - b).max(axis=(0, 2)) / np.abs(b).max(axis=(0, 2))).max()


@pytest.mark.parametrize("kind, first", [("like", 100), ("unlike", 700), ("drag", 100)])
def test_functors_then_engine_then_functors_is_one_run(kind, first):
    """A collision whose hundred steps in the middle are the engine's, in sub-steps. There are strained springs, and contacts that form and slip, in the middle."""
    start(kind)
    O.run(first + 200, True)
    straight, straight_energies, contacts = motion(), energies(), O.interactions.countReal()
    start(kind)
    O.run(first, True)
    assert O.interactions.countReal() > 8
    engine_of_sub_steps(11)
    O.run(9, True)
    assert O.engines[0].statistics()["events"] > 8 and len(O.interactions) == 0
    to_functors()
    assert [O.time / O.dt, O.dt / (0.1 * unit)] == pytest.approx([first + 100, 1], rel=1e-12)
    O.run(100, True)
    assert O.time / O.dt == pytest.approx(first + 200, rel=1e-12)
    assert straight_energies["slidingDissipation"] > 0 and O.interactions.countReal() == contacts
    # with drag, grains whose contacts formed or broke in the functors' last step are taken over to second order only
    tolerance = 1e-6 if kind == "drag" else 1e-9
    assert difference_from(straight) < tolerance
    scale = straight_energies["kinetic"] + straight_energies["connection"]
    for name, energy in energies().items():
        assert abs(energy - straight_energies[name]) < tolerance * scale, name


@pytest.mark.parametrize("sub_steps", [1, 3, 10])
def test_a_pair_that_comes_apart_is_taken_over_in_every_step(sub_steps):
    """Beyond pull-off by less than a step, then in the step that broke the contact, then free; with the functors' step, and shorter ones."""

    def speed_after(steps):
        new_scene(0.2 * unit)
        grain((0, 0, 0), 1e-7, ice())
        grain((1.99e-7, 0, 0), 1e-7, ice(), (8, 0, 0))
        O.run(steps, True)
        a, b = positions()[:, 0]
        beyond, touching = b - a - 2e-7 > constants(ice(), 1e-7)["pullOffOverlap"], O.interactions.countReal()
        if steps < 12:
            fused_engine(subSteps=sub_steps)
            O.step()
        return O.bodies[1].state.vel[0] - O.bodies[0].state.vel[0], beyond, touching

    alone = speed_after(12)[0]
    # beyond pull-off the half kick of the functors' step has another length than the engine's: first order
    for steps, touching, tolerance in ((9, 1, 1e-9 if sub_steps == 1 else 0.03), (10, 0, 1e-9), (11, 0, 1e-9)):
        assert speed_after(steps) == (pytest.approx(alone, rel=tolerance), True, touching)


def test_a_saved_scene_of_the_functors_continues_with_the_engine():
    start("unlike")
    O.run(500, True)
    O.save("functors.xml.bz2")
    O.run(60, True)
    straight = motion()
    O.load("functors.xml.bz2")
    engine_of_sub_steps(6)
    O.run(9, True)
    assert O.engines[0].statistics()["contacts"] > 8
    to_functors()
    O.run(5, True)
    assert difference_from(straight) < 1e-9


def test_what_cannot_be_handed_over_is_refused():
    meeting("like", count=8)
    fused_engine()
    with pytest.raises(RuntimeError, match="before the first step"):
        O.engines[0].handOver()
