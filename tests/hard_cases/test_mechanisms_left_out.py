"""Scenes that leave sliding, rolling or twisting out: `sliding`, `rolling` and `twisting` of the law and the engine."""

import itertools

import numpy as np
import pytest

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
"""
SPRINGS = [dict(zip(("sliding", "rolling", "twisting"), on)) for on in itertools.product((True, False), repeat=3)]


def named(springs):
    return "+".join(name for name, on in springs.items() if on) or "none"


@pytest.mark.parametrize("limit", ["held", "cut"])
@pytest.mark.parametrize("springs", SPRINGS[1:], ids=named)
def test_engine_and_functors_agree_and_the_ledger_closes(yade, springs, limit):
    """27 grains fly together, in four ways: the ledger's error (root mean square) is of second order."""
    found = yade(
        SCENE
        + """
def start(step, seed):
    new_scene(step * unit, limit=parameters["limit"], **parameters["springs"])
    converging(27, seed, [ice(), soft()], [1e-7, 1.6e-7])
def fused(step, steps, seed):
    start(step, seed)
    fused_engine(limit=parameters["limit"], **parameters["springs"])
    tracks, ledger = record(steps)
    total = [sum(one.values()) for one in ledger]
    return tracks, ledger[-1], np.max(np.abs(np.array(total) - total[0])) / ledger[0]["kinetic"]
start(0.1, 1)
functors, _ = record(401)
engine, result["lost"], _ = fused(0.1, 400, 1)
result["difference"] = np.abs(functors[:400] - engine).max(axis=(1, 2)) / 1e-7
result["closure"] = [
    np.sqrt(np.mean([fused(step, int(100 / step), seed)[2] ** 2 for seed in range(1, 5)])) for step in (0.1, 0.025)]
""",
        {"springs": springs, "limit": limit},
    )
    difference, closure = np.array(found["difference"]), found["closure"]
    assert difference[:100].max() < 1e-12 and difference.max() < 1e-9, difference.max()
    assert closure[0] < 1e-3 and closure[0] > 9 * closure[1], closure  # second order: 16, first: 4
    for name, on in springs.items():
        assert on or found["lost"][f"{name}Dissipation"] == 0, found["lost"]


@pytest.mark.parametrize("limit", ["held", "cut"])
@pytest.mark.parametrize("how", ["functors", "engine"])
def test_grains_without_rolling_resistance_turn_on_each_other_without_end(yade, how, limit):
    """Two unlike grains in contact that turn like gears, twice round: nothing slows them down and nothing is lost."""
    found = yade(
        SCENE
        + """
new_scene(0.1 * unit, rolling=False, limit=parameters["limit"])
r1, r2, rate = 1e-7, 1.6e-7, 5e7
grain((0, 0, 0), r1, ice(), spin=(0, 0, rate))
grain((r1 + r2 - constants(ice(), r1, ice(), r2)["equilibriumOverlap"], 0, 0), r2, ice(), spin=(0, 0, -rate * r1 / r2))
if parameters["how"] == "engine": fused_engine(rolling=False, limit=parameters["limit"])
O.run(int(2 * 2 * np.pi / rate / O.dt), True)
result["spins"] = [b.state.angVel[2] / rate for b in O.bodies]
result["speeds"] = [b.state.vel.norm() / (rate * r1) for b in O.bodies]
result["energies"] = energies()
""",
        {"how": how, "limit": limit},
    )
    energies = found["energies"]
    assert np.abs(np.array(found["spins"]) - [1, -1 / 1.6]).max() < 1e-3, found
    assert np.max(found["speeds"]) < 1e-3 and abs(energies["slidingDissipation"]) < 1e-3 * energies["kinetic"], found


@pytest.mark.parametrize("springs", SPRINGS[1:], ids=named)
def test_aggregates_collide(yade, springs):
    """Two BPCA aggregates of 200 grains at 25 m/s for 1,500 steps."""
    found = yade(
        SCENE
        + """
from yade_scripts import packings
new_scene(0.2 * unit)
for side in (-1, 1):
    aggregate = packings.bpca(200, 1e-7, constants(ice(), 1e-7)["equilibriumOverlap"], 2 + side)
    for x in aggregate.position - aggregate.position.mean(axis=0) + [side * 2.2e-6, 0, 0]:
        grain(x, 1e-7, ice(), (-12.5 * side, 0, 0))
fused_engine(subSteps=50, **parameters["springs"])
O.dt *= 50
O.step()
start, total = energies()["kinetic"], total_energy()
result["closure"] = []
for k in range(120):
    O.step()
    result["closure"].append((total_energy() - total) / start)
result["contacts"] = O.engines[0].statistics()["contacts"]
""",
        {"springs": springs},
    )
    assert np.abs(found["closure"]).max() < 4e-3, np.abs(found["closure"]).max()
