"""Between functors and JKRWadaEngine in a shrinking periodic cell; checkpoints there: equivalence/test_one_run.py."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade


def start(homo, drag, finer, rate=1e-3):
    new_scene(0.1 / finer * unit)
    random = np.random.default_rng(2)
    size = np.array([8.1e-7, 8.2e-7, 8.3e-7])
    periodic_cell(*size, homo=homo)
    for k in range(64):
        site = np.array([k % 4, k // 4 % 4, k // 16]) + 0.5 + 0.005 * random.normal(size=3)
        x = size * site / 4 + size * random.integers(-1, 2, size=3)
        grain(x, 1e-7, ice(viscoelasticTime=drag), 3 * random.normal(size=3), 2e7 * random.normal(size=3))
    O.cell.velGrad = Matrix3(-rate / unit, 0, 0, 0, -0.7 * rate / unit, 0, 0, 0, -0.4 * rate / unit)


@pytest.mark.parametrize("homo,drag", [(0, 0.0), (0, 2e-12), (1, 0.0), (2, 0.0)])
def test_functors_then_engine_then_functors_is_one_run_to_first_order(homo, drag):
    """Positions and velocities over the largest of each, at steps a factor 4 apart: first order gives 4.
    NewtonIntegrator keeps the velocity gradient that it gave the grains; a new one must get it (prevVelGrad)."""

    def end(finer, switched):
        start(homo, drag, finer)
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
