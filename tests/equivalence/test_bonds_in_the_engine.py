"""Sintered bonds in JKRWadaEngine: against the functors step by step, stability, rest."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade
NECK = 0.5


def start(kind="like", count=27, speed=20.0, mover="functors"):
    """A bonded cluster whose grains fly towards its middle."""
    new_scene(0.05 * unit, mover, neck=NECK)
    cluster(count, 1, *KINDS[kind], speed=speed, spin=1e7 * speed)
    for body in O.bodies:
        body.state.vel -= 0.5 * speed * body.state.pos / 2e-7


@pytest.mark.parametrize("kind", ["like", "unlike", "drag"])
def test_engine_and_functors_agree_step_by_step(kind):
    """27 bonded grains break up: bonds of every mode, contacts that form, slips. Rounding grows as trajectories
    part."""
    start(kind)
    functors, of_functors = record(301), broken()
    start(kind, mover="fused")
    engine, of_engine = record(300), broken()
    statistics, last = O.engines[0].statistics(), engine[1][-1]
    assert sum(of_engine) > 8 and np.abs(np.subtract(of_engine, of_functors)).sum() <= 1
    bonded = np.count_nonzero(contact_law.snapshot()["contact_bonded"])
    assert statistics["bonds"] == bonded == 26 - sum(of_engine)
    assert last["bondBreaking"] == pytest.approx(sum(statistics[f"{mode}Energy"] for mode in BROKEN_BONDS))
    assert last["connection"] > 0
    difference, energy = compared(functors, engine)
    assert difference[:100].max() < 1e-11 and difference.max() < 1e-8 and max(energy.values()) < 1e-8


def test_a_bonded_pair_is_unstable_right_above_the_limit():
    """The limit is 2 over the fastest vibration of two bonded grains. At beta = 0.5 that is sliding against turning,
    w^2 = k_st (2/m + 2 r^2/I) = 7 k_st/m (7 G > 2 E): the spins stay just below the limit, and grow without bound
    just above it where the law, which refuses that, is told a shorter step."""
    b = Ip2_JKRMat_JKRMat_JKRWadaPhys(neck=NECK).bondConstants(ice(), 1e-7, ice(), 1e-7)
    m = ice().density * 4 / 3 * np.pi * 1e-21

    def grow(factor, mover, told=None):
        limit = 2 * (m / 7 / b["slidingStiffness"]) ** 0.5
        new_scene(factor * limit, mover, neck=NECK)
        for x in (0, 1.99e-7):
            grain((x, 0, 0), 1e-7, ice(), spin=(0, 0, 1))
        if told:
            before, after = (
                PyRunner(command=f"O.dt = {step * limit!r}", iterPeriod=1, initRun=True) for step in (told, factor)
            )
            O.engines = [*O.engines[:2], before, O.engines[2], after, *O.engines[3:]]
        worst = 0
        for _ in range(300):
            O.step()
            worst = max(worst, abs(O.bodies[0].state.angVel[2]))
        return worst

    assert max(grow(0.985, mover) for mover in ("functors", "fused")) < 20
    assert grow(1.015, "functors", told=0.985) > 1e6
    for mover in ("functors", "fused"):
        with pytest.raises(RuntimeError, match="every packing of these grains is unstable"):
            grow(1.015, mover)


def test_bonded_grains_at_rest_stay_there():
    """All energies are rounding then, and no reason to stop the run."""
    start(count=60, speed=0.0)
    engine_of_sub_steps(50, neck=NECK)
    before = positions()
    record(20)
    assert np.abs(positions() - before).max() < 1e-12 * 1e-7
    assert O.engines[0].statistics()["bonds"] == 59
