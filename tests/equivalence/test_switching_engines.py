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


def in_a_cell(homo, drag, finer, rate=1e-3):
    new_scene(0.1 / finer * unit)
    random = np.random.default_rng(2)
    size = np.array([8.1e-7, 8.2e-7, 8.3e-7])
    periodic_cell(*size, homo=homo)
    for k in range(64):
        site = np.array([k % 4, k // 4 % 4, k // 16]) + 0.5 + 0.005 * random.normal(size=3)
        x = size * site / 4 + size * random.integers(-1, 2, size=3)
        grain(x, 1e-7, ice(viscoelasticTime=drag), 3 * random.normal(size=3), 2e7 * random.normal(size=3))
    O.cell.velGrad = Matrix3(-rate / unit, 0, 0, 0, -0.7 * rate / unit, 0, 0, 0, -0.4 * rate / unit)


@pytest.mark.parametrize("homo,drag", [(0, 2e-12), (2, 0.0)])
def test_in_a_shrinking_periodic_cell_too(homo, drag):
    """NewtonIntegrator keeps the velocity gradient that it gave the grains; a new one must get it (prevVelGrad)."""

    def end(finer, switched):
        in_a_cell(homo, drag, finer)
        O.run(150 * finer, True)
        if switched:
            fused_engine()
            O.run(20 * finer, True)
            assert O.engines[0].statistics()["contacts"] > 8
            O.engines = functor_engines()
            O.engines[3].prevVelGrad = O.cell.prevVelGrad
        O.run((20 if switched else 40) * finer, True)
        return np.array(motion()), O.cell.hSize[0, 0]

    def error(finer):
        (straight, size), (x, same) = (end(finer, switched) for switched in (False, True))
        assert same == pytest.approx(size, rel=1e-9)
        return np.abs(x - straight).max(axis=(0, 2))[:2] / np.abs(straight).max(axis=(0, 2))[:2]

    coarse, fine = error(1), error(4)
    assert (coarse < 0.25).all() and (fine < coarse / 3).all()
