"""What a script does to a scene between two steps of JKRWadaEngine: it is obeyed, or refused in one line that says what, where, and what it must be."""

import pytest

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
def chain(count=4, speed=0.1, **options):
    'Touching grains in a row that vibrate, under the fused engine.'
    new_scene(0.1 * unit)
    d = 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]
    for k in range(count):
        grain((k * d, 0, 0), 1e-7, ice() if k == 0 else O.bodies[0].material, (0, speed * (-1) ** k, 0))
    fused_engine(**options)
def said(call):
    'What a call is refused with, or an empty string.'
    try:
        call()
    except (RuntimeError, ValueError) as error:
        return str(error)
    return ""
def engine(): return O.engines[0]
"""


def refused(yade, script, cases, **parameters):
    """Each case (script text: words) is tried by the script, which leaves what it was refused with in result[case]: one line with these words in it."""
    found = yade(SCENE + script, {"cases": list(cases), **parameters})
    others = {
        case: found[case]
        for case, words in cases.items()
        if not found[case] or "\n" in found[case] or not all(word in found[case] for word in words)
    }
    assert not others, "\n".join(f"{case}: {message!r}" for case, message in others.items())
    return found


# ---- what may be changed: obeyed ----


@pytest.mark.parametrize("orientations", [False, True])
def test_what_a_script_sets_after_loading_holds(yade, orientations):
    """Velocities, positions, blocked degrees of freedom and orientations: as if they had been set in the run that was never saved."""
    found = yade(
        SCENE
        + """
def change():
    O.bodies[1].state.vel += Vector3(3, -1, 2)
    O.bodies[2].state.angVel += Vector3(1e7, 2e7, -1e7)
    O.bodies[3].state.pos += Vector3(1e-10, -1e-10, 3e-10)
    O.bodies[0].state.blockedDOFs = "xyZ"
    O.bodies[3].state.ori = Quaternion((0, 1, 0), 0.3)
def all_states():
    return [[list(b.state.pos), list(b.state.vel), list(b.state.angVel), b.state.blockedDOFs, list(b.state.ori)] for b in O.bodies]
chain(subSteps=7, orientations=parameters["orientations"])
O.dt *= 7
for _ in range(20): O.step()
O.save("saved.yade.gz")
unchanged = all_states()
change()
changed = all_states()
for _ in range(20): O.step()
straight = all_states(), energies()
O.load("saved.yade.gz")
result["loaded"] = all_states() == unchanged != changed
change()
for _ in range(20): O.step()
result["same"] = all_states() == straight[0]
result["energies"] = [straight[1], energies()]
""",
        {"orientations": orientations},
    )
    assert found["loaded"] and found["same"]
    assert found["energies"][1] == pytest.approx(found["energies"][0], rel=1e-12)


def test_a_change_before_saving_is_not_lost(yade):
    """Set after the last step, then saved, loaded and continued."""
    found = yade(
        SCENE
        + """
chain(subSteps=5)
O.dt *= 5
for _ in range(10): O.step()
O.bodies[1].state.vel = Vector3(3, -1, 2)
O.save("saved.xml.bz2")
for _ in range(10): O.step()
straight = positions()
O.load("saved.xml.bz2")
for _ in range(10): O.step()
result["same"] = bool((positions() == straight).all())
"""
    )
    assert found["same"]


def test_a_checkpoint_saved_again_before_the_first_step_is_the_same(yade):
    found = yade(
        SCENE
        + """
chain(subSteps=5)
O.dt *= 5
for _ in range(10): O.step()
O.save("once.yade.gz")
for _ in range(10): O.step()
straight = positions()
O.load("once.yade.gz")
O.save("twice.yade.gz")
O.load("twice.yade.gz")
for _ in range(10): O.step()
result["same"] = bool((positions() == straight).all())
"""
    )
    assert found["same"]


def test_an_engine_that_was_saved_and_handed_over_starts_from_the_functors(yade):
    found = yade(
        SCENE
        + """
def run(save):
    chain()
    e = engine()
    for _ in range(20): O.step()
    if save: O.save("saved.yade")
    for _ in range(20): O.step()
    e.handOver()
    O.engines = functor_engines()
    for _ in range(20): O.step()
    O.engines = [e]
    for _ in range(20): O.step()
    return positions()
result["same"] = bool((run(False) == run(True)).all())
"""
    )
    assert found["same"]


@pytest.mark.parametrize("mover", ["fused", "functors"])
@pytest.mark.parametrize("by", [(0.3, 0, 0), (0, 0.3, 0), (0.02, 0, 0), (-8.0, 1.0, 0), (0, 30.0, 0)])
def test_a_touching_body_may_be_moved(yade, mover, by):
    """Its contacts break when they are torn apart, with either way of moving, and the grains stay where one can find them."""
    found = yade(
        SCENE
        + """
chain()
if parameters["mover"] == "functors": O.engines = functor_engines()
for _ in range(200): O.step()
before = energies()
O.bodies[3].state.pos += Vector3(*parameters["by"]) * 1e-7
for _ in range(200): O.step()
shot = contact_law.snapshot()
pairs = sorted(sorted(p) for p in shot["contact_pairs"].tolist())
result.update(pairs=pairs, finite=bool(np.isfinite(positions()).all()), lost={n: energies()[n] - before[n] for n in LOST})
result["speed"] = max(b.state.vel.norm() for b in O.bodies)
c = constants(ice(), 1e-7)
result["unit"] = c["pullOffForce"] * c["pullOffOverlap"]
""",
        {"mover": mover, "by": by},
    )
    assert found["finite"] and found["pairs"] == [[0, 1], [1, 2]], found
    if by[1] == 0:  # pulled off along the normal
        assert found["speed"] < 1 and found["lost"]["disconnection"] == pytest.approx(4 / 45 * found["unit"], rel=0.05)


def test_a_moved_body_leaves_its_neighbours_as_the_functors_have_it(yade):
    """Torn away in the middle of a run with drag: the loss that is booked is the functors', to the first order of the one small step by which forces lag."""
    found = yade(
        SCENE
        + """
def run(mover, step):
    chain()
    O.dt *= step
    for b in O.bodies: b.material.viscoelasticTime = 1e-12
    if mover == "functors": O.engines = functor_engines()
    for _ in range(int(20 / step)): O.step()
    before = energies()
    O.bodies[3].state.pos += Vector3(0, 0.3e-7, 0)
    for _ in range(int(20 / step)): O.step()
    return positions(), energies()["disconnection"] - before["disconnection"]
for step in (1.0, 0.25):
    (x, lost), (y, booked) = run("functors", step), run("fused", step)
    result.setdefault("moved", []).append(float(np.abs(x - y).max() / 1e-7))
    result.setdefault("lost", []).append(booked / lost - 1)
"""
    )
    assert found["moved"][1] < 0.5 * found["moved"][0] < 1e-2, found
    assert abs(found["lost"][1]) < 0.5 * abs(found["lost"][0]) < 1e-3, found


def test_a_body_wrapped_into_the_cell_keeps_its_contacts(yade):
    """A script brings a touching grain back into the periodic cell: its contacts are with the nearest images, as before."""
    found = yade(
        SCENE
        + """
def run(wrapped):
    chain()
    O.periodic = True
    O.cell.setBox(1.5e-6, 1.5e-6, 1.5e-6)
    for _ in range(100): O.step()
    if wrapped: O.bodies[2].state.pos += Vector3(1.5e-6, 0, -3e-6)
    for _ in range(100): O.step()
    x = positions()
    if wrapped: x[2] -= np.array([1.5e-6, 0, -3e-6])
    return x, energies()
(x, e), (y, f) = run(False), run(True)
result.update(moved=float(np.abs(x - y).max() / 1e-7), lost=max(abs(e[n] - f[n]) for n in LOST), kinetic=e["kinetic"])
"""
    )
    assert found["moved"] < 1e-9 and found["lost"] < 1e-9 * found["kinetic"], found


def test_energies_may_be_asked_for_late_or_with_a_pause(yade):
    """O.trackEnergy switched on, off and on again, and after loading: what O.energy then has is what it has when it was on all the time."""
    found = yade(
        SCENE
        + """
def run(on, load=False):
    new_scene(0.1 * unit)
    converging(27, 1, [ice(viscoelasticTime=1e-12)], [1e-7])
    fused_engine(subSteps=5)
    O.dt *= 5
    for k in range(60):
        O.trackEnergy = on(k)
        O.step()
        if load and k == 35:
            O.save("paused.yade")
            O.load("paused.yade")
    return energies()
result["always"] = run(lambda k: True)
result["late"] = run(lambda k: k > 40)
result["paused"] = run(lambda k: k < 30 or k > 40)
result["loaded late"] = run(lambda k: k > 40, load=True)
"""
    )
    always = found.pop("always")
    assert always["slidingDissipation"] > 0 and always["disconnection"] > 0
    for name, energies in found.items():
        assert energies == pytest.approx(always, rel=1e-9, abs=1e-12 * always["connection"]), name


@pytest.mark.parametrize("tracked", ["functors", "both"])
def test_energies_after_the_functors_and_a_checkpoint(yade, tracked):
    """The functors' losses stay booked, and the engine's come on top, whether the engine was saved in between, or asked for energies at the end only."""
    found = yade(
        SCENE
        + """
def run(load):
    new_scene(0.1 * unit)
    converging(27, 1, [ice(viscoelasticTime=1e-12)], [1e-7])
    for _ in range(150): O.step()
    fused_engine(subSteps=5)
    O.dt *= 5
    O.trackEnergy = parameters["tracked"] == "both"
    for k in range(20):
        O.step()
        if load and k == 10:
            O.save("between.yade")
            O.load("between.yade")
    O.trackEnergy = True
    O.step()
    return energies()
result["runs"] = [run(False), run(True)]
""",
        {"tracked": tracked},
    )
    straight, loaded = found["runs"]
    assert straight["slidingDissipation"] > 0 and straight["connection"] > 0
    assert loaded == pytest.approx(straight, rel=1e-9, abs=1e-12 * straight["connection"])


def test_an_engine_that_is_dead_for_a_while_continues(yade):
    found = yade(
        SCENE
        + """
def run(pause):
    chain()
    for k in range(60):
        engine().dead = pause and 20 <= k < 40
        if not (not pause and k >= 40): O.step()
    return positions()
result["same"] = bool((run(True) == run(False)).all())
"""
    )
    assert found["same"]


def test_threads_may_change(yade):
    found = yade(
        SCENE
        + """
def run(threads):
    new_scene(0.1 * unit)
    converging(64, 1, [ice()], [1e-7])
    fused_engine()
    for k in range(100):
        engine().threads = threads(k)
        O.step()
    return positions()
result["same"] = bool((run(lambda k: 1) == run(lambda k: 1 + k // 10 % 2)).all())
"""
    )
    assert found["same"]


# ---- what may not: refused ----


CHANGES = {
    "O.bodies[2].shape.radius = 2e-7": ["the radius of body 2 was changed", "must stay"],
    "O.bodies[2].shape = Sphere(radius=1e-7)": ["body 2 was given another shape"],
    "O.bodies[2].state.mass *= 2": ["the mass of body 2 was changed", "must stay"],
    "O.bodies[2].state.inertia *= 2": ["the moment of inertia of body 2 was changed", "must stay"],
    "O.bodies[2].state.inertia = Vector3(I[0], I[1], 2 * I[2])": ["the moment of inertia of body 2 was changed"],
    "O.bodies[2].state = State()": ["body 2 was given another state"],
    "O.bodies[2].material = soft()": ["body 2 was given another material"],
    "O.bodies[2].mask = 2": ["the mask of body 2 was changed", "must stay 1, not 2"],
    "O.bodies[2].bounded = False": ["body 2: bounded or aspherical was changed"],
    "O.bodies[2].material.young = 1e9": ["young of the material of body 0 was changed", "must stay 7e+09"],
    "O.bodies[2].material.density = 2000": ["density of the material of body 0 was changed"],
    "O.bodies[2].material.surfaceEnergy = 0.2": ["surfaceEnergy of the material of body 0 was changed"],
    "O.bodies[2].material.viscoelasticTime = 1e-12": ["viscoelasticTime of the material of body 0 was changed", "must stay 0"],
    "engine().linearDamping = 0.5": ["linearDamping was changed", "must stay 0, not 0.5"],
    "engine().neck = 0.3": ["neck was changed"],
    "engine().sliding = False": ["sliding was changed", "must stay True, not False"],
    "engine().rolling = False": ["rolling was changed"],
    "engine().twisting = False": ["twisting was changed"],
    "engine().domains = 3": ["domains was changed", "must stay 2, not 3"],
    "engine().instructions = 'portable'": ["instructions was changed", "must stay ''"],
    "engine().orientations = True": ["orientations was changed"],
    "engine().subSteps = 2": ["the small step O.dt/subSteps was changed", "must stay"],
    "O.dt *= 0.5": ["the small step O.dt/subSteps was changed"],
    "O.periodic = True": ["O.periodic was changed"],
    "O.bodies.erase(1)": ["body 1 was erased after the start"],
    "O.bodies.erase(3)": ["body 3 was erased after the start"],
    "O.bodies.erase(1); O.bodies.insertAtId(utils.sphere((9e-7, 0, 0), 1e-7, material=ice()), 1)": ["body 1 was replaced by another"],
    "O.bodies.append(utils.sphere((9e-7, 0, 0), 1e-7, material=ice()))": ["there are 5 bodies, must be the 4 of the start"],
    "O.bodies.clear()": ["there are 0 bodies, must be the 4 of the start"],
    "O.bodies.clump([0, 1])": ["there are 5 bodies, must be the 4 of the start"],
    "O.bodies[1].state.vel = Vector3(float('nan'), 0, 0)": ["body 1 was given a position or velocity that is not a finite number"],
    "O.forces.addF(3, Vector3(0, 1e-9, 0))": ["O.forces has a force on body 3, (0, 1e-09, 0) N: it must be 0"],
    "O.forces.addT(0, Vector3(0, 1e-19, 0))": ["O.forces has a torque on body 0, (0, 1e-19, 0) N m: it must be 0"],
    "O.forces.setPermF(2, Vector3(1e-9, 0, 0))": ["O.forces has a force on body 2"],
    "O.forces.setPermT(2, Vector3(1e-19, 0, 0))": ["O.forces has a torque on body 2"],
    "O.engines = [GravityEngine(gravity=(0, 0, -10))] + O.engines": ["O.forces has a force on body 0"],
    "O.engines = [ForceResetter(), GravityEngine(gravity=(0, 0, -10))] + O.engines": ["O.forces has a force on body 0"],
    "O.engines += [NewtonIntegrator()]": ["NewtonIntegrator is among O.engines too"],
    "O.engines = [engine(), engine()]": ["O.engines has 2 JKRWadaEngines: there must be one"],
    "O.engines += [JKRWadaEngine()]": ["O.engines has 2 JKRWadaEngines: there must be one"],
    "engine().exportInteractions = True; O.step(); O.interactions.erase(0, 1)": ["O.interactions has 2 contacts, must be the 3"],
    "engine().exportInteractions = True; O.step(); O.interactions.clear()": ["O.interactions has 0 contacts, must be the 3"],
    "engine().threads = 0": ["threads = 0: must be >= 1"],
    "engine().linearDamping = float('nan')": ["linearDamping = nan: must be >= 0"],
}  # fmt: skip


def test_changes_in_the_middle_of_a_run_are_refused(yade):
    """At once, and again while the change stands; O.time stays as it was."""
    found = refused(
        yade,
        """
for case in parameters["cases"]:
    chain()
    for _ in range(20): O.step()
    I = O.bodies[2].state.inertia
    exec(case)
    time = O.time
    result[case] = said(O.step)
    result["again: " + case] = bool(said(O.step)) and O.time == time
""",
        CHANGES,
    )
    assert all(found["again: " + case] for case in CHANGES), found


CHANGES_AFTER_LOADING = {
    "O.bodies[2].shape.radius = 2e-7": ["the radius of body 2 is another than in the checkpoint: it must be 1e-07"],
    "O.bodies[2].state.mass *= 2": ["the mass of body 2 is another than in the checkpoint"],
    "O.bodies[2].state.inertia *= 2": ["the moment of inertia of body 2 is another than in the checkpoint"],
    "O.bodies[2].material = soft()": ["the number of materials is another than in the checkpoint: it must be 1"],
    "O.bodies[2].material.young = 1e9": ["young of material 0 is another than in the checkpoint: it must be 7e+09"],
    "engine().linearDamping = 0.5": ["linearDamping is another than in the checkpoint: it must be 0"],
    "engine().neck = 0.5": ["neck is another than in the checkpoint: it must be 0"],
    "engine().sliding = False": ["sliding is another than in the checkpoint: it must be 1"],
    "engine().domains = 3": ["domains is another than in the checkpoint: it must be 2"],
    "O.periodic = True": ["O.periodic is another than in the checkpoint: it must be 0"],
    "O.bodies.erase(1)": ["body 1 was erased"],
    "O.bodies.append(utils.sphere((9e-7, 0, 0), 1e-7, material=O.bodies[0].material))": ["the number of bodies is another than in the checkpoint: it must be 4"],
    "O.dt *= 0.5": ["the small step O.dt/subSteps was changed after the start"],
}  # fmt: skip


def test_changes_after_loading_are_refused(yade):
    refused(
        yade,
        """
chain()
for _ in range(20): O.step()
O.save("saved.yade")
for case in parameters["cases"]:
    O.load("saved.yade")
    exec(case)
    result[case] = said(O.step)
""",
        CHANGES_AFTER_LOADING,
    )


OUT_OF_RANGE = {
    "linearDamping=-1.0": ["linearDamping = -1: must be >= 0"],
    "linearDamping=float('nan')": ["linearDamping = nan: must be >= 0"],
    "linearDamping=float('inf')": ["linearDamping = inf: must be >= 0"],
    **{f"{name}={value}": [f"{name} = {value}: must be >= 1"] for name in ("subSteps", "threads", "domains") for value in (0, -3)},
}  # fmt: skip


def test_attributes_out_of_range_are_refused(yade):
    refused(
        yade,
        """
for case in parameters["cases"]:
    exec(f"chain({case})")
    result[case] = said(O.step)
""",
        OUT_OF_RANGE,
    )


SCENES = {
    "O.bodies[1].mask = 2": ["body 1: mask = 2, must be 1"],
    "O.bodies[1].bounded = False": ["body 1 must be bounded"],
    "O.bodies[1].state.inertia = Vector3(I[0], I[1], 2 * I[2])": ["body 1: its three moments of inertia must be the same"],
    "O.bodies.clump([0, 1])": ["body 4 must be a sphere of JKRMat"],
    "O.bodies.erase(1)": ["body 1 was erased"],
    "O.forces.setPermF(2, Vector3(1e-9, 0, 0))": ["O.forces has a force on body 2"],
}  # fmt: skip


def test_scenes_that_the_engine_cannot_move_are_refused_at_the_start(yade):
    refused(
        yade,
        """
for case in parameters["cases"]:
    chain()
    I = O.bodies[1].state.inertia
    exec(case)
    result[case] = said(O.step)
""",
        SCENES,
    )


# ---- calls that find another scene, or a running loop ----

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
for case in parameters["cases"]:
    new_scene(0.1 * unit)
    converging(125, 1, [ice()], [1e-7])
    fused_engine(subSteps=50)
    O.dt *= 50
    e = engine()
    for _ in range(5):
        O.run(-1)
        result[case] = said(lambda: exec(case))
        O.pause()
        if "handOver" not in case: result["at rest: " + case] = said(lambda: exec(case))
        O.wait()
    O.step()
""",
        {case: ["while O.run() is under way"] for case in calls},
    )
    assert not any(message for case, message in found.items() if case.startswith("at rest")), found


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
    assert "is of format 99, which another version wrote: it must be 3" in found["format"]
    assert "is of format 1, which another version wrote: it must be 3" in found["headless"]
    assert "cut off" in found["short"] and "too long" in found["long"], found
