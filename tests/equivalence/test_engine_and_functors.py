"""JKRWadaEngine against the functors, to rounding and step by step; sub-steps are steps."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade


@pytest.mark.parametrize("limit", ["held", "cut"])
@pytest.mark.parametrize("kind", ["like", "unlike", "drag"])
def test_engine_and_functors_agree_step_by_step(kind, limit):
    """27 grains fly together: contacts form, slip and break. Rounding grows as trajectories part; while events are
    few it stays near 1e-15 of a radius."""
    meeting(kind, limit=limit)
    functors = record(401)
    meeting(kind, mover="fused", limit=limit)
    engine = record(400)
    last = engine[1][-1]
    assert O.engines[0].statistics()["events"] > 100
    assert last["slidingDissipation"] > 0 and last["connection"] > 0
    difference, energy = compared(functors, engine)
    assert difference[:100].max() < 1e-12 and difference.max() < 1e-9 and max(energy.values()) < 1e-9


def test_grains_far_apart_meet_their_neighbours():
    """Stragglers 10^5 radii away, many more cells apart than there are grains: those of the crowd find each other as
    they do without them."""

    def end(mover):
        meeting("like", mover=mover)
        for k in range(6):
            grain(1e-2 * np.eye(3)[k % 3] * (1 if k < 3 else -0.7), 1e-7, ice(), velocity=(0, 0, 20))
        O.run(300 + (mover == "functors"), True)  # functors: O.energy belongs to the positions before the step
        return energies()

    functors, engine = end("functors"), end("fused")
    statistics = O.engines[0].statistics()
    assert statistics["events"] > 50 and statistics["searches"] > 0
    assert max(abs(functors[name] - engine[name]) for name in CHANNELS) < 1e-9 * engine["kinetic"]


def test_sub_steps_are_steps():
    """Ten O.steps of one small step, and one O.step of ten."""

    def end(number):
        meeting("like")
        engine_of_sub_steps(number)
        O.run(300 // number, True)
        return positions()

    assert (end(1) == end(10)).all()
