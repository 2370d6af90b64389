"""Calls of JKRWadaEngine that find another scene, a running loop or a damaged checkpoint."""

import re
import time
from pathlib import Path

import pytest
from changes import *

pytestmark = pytest.mark.in_yade
CALLS = ["e.writeInteractions()", "e.prepare()", "contact_law.snapshot()"]


ELSEWHERE = ["O.reset()", "O.switchScene(); chain()"]
CHANGED = {"O.bodies.erase(1)": ["body 1 was erased after the start"]}
CHANGED |= {f"{away}; O.engines = [e]": ["another scene", "make a new one"] for away in ELSEWHERE}


@pytest.mark.parametrize("change", CHANGED)
def test_calls_after_a_body_was_erased_and_in_another_scene_are_refused(change):
    def attempt(text):
        chain()
        steps(20)
        run(f"{change}; {text}", e=engine())

    calls = [*CALLS, "O.step()", "e.exportInteractions = True; O.step()"]
    require_refused({call: CHANGED[change] for call in calls}, attempt)


def test_calls_while_the_loop_runs_are_refused():
    """Between O.run() and O.pause(); afterwards they do their work, though the last step may be under way still."""
    at_rest = {}

    def attempt(text):
        new_scene(0.1 * unit)
        converging(125, 1, [ice()], [1e-7])
        engine_of_sub_steps(50)
        e = engine()
        # Once a scene, and not at once: with ForceResetter alone YADE itself now and then ends with SIGSEGV otherwise.
        O.run(-1)
        message = message_of(lambda: run(text, e=e))
        time.sleep(0.02)
        O.pause()
        at_rest[text] = message_of(lambda: run(text, e=e))
        O.wait()
        O.step()
        if message:
            raise RuntimeError(message)

    calls = [
        *CALLS,
        "e.statistics()",
        "e.giveWay()",
        "O.engines = [JKRWadaEngine(subSteps=50)]",
        "O.save('while_running.yade')",
    ]
    require_refused({call: ["while O.run() is under way"] for call in calls}, attempt)
    assert not any(at_rest.values()), at_rest


def test_a_snapshot_has_what_a_script_has_changed():
    """Bodies as they are now, in arrays of the caller's own; a body that was given another state is refused."""
    chain()
    steps(20)
    O.bodies[1].state.vel = Vector3(1, 2, 3)
    O.bodies[2].state.pos += Vector3(0, 0, 1e-9)
    shot = contact_law.snapshot()
    assert shot["velocity"][1].tolist() == [1, 2, 3] and (shot["position"] == positions()).all()
    assert shot["ids"].tolist() == [b.id for b in O.bodies]
    shot["position"] += 1.0
    shot["contact_normal_force"][:] = 0
    again = contact_law.snapshot()
    assert (again["position"] < 1e-3).all() and again["contact_normal_force"].any()
    O.bodies[2].state = State()
    assert "the state of body 2 was changed" in message_of(contact_law.snapshot)


@pytest.mark.parametrize("name", ["savedState", "savedForces"])
def test_a_damaged_checkpoint_is_refused(name):
    """One number that is another, an index perhaps: of the engine's state, and of permanent forces."""
    chain()
    O.forces.setPermF(1, Vector3(1e-9, -2e-9, 0))
    steps(20)
    O.save("saved.xml")
    O.load("saved.xml")
    assert refusal() == ""
    text = Path("saved.xml").read_text()
    damaged = re.sub(
        rf"(<{name}>.*)<item>\S+</item>(\s*<item>\S+</item>\s*</{name}>)", r"\1<item>7</item>\2", text, flags=re.S
    )
    Path("damaged.xml").write_text(damaged)
    O.load("damaged.xml")
    assert damaged != text and "the checkpoint of the grains is damaged" in refusal()


def test_a_snapshot_with_the_functors_is_of_its_time():
    """Before the first step, and between two, when the bodies are a step further already."""
    new_scene(0.1 * unit)
    grain((0, 0, 0), 1e-7, ice(), (10, 0, 0))
    for step in range(3):
        snapshot = contact_law.snapshot()
        assert snapshot["position"][0, 0] == pytest.approx(10 * snapshot["time"], rel=1e-12)
        O.step()
    assert snapshot["time"] > 0
