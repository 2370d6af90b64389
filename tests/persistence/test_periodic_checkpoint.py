"""Between functors and JKRWadaEngine in a shrinking periodic cell; checkpoints there: equivalence/test_one_run.py."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade


def start(homo, drag, rate=1e-3):
    new_scene(0.1 * unit)
    O.engines[2].loopOnSortedInteractions = True
    random = np.random.default_rng(2)
    size = np.array([8.1e-7, 8.2e-7, 8.3e-7])
    periodic_cell(*size, homo=homo)
    for k in range(64):
        site = np.array([k % 4, k // 4 % 4, k // 16]) + 0.5 + 0.005 * random.normal(size=3)
        x = size * site / 4 + size * random.integers(-1, 2, size=3)
        grain(x, 1e-7, ice(viscoelasticTime=drag), 3 * random.normal(size=3), 2e7 * random.normal(size=3))
    O.cell.velGrad = Matrix3(-rate / unit, 0, 0, 0, -0.7 * rate / unit, 0, 0, 0, -0.4 * rate / unit)


@pytest.mark.parametrize("homo,drag", [(0, 0.0), (0, 2e-12), (1, 0.0), (2, 0.0)])
def test_functors_then_engine_then_functors_is_one_run(homo, drag):
    """To rounding, with one small step in an O.step (with more, the engine's cell goes along chords of YADE's
    exponential). NewtonIntegrator keeps the velocity gradient that it gave the grains; a new one must be told
    (prevVelGrad)."""
    start(homo, drag)
    O.run(400, True)
    straight, contacts, size, work = (
        np.array(motion()),
        O.interactions.countReal(),
        O.cell.hSize[0, 0],
        O.energy["boundaryWork"],
    )
    start(homo, drag)
    O.run(200, True)
    fused_engine()
    O.run(99, True)
    assert O.engines[0].statistics()["events"] > 8
    O.engines[0].handOver()
    O.engines = functor_engines()
    O.engines[3].prevVelGrad = O.cell.prevVelGrad
    O.run(100, True)
    assert O.time / O.dt == pytest.approx(400, rel=1e-12) and O.cell.hSize[0, 0] == size
    assert O.interactions.countReal() == contacts > 8
    # with drag, grains whose contacts formed or broke in the functors' last step are taken over to second order only
    differences, scale = (np.abs(x).max(axis=(0, 2)) for x in (np.array(motion()) - straight, straight))
    assert np.all(differences < (1e-4 if drag else 1e-9) * scale)
    if homo < 2:  # the functors know nothing of the convective term's work
        assert O.energy["boundaryWork"] == pytest.approx(work, rel=1e-4)
