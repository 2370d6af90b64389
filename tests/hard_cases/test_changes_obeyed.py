"""What a script may change between two steps of JKRWadaEngine, and what follows."""

import pytest
from changes import SCENE


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
result["loaded in the pause"] = run(lambda k: k < 30 or k > 40, load=True)
"""
    )
    always = found.pop("always")
    assert always["slidingDissipation"] > 0 and always["disconnection"] > 0
    for name, energies in found.items():
        assert energies == pytest.approx(always, rel=1e-9, abs=1e-12 * always["connection"]), name


def test_energies_are_those_of_velocities_that_were_set_and_saved(yade):
    """A call that takes the change over stands between it and O.save, or none: O.energy after loading has what it has without."""
    found = yade(
        SCENE
        + """
def run(written, saved):
    new_scene(0.1 * unit)
    cluster(4, 1, [ice()], [1e-7], 1.0, 0)
    fused_engine(subSteps=5)
    O.dt *= 5
    O.run(5, True)
    for b in O.bodies:
        b.state.vel = 3 * b.state.vel
    if written: O.engines[0].writeInteractions()
    if saved:
        O.save("set.yade")
        O.load("set.yade")
    O.step()
    return energies()
result["straight"] = run(False, False)
result["others"] = [run(False, True), run(True, False), run(True, True)]
"""
    )
    for others in found["others"]:
        assert others == pytest.approx(found["straight"], rel=1e-9, abs=1e-12 * found["straight"]["kinetic"])


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
