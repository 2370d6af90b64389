"""A script puts another engine in JKRWadaEngine's place, or adds grains, in the middle of a run: no spring is lost (test_random_edits.py too)."""

import pytest
from changes import *

pytestmark = pytest.mark.in_yade
STEPS = 60  # before and after the change
SUCCESSORS = {"functors": functor_engines, "JKRWadaEngine": lambda: [JKRWadaEngine(subSteps=5)]}


def strained():
    """27 grains that have collided: springs are strained, slide and hold."""
    new_scene(0.1 * unit)
    converging(27, 1, [ice(viscoelasticTime=1e-12)], [1e-7])
    engine_of_sub_steps(5)
    steps(STEPS)
    assert engine().statistics()["contacts"] > 20 and energies()["slidingDissipation"] > 0


def test_losses_of_engines_that_never_tracked_are_booked():
    strained()
    before = sum(energies().values())
    O.trackEnergy = False
    for k in range(2):
        O.engines = [JKRWadaEngine(subSteps=5)]
        steps(STEPS)
        grain((9e-7, 9e-7, 9e-7 + k * 3e-7), 1e-7, O.bodies[0].material)  # taken in by another run of the engine
        steps(1)
    O.engines = [JKRWadaEngine(subSteps=5)]
    O.trackEnergy = True
    steps(1)
    assert sum(energies().values()) == pytest.approx(before, rel=1e-2)


def test_the_functors_take_over_without_a_call():
    """Velocities are of the positions' moment, where the functors want those of half a step before: the difference is of first order."""
    differences = []
    for finer in (1, 4):
        ends = []
        for handed in (False, True):
            strained()
            O.dt /= 5 * finer
            engine().subSteps = 1
            if handed:
                engine().handOver()
            O.engines = functor_engines()
            steps(100 * finer)
            ends.append(positions())
        differences.append(np.abs(ends[0] - ends[1]).max() / 1e-7)
    assert differences[1] < 0.5 * differences[0] < 5e-3


def set_behind_the_back(engines):
    """As where contact_law is not imported (YADE_PREFIX): the plain setter of O.engines."""
    replace = type(O).engines.fset
    plain = next(cell.cell_contents for cell in replace.__closure__ if isinstance(cell.cell_contents, property))
    plain.fset(O, engines)


@pytest.mark.parametrize("place", [0, 1])
@pytest.mark.parametrize("new", SUCCESSORS)
def test_a_pyrunner_may_set_the_engines(new, place):
    """Standing before the engine, which makes this step yet, as behind it; a refused step in between changes nothing."""

    def end(place, refused=False):
        strained()
        old = engine()

        def exchange():
            O.engines = SUCCESSORS[new]()
            old.subSteps = 0 if refused else old.subSteps
            O.dt /= 5 if "functor" in new else 1

        sys.modules["__main__"].exchange = exchange
        runner = PyRunner(command="exchange()", iterPeriod=1, nDo=1, initRun=True)
        O.engines = [runner, old] if place == 0 else [old, runner]
        if refused:
            assert "subSteps = 0" in said(O.step)
            return None
        O.step()
        assert "JKRWadaEngine" in new or O.interactions.countReal() > 20
        steps(20)
        return contact_law.snapshot()["contact_pairs"].shape

    assert end(place)[0] > 20
    if place == 0:
        end(place, refused=True)
        steps(3)
        assert O.interactions.countReal() > 20 or engine().statistics()["contacts"] > 20


@pytest.mark.parametrize("place", ["in the PyRunner", "in the PyRunner, saved", "afterwards"])
@pytest.mark.parametrize("new", SUCCESSORS)
def test_a_pyrunner_that_raises_loses_no_contacts(new, place):
    """YADE does not come to the engine behind it in that step; nor after O.load, where the others are next."""
    strained()
    contacts = engine().statistics()["contacts"]

    def exchange():
        if "PyRunner" in place:
            O.engines = SUCCESSORS[new]()
        if "saved" in place:
            O.save("within.yade")
        raise ValueError("of a script")

    sys.modules["__main__"].exchange = exchange
    O.engines = [PyRunner(command="exchange()", iterPeriod=1, nDo=1, initRun=True), engine()]
    assert "of a script" in said(O.step)
    if place == "afterwards":
        O.engines = SUCCESSORS[new]()
    elif "saved" in place:
        O.load("within.yade")
    assert O.interactions.countReal() == contacts
    O.dt /= 5 if "functor" in new else 1
    steps(3)
    assert len(contact_law.snapshot()["contact_pairs"]) > 20


def test_an_engine_that_was_refused_in_another_scene_gives_way_in_its_own():
    chain()
    steps(20)
    e = engine()
    O.switchScene()
    grain((0, 0, 0), 1e-7, ice())
    O.engines = [e]
    assert "another scene" in said(O.step)
    O.switchScene()
    O.engines = functor_engines()
    assert O.interactions.countReal() == 3


def test_the_functors_take_a_loaded_scene_over():
    strained()
    contacts = engine().statistics()["contacts"]
    engine().writeInteractions()
    springs = sum(i.phys.slidingDisplacement.norm() for i in O.interactions)
    saved_and_loaded()
    O.engines = functor_engines()
    assert O.interactions.countReal() == contacts
    assert sum(i.phys.slidingDisplacement.norm() for i in O.interactions) == pytest.approx(springs, rel=1e-9)
    O.dt /= 5
    steps(20)


HELD = ["the contacts of these grains are in another JKRWadaEngine", "handOver()"]
REFUSED = {
    "O.engines[0].dead = True; O.engines += functor_engines(); O.engines[0].dead = False; O.step()": ["is among O.engines too"],
    "set_behind_the_back([JKRWadaEngine()]); O.step()": HELD,
    "set_behind_the_back(functor_engines()); steps(3)": HELD,
    "O.save('s.yade'); O.load('s.yade'); set_behind_the_back([JKRWadaEngine()]); O.step()": HELD,
    "kept = engine(); kept.writeInteractions(); set_behind_the_back([JKRWadaEngine()]); O.step(); kept.prepare()": ["other engines have moved"],
}  # fmt: skip


def test_what_would_lose_contacts_is_refused():
    def attempt(text):
        chain()
        steps(20)
        run(text, set_behind_the_back=set_behind_the_back)

    require_refused(REFUSED, attempt)


@pytest.mark.parametrize("periodic", [False, True])
def test_grains_that_are_added_meet_the_others(periodic):
    """A grain is shot at a vibrating chain in the middle of a run: as if it had been there, far away, from the start."""

    def end(late):
        chain(exportInteractions=periodic)
        if periodic:
            periodic_cell(3e-6, 3e-6, 3e-6, velocity_gradient=(0, 0, -1e5))
        bullet = lambda y: grain((2e-7, y, 0), 1e-7, O.bodies[0].material, (0, -2, 0))  # noqa: E731
        if not late:
            bullet(2.05e-7 + 2 * 40 * O.dt)
        steps(40)
        if late:
            bullet(2.05e-7)
        formed = engine().statistics()["formed"]
        steps(200)
        return positions(), energies(), engine().statistics()["formed"] - formed

    (x, e, formed), (y, f, formed_late) = end(False), end(True)
    assert formed == formed_late > 0 and np.abs(x - y).max() < 1e-7 * 1e-7
    assert abs(sum(e.values()) - sum(f.values())) < 1e-7 * e["kinetic"]


@pytest.mark.parametrize("call", ["O.save('within.yade')", "engine().prepare()", "engine().writeInteractions()"])
def test_a_pyrunner_may_append_a_grain_and_call_the_engine_in_a_cell_that_deforms(call):
    """Before the engine's turn the cell is a step ahead of the grains: as if nothing had been called."""

    def end(call):
        chain()
        periodic_cell(3e-6, 3e-6, 3e-6, velocity_gradient=(-1e5, 0, 0))

        def append():
            if O.iter == 5:
                grain((1e-6, 1e-6, 1e-6), 1e-7, O.bodies[0].material)
                exec(call.replace("engine()", "O.engines[1]"))

        sys.modules["__main__"].append = append
        O.engines = [PyRunner(command="append()", iterPeriod=1, initRun=True), engine()]
        steps(20)
        ends = [positions()]
        if "save" in call:
            O.load("within.yade")
            while O.iter < 20:
                O.step()
            ends.append(positions())
        return ends

    (straight,) = end("")
    for called in end(call):
        assert np.abs(called - straight).max() < 1e-12 * 1e-7


def test_counts_and_losses_go_on_when_grains_are_added():
    strained()
    O.trackEnergy = False
    before = engine().statistics()
    O.bodies.append(utils.sphere((9e-7, 9e-7, 9e-7), 1e-7, material=ice()))
    O.trackEnergy = True
    engine().prepare()
    after = engine().statistics()
    assert all(after[name] >= before[name] > 0 for name in ("contactUpdates", "events", "formed"))
    saved_and_loaded()
    engine().prepare()
    assert engine().statistics() == after


def test_yades_functions_have_contacts_and_forces():
    """unbalancedForce, stresses and the like are those of the functors, to the step by which they lag."""
    functions = {
        "unbalancedForce": lambda: utils.unbalancedForce(),
        "getStress": lambda: np.array(utils.getStress(1e-18)).ravel(),
        "bodyStressTensors": lambda: np.array([list(t.row(j)) for t in utils.bodyStressTensors() for j in range(3)]),
        "avgNumInteractions": lambda: utils.avgNumInteractions(),
        "sumForces": lambda: np.array(utils.sumForces([0, 1], (1, 1, 0))),
    }
    found = {}
    for mover in ("functors", "fused"):
        chain(mover=mover)
        O.dt /= 10
        steps(400)
        found[mover] = {name: function() for name, function in functions.items()}
    for name in functions:
        fused, functors = (np.asarray(found[mover][name]) for mover in ("fused", "functors"))
        assert np.abs(fused - functors).max() < 0.03 * np.abs(functors).max(), name
    assert found["fused"]["unbalancedForce"] > 0


def test_forces_that_were_written_are_not_taken_for_outside_ones():
    """The run's bits don't depend on whether anybody looked, with gravity, permanent forces and a script's addF among them."""

    def end(look):
        chain(exportInteractions=look == "export")
        O.engines = [GravityEngine(gravity=(0, 0, -1e7))] + O.engines
        O.forces.setPermF(1, (1e-10, 0, 0))
        for k in range(40):
            if look == "call":
                utils.unbalancedForce()
            O.forces.addF(2, (0, 1e-10 * (k % 3), 0))
            if k == 20:
                O.forces.setPermF(1, (0, 1e-10, 0))
            O.step()
        return positions()

    straight = end("")
    assert np.abs(end("call") - straight).max() < 1e-12 * 1e-7
    assert np.abs(end("export") - straight).max() < 1e-12 * 1e-7


def test_forces_of_the_grains_stand_in_o_forces():
    """After writeInteractions(): of contacts, and what others have put on the grains, as the functors leave them."""
    chain()
    O.forces.setPermF(1, (0, 0, 3e-10))
    steps(20)
    assert O.forces.f(0).norm() == 0
    engine().writeInteractions()
    total = sum((O.forces.f(b.id) for b in O.bodies), Vector3.Zero)
    assert O.forces.f(0).norm() > 1e-10 and (total - Vector3(0, 0, 3e-10)).norm() < 1e-20
    contacts = Vector3.Zero
    for i in O.interactions:
        force = i.phys.normalForce + i.phys.shearForce
        contacts += force * ((i.id2 == 1) - (i.id1 == 1))
    assert (O.forces.f(1) - contacts - Vector3(0, 0, 3e-10)).norm() < 1e-9 * contacts.norm()
