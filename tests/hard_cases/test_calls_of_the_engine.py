"""Calls of JKRWadaEngine that find another scene, a running loop or a damaged checkpoint."""

import pytest
from changes import SCENE, refused

CALLS = ["e.writeInteractions()", "e.handOver()", "e.prepare()", "contact_law.snapshot()"]


def test_calls_after_a_body_was_erased_are_refused(yade):
    refused(
        yade,
        """
for case in parameters["cases"]:
    chain()
    for _ in range(20): O.step()
    e = engine()
    O.bodies.erase(1)
    result[case] = said(lambda: exec(case))
""",
        {case: ["body 1 was erased after the start"] for case in [*CALLS, "e.exportInteractions = True; O.step()"]},
    )


@pytest.mark.parametrize("away", ["O.reset()", "O.switchScene()", "O.reset(); chain()", "O.switchScene(); chain()"])
def test_an_engine_is_refused_in_another_scene(yade, away):
    refused(
        yade,
        """
for case in parameters["cases"]:
    chain()
    for _ in range(20): O.step()
    e = engine()
    exec(parameters["away"])
    O.engines = [e]
    result[case] = said(lambda: exec(case))
""",
        {case: ["another scene", "make a new one"] for case in [*CALLS, "O.step()"]},
        away=away,
    )


def test_interactions_that_a_script_erased_are_written_again(yade):
    """writeInteractions() writes all contacts, whatever was written and erased before; without it O.interactions are the script's own."""
    found = yade(
        SCENE
        + """
chain()
for _ in range(20): O.step()
for erase in ("O.interactions.erase(0, 1)", "O.interactions.clear()", "O.interactions.eraseNonReal()"):
    engine().writeInteractions()
    exec(erase)
    engine().writeInteractions()
    result.setdefault("contacts", []).append(O.interactions.countReal())
    exec(erase)
    O.step()
    result.setdefault("left", []).append(len(O.interactions))
"""
    )
    assert found["contacts"] == [3, 3, 3] and found["left"] == [0, 0, 0]


def test_two_scenes_with_an_engine_each(yade):
    found = yade(
        SCENE
        + """
chain()
for _ in range(40): O.step()
straight = positions()
chain()
for _ in range(20): O.step()
O.switchScene()
O.dt = 0.1 * unit
for k in range(3): grain((2.01e-7 * k, 0, 0), 1e-7, ice(), (-5 * k, 0, 0))
fused_engine()
for _ in range(20): O.step()
result["others"] = [len(O.bodies), engine().statistics()["contacts"]]
O.switchScene()
for _ in range(20): O.step()
result["same"] = bool((positions() == straight).all())
"""
    )
    assert found["same"] and found["others"][0] == 3


def test_calls_while_the_loop_runs_are_refused(yade):
    """Between O.run() and O.pause(); afterwards they do their work, though the last step may be under way still."""
    calls = [*CALLS, "e.statistics()", "O.save('while_running.yade')"]
    found = refused(
        yade,
        """
import time
for case in parameters["cases"]:
    new_scene(0.1 * unit)
    converging(125, 1, [ice()], [1e-7])
    fused_engine(subSteps=50)
    O.dt *= 50
    e = engine()
    # Once a scene, and not at once: with ForceResetter alone YADE itself now and then ends with SIGSEGV otherwise.
    O.run(-1)
    result[case] = said(lambda: exec(case))
    time.sleep(0.02)
    O.pause()
    if "handOver" not in case: result["at rest: " + case] = said(lambda: exec(case))
    O.wait()
    O.step()
""",
        {case: ["while O.run() is under way"] for case in calls},
    )
    assert not any(message for case, message in found.items() if case.startswith("at rest")), found


def test_a_snapshot_has_what_a_script_has_changed(yade):
    """Bodies as they are now, in arrays of the caller's own; a body that was given another state is refused."""
    found = yade(
        SCENE
        + """
chain()
for _ in range(20): O.step()
O.bodies[1].state.vel = Vector3(1, 2, 3)
O.bodies[2].state.pos += Vector3(0, 0, 1e-9)
shot = contact_law.snapshot()
result["velocity"] = shot["velocity"][1].tolist()
result["here"] = [row == list(b.state.pos) for row, b in zip(shot["position"].tolist(), O.bodies)]
result["ids"] = shot["ids"].tolist() == [b.id for b in O.bodies]
shot["position"] += 1.0
shot["contact_normal_force"][:] = 0
again = contact_law.snapshot()
result["own"] = bool((again["position"] < 1e-3).all()) and bool(again["contact_normal_force"].any())
O.bodies[2].state = State()
result["said"] = said(lambda: contact_law.snapshot())
"""
    )
    assert found["velocity"] == [1, 2, 3] and all(found["here"]) and found["ids"] and found["own"]
    assert "body 2 was given another state after the start" in found["said"]


def test_a_pyrunner_may_call_the_engine_while_the_loop_runs(yade):
    found = yade(
        SCENE
        + """
chain()
found = []
def look():
    engine().writeInteractions()
    found.append([O.interactions.countReal(), len(contact_law.snapshot()["contact_pairs"]), engine().statistics()["contacts"]])
    O.save("saved.yade")
O.engines += [PyRunner(command="look()", iterPeriod=5, initRun=False)]
O.run(20, True)
result["found"] = found
"""
    )
    assert len(found["found"]) >= 3 and all(row == [3, 3, 3] for row in found["found"])


def test_a_checkpoint_of_another_format_is_refused(yade):
    """Of as many numbers, but another header; and one that is cut off, or too long."""
    found = yade(
        SCENE
        + """
import re
chain()
for _ in range(20): O.step()
O.save("saved.xml")
saved = open("saved.xml").read()
head, numbers, tail = re.fullmatch(r"(.*<savedState>\\s*<count>)(.*)(</savedState>.*)", saved, re.S).groups()
items = re.findall(r"<item>.*?</item>", numbers)
def load(change):
    changed = list(items)
    change(changed)
    body = re.sub(r"^\\d+", str(len(changed)), re.sub(r"<item>.*</item>", lambda m: "".join(changed), numbers, flags=re.S))
    open("changed.xml", "w").write(head + body + tail)
    O.load("changed.xml")
    return said(O.step)
def first(k, value):
    def change(items): items[k] = f"<item>{value}</item>"
    return change
result["same"] = load(lambda items: None)
result["format"] = load(first(1, 99))
result["headless"] = load(first(0, 4))
result["short"] = load(lambda items: items.pop())
result["long"] = load(lambda items: items.append(items[-1]))
"""
    )
    assert found["same"] == ""
    assert "is of format 99, which another version wrote: it must be 6" in found["format"]
    assert "is of format 1, which another version wrote: it must be 6" in found["headless"]
    assert "cut off" in found["short"] and "too long" in found["long"], found
