"""A run that breaks down stops at once, names grain, contact and time, and leaves the last good state."""

import json
import re

import numpy as np
import pytest

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
def everything():
    return [[list(b.state.pos), list(b.state.vel), list(b.state.angVel), list(b.state.ori)] for b in O.bodies]
def step_until_it_fails(most):
    for result["steps"] in range(most):
        before, time = everything(), O.time
        try:
            O.step()
        except RuntimeError as error:
            result["message"] = str(error)
            break
    result.update(kept=before == everything(), time=O.time, same_time=time == O.time)
    result["again"] = refusal()
"""


def check(found):
    assert "\n" not in found["message"] and found["kept"] and found["same_time"], found
    assert f"O.bodies hold the last good state, of t = {found['time']:.3g}"[:45] in found["message"]
    assert found["again"] == found["message"]
    return float(re.search(r"broke down at t = (\S+) s", found["message"]).group(1))


@pytest.mark.parametrize(
    "case,expected",
    [
        ("0.12, 30e-12, 3e7", "losses have given back"),  # below the limit for a pair, too long for a packing
        ("0.49, 0, 1e9", "moves at"),  # hits at 600 m/s
    ],
)
def test_an_unstable_step_is_stopped_while_all_numbers_are_finite(yade, case, expected):
    found = yade(
        SCENE
        + f"""
from yade_scripts import packings
def hit(step, drag, rate):
    new_scene(step * unit)
    packing = packings.cpe(0.4, 6e-7, 1e-7, constants(ice(), 1e-7)["equilibriumOverlap"], 1, 0)
    for x in packing.position:
        grain(x, 1e-7, ice(viscoelasticTime=drag), -rate * x)
    fused_engine(subSteps=50)
    O.dt *= 50
hit({case})
step_until_it_fails(100)
result["dt"] = O.dt
result["finite"] = bool(np.isfinite(positions()).all())
"""
    )
    when = check(found)
    message = found["message"]
    assert (
        found["finite"] and expected in message and "contact" in message and len(re.findall(r"body \d+", message)) >= 2
    ), message
    assert found["time"] < when <= found["time"] + found["dt"] * (1 + 1e-12)


def test_a_body_put_onto_another_is_noticed(yade):
    found = yade(
        SCENE
        + """
new_scene(0.1 * unit)
for k in range(5):
    grain((k * 2.2e-7, 0, 0), 1e-7, ice(), (0.01 * k, 0, 0))
fused_engine()
O.run(10, True)
O.bodies[3].state.pos = O.bodies[1].state.pos + Vector3(1e-9, 0, 0)
step_until_it_fails(5)
"""
    )
    check(found)
    assert "body 1" in found["message"] and "body 3" in found["message"], found["message"]


def test_a_body_with_no_finite_position_is_named_with_its_contact(yade):
    """Exactly onto another's centre: the direction of the force is 0/0."""
    found = yade(
        SCENE
        + """
new_scene(0.1 * unit)
for k in range(5):
    grain((k * 2.2e-7, 0, 0), 1e-7, ice())
fused_engine()
O.run(10, True)
O.bodies[3].state.pos = O.bodies[1].state.pos
step_until_it_fails(5)
"""
    )
    check(found)
    assert "body 1" in found["message"] and "body 3" in found["message"] and "t = " in found["message"], found[
        "message"
    ]


def test_grains_that_overlap_too_far_at_the_start_are_refused(yade):
    found = yade(
        SCENE
        + """
new_scene(0.01 * unit)
for x in (0, 5e-7, 5.9e-7):
    grain((x, 0, 0), 1e-7, ice())
fused_engine()
result["message"] = refusal()
"""
    )
    assert "body 1 and body 2 overlap by 1.1 of the smaller radius at the start: must be at most 1" in found["message"]


def test_after_a_failure_a_checkpoint_holds_the_last_good_state(yade):
    found = yade(
        SCENE
        + """
new_scene(0.1 * unit)
c = constants(ice(), 1e-7)
for k in range(4):
    grain((k * (2e-7 - c["equilibriumOverlap"]), 0, 0), 1e-7, ice(), (0, 0.1 * (-1) ** k, 0))
fused_engine(exportInteractions=True)
O.run(30, True)
good, contacts = everything(), [(i.id1, i.id2, i.phys.twist, list(i.phys.slidingDisplacement)) for i in O.interactions]
O.bodies[0].state.vel = Vector3(1e5, 0, 0)
result["message"] = refusal()
O.bodies[0].state.vel = Vector3(good[0][1])
O.save("good.yade.gz")
O.load("good.yade.gz")
result["same"] = everything() == good and contacts == [(i.id1, i.id2, i.phys.twist, list(i.phys.slidingDisplacement)) for i in O.interactions]
O.run(10, True)
result["contacts"] = O.engines[0].statistics()["contacts"]
"""
    )
    assert "body 0 moves at 1e+05 m/s" in found["message"] and "body 1" in found["message"], found["message"]
    assert found["same"] and found["contacts"] == 3


def test_after_a_failure_a_checkpoint_holds_nothing_of_an_earlier_one(yade):
    """The engine's arrays of an O.save long before the failure are not those of the last good state."""
    found = yade(
        SCENE
        + """
def run(saved_before):
    new_scene(0.1 * unit)
    cluster(12, 1, [ice()], [1e-7], 3.0, 1e7)
    fused_engine(exportInteractions=True)
    O.run(30, True)
    if saved_before: O.save("early.yade.gz")
    O.run(200, True)
    kept = Vector3(O.bodies[0].state.vel)
    O.bodies[0].state.vel = Vector3(1e5, 0, 0)
    failed = refusal()
    O.bodies[0].state.vel = kept
    O.save("good.yade.gz")
    O.load("good.yade.gz")
    O.run(50, True)
    return everything(), energies(), failed
result["runs"] = [run(False), run(True)]
"""
    )
    assert "body 0 moves at 1e+05 m/s" in found["runs"][0][2]
    assert found["runs"][0] == found["runs"][1]


@pytest.mark.parametrize("engine", ["fused", "functors"])
def test_a_collision_that_fails_keeps_its_last_good_state(yade, tmp_path, engine):
    """collide.py with its own guard on the step switched off: exit status 1, the names in run.json, and the last sample before as the last state."""
    found = yade(
        """
import os, runpy
from yade_scripts import stability as checks
checks.step_limit = lambda constants, filling: 1.0
top = os.path.dirname(os.path.dirname(checks.__file__))
sys.argv = [os.path.join(top, "yade_scripts/collide.py"), "radius=4", "velocity=30", "duration=15e-9", "stepFraction=0.12", "viscoelasticTime=30e-12",
            "engine=" + parameters["engine"], "out=" + parameters["out"]]
try:
    runpy.run_path(sys.argv[0], init_globals={"O": O}, run_name="__main__")
except SystemExit as end:
    result["status"] = end.code
""",
        {"engine": engine, "out": str(tmp_path / "run")},
    )
    outcome = json.loads((tmp_path / "run" / "run.json").read_text())["outcome"]
    assert found["status"] == 1 and outcome.startswith("failed: ") and " s" in outcome, outcome
    assert len(re.findall(r"body \d+", outcome)) >= 2 or "none touch" in outcome, outcome
    times = np.load(tmp_path / "run" / "history.npz")["time"]
    states = sorted((tmp_path / "run" / "states").iterdir())
    last = np.load(states[-1])
    assert last["time"] == times[-1] and np.isfinite(last["position"]).all()
