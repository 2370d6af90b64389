"""From the functors to JKRWadaEngine and back in the middle of a run: one run, but for an error of first order in
the functors' step."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade


def collided(kind, first, finer, switched):
    """(motion(), all energies, the kinetic one) after a collision; switched: of its last 4 t0 the first half is the
    engine's, by steps of the same length."""
    meeting(kind, step=0.1 / finer)
    O.run(first * finer, True)
    assert O.interactions.countReal() > 8 and energies()["slidingDissipation"] > 0
    if switched:
        engine_of_sub_steps(10)
        O.run(2 * finer, True)
        assert O.engines[0].statistics()["contacts"] > 8 and len(O.interactions) == 0
        O.engines = functor_engines()
        O.dt /= 10
    O.run((20 if switched else 40) * finer, True)
    return np.array(motion()), total_energy(), energies()["kinetic"]


@pytest.mark.parametrize("kind, first", [("like", 100), ("unlike", 700), ("drag", 100)])
def test_functors_then_engine_then_functors_is_one_run_to_first_order(kind, first):
    """Positions, velocities and spins, over the largest of each, at steps a factor 4 apart: first order gives 4. The
    sum of all energies stays as well."""

    def errors(finer):
        (straight, total, kinetic), (x, after, _) = (collided(kind, first, finer, s) for s in (False, True))
        moved = np.abs(x - straight).max(axis=(0, 2)) / np.abs(straight).max(axis=(0, 2))
        return moved, abs(after - total) / kinetic

    (coarse, lost), (fine, lost_less) = errors(1), errors(4)
    assert (coarse < 6e-2).all() and (fine < coarse / 3).all()
    assert lost < 3e-2 and lost_less < 7e-3


def test_a_saved_scene_of_the_functors_continues_with_the_engine():
    meeting("unlike")
    O.run(500, True)
    O.save("functors.xml.bz2")
    engine_of_sub_steps(6)
    O.run(9, True)
    straight = motion()
    O.load("functors.xml.bz2")
    engine_of_sub_steps(6)
    O.run(9, True)
    assert O.engines[0].statistics()["contacts"] > 8 and motion() == straight
