"""A run that breaks down stops at once, names grain, contact and time, and leaves the last good state."""

import re

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade


def breaks_down(most):
    """What a run is stopped with within `most` O.steps, and the time [s] that it names; bodies and O.time are those
    before."""
    for _ in range(most):
        before, time, message = all_states(), O.time, refusal()
        if message:
            break
    assert message and "\n" not in message
    assert before == all_states() and time == O.time and refusal() == message
    assert f"O.bodies hold the last good state, of t = {time:.3g}"[:45] in message
    return message, float(re.search(r"broke down at t = (\S+) s", message).group(1))


@pytest.mark.parametrize(
    "step, drag, rate, expected",
    [
        (0.12, 30e-12, 3e7, "losses have given back"),  # below the limit for a pair, too long for a packing
        (0.49, 0, 1e9, "moves at"),  # hits at 600 m/s
    ],
)
def test_an_unstable_step_is_stopped_while_all_numbers_are_finite(step, drag, rate, expected):
    from yade_scripts import packings

    new_scene(step * unit)
    for x in packings.cpe(0.4, 6e-7, 1e-7, constants(ice(), 1e-7)["equilibriumOverlap"], 1, 0).position:
        grain(x, 1e-7, ice(viscoelasticTime=drag), -rate * x)
    engine_of_sub_steps(50)
    message, when = breaks_down(100)
    assert np.isfinite(positions()).all() and O.time < when <= O.time + O.dt * (1 + 1e-12)
    assert expected in message and re.search(r"body \d+", message)


@pytest.mark.parametrize("away", [1e-9, 0.0], ids=["close to", "onto, where the direction of the force is 0/0"])
def test_a_body_put_onto_another_is_noticed(away):
    new_scene(0.1 * unit)
    for k in range(5):
        grain((2.2e-7 * k, 0, 0), 1e-7, ice(), (0, 0.01 * (-1) ** k, 0))
    fused_engine()
    O.run(10, True)
    O.bodies[3].state.pos = O.bodies[1].state.pos + Vector3(away, 0, 0)
    message, _ = breaks_down(5)
    assert "body 1" in message and "body 3" in message


@pytest.mark.parametrize("mover", ["functors", "fused"])
@pytest.mark.parametrize("neck", [0, 0.3])
@pytest.mark.parametrize("apart, overlap", [(0.9e-7, "1.1"), (0.0, "2")])
def test_grains_that_overlap_too_far_at_the_start_are_refused(mover, neck, apart, overlap):
    new_scene(0.01 * unit, mover, neck=neck)
    for x in (0, 5e-7, 5e-7 + apart):
        grain((x, 0, 0), 1e-7, ice())
    message = refusal()
    assert f"body 1 and body 2 overlap by {overlap if not neck else ''}" in message and "must be at most 1" in message
    assert np.isfinite(positions()).all()


@pytest.mark.parametrize("mover", ["functors", "fused"])
@pytest.mark.parametrize("step", [0.4, 0.1, 0.05, 0.01])
@pytest.mark.parametrize("wall", [False, True])
def test_grains_that_pass_through_each_other_or_a_wall_are_refused_whatever_the_step(mover, step, wall):
    """At 3 km/s, with the engine in O.steps of seven small ones."""
    new_scene(step * unit, mover, **({"subSteps": 7} if mover == "fused" else {}))
    O.trackEnergy = False
    grain((0, 0, 0), 1e-7, ice(), (2000 if wall else 1500, 0, 0))
    if wall:
        O.bodies.append(utils.wall((2e-7, 0, 0), axis=0, material=ice()))
    else:
        grain((4.1e-7, 1e-9, 0), 1e-7, ice(), (-1500, 0, 0))
    message = refusal(int(3e-10 / O.dt) + 2)
    assert "\n" not in message and "body " in message
    assert ("more than half the smallest radius" if step == 0.4 else "of the smaller radius") in message


def cluster_of_12(**options):
    new_scene(0.1 * unit, "fused", **options)
    cluster(12, 1, [ice()], [1e-7], 3.0, 1e7)


def failure():
    """What a step is refused with in which a grain is far too fast; its velocity is then what it was."""
    kept = Vector3(O.bodies[0].state.vel)
    O.bodies[0].state.vel = Vector3(1e5, 0, 0)
    message = refusal()
    O.bodies[0].state.vel = kept
    return message


def test_after_a_failure_a_checkpoint_holds_the_last_good_state():
    """Bodies, contacts and energies; and nothing of the engine's arrays of an O.save long before the failure."""

    def contacts():
        return [(i.id1, i.id2, i.phys.twist, list(i.phys.slidingDisplacement)) for i in O.interactions]

    def end(saved_before):
        cluster_of_12(exportInteractions=True)
        O.run(30, True)
        if saved_before:
            O.save("early.yade.gz")
        O.run(200, True)
        good, message = (all_states(), contacts()), failure()
        assert "body 0 moves at 1e+05 m/s" in message and len(set(re.findall(r"body \d+", message))) > 1
        saved_and_loaded("good.yade.gz")
        assert (all_states(), contacts()) == good and len(good[1]) > 3
        O.run(50, True)
        return all_states(), energies()

    assert end(False) == end(True)
