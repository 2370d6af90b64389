"""Another engine takes JKRWadaEngine's place, or grains are added, in the middle of a run: contacts are exported,
and the scene is read anew. No spring is lost.
(test_random_edits.py too.)"""

import pytest
from changes import *

pytestmark = pytest.mark.in_yade
SUCCESSORS = {"functors": functor_engines, "JKRWadaEngine": lambda: [JKRWadaEngine(subSteps=5)]}


def strained():
    """27 grains that have collided: springs are strained, slide and hold."""
    new_scene(0.1 * unit)
    converging(27, 1, [ice(viscoelasticTime=1e-12)], [1e-7])
    engine_of_sub_steps(5)
    steps(60)
    assert engine().statistics()["contacts"] > 20 and energies()["slidingDissipation"] > 0


@pytest.mark.parametrize("change", ["surfaceEnergy", "rolling"])
def test_what_a_change_brings_to_the_contacts_is_booked_once(change):
    """Other materials, or a mechanism left out: the sum of all energies stays, to the second order of the step that
    a leapfrog's kinetic energy has."""
    jumps = []
    for finer in (1, 4):
        strained()
        O.dt /= finer
        O.step()
        before, kinetic = total_energy(), energies()["kinetic"]
        if change == "surfaceEnergy":
            O.bodies[0].material.surfaceEnergy *= 1.2
        O.engines = [JKRWadaEngine(subSteps=5, rolling=change != "rolling")]
        engine().prepare()
        jumps.append(abs(total_energy() - before) / kinetic)
    assert jumps[0] < 2e-3 and jumps[1] < jumps[0] / 6 + 1e-12


def set_behind_the_back(engines):
    """As where contact_law is not imported (YADE_PREFIX): the plain setter of O.engines."""
    replace = type(O).engines.fset
    plain = next(cell.cell_contents for cell in replace.__closure__ if isinstance(cell.cell_contents, property))
    plain.fset(O, engines)


@pytest.mark.parametrize("place", [0, 1])
@pytest.mark.parametrize("new", SUCCESSORS)
def test_a_pyrunner_may_set_the_engines(new, place):
    """Standing before the engine, which makes this step yet, as behind it."""
    strained()

    def exchange():
        O.engines = SUCCESSORS[new]()
        O.dt /= 5 if "functor" in new else 1

    sys.modules["__main__"].exchange = exchange
    engines = [PyRunner(command="exchange()", iterPeriod=1, nDo=1, initRun=True), engine()]
    O.engines = engines if place == 0 else engines[::-1]
    O.step()
    assert "JKRWadaEngine" in new or O.interactions.countReal() > 20
    steps(20)
    assert len(contact_law.snapshot()["contact_pairs"]) > 20


HELD = ["the contacts of these grains are in another JKRWadaEngine"]
REFUSED = {
    "set_behind_the_back([JKRWadaEngine()]); O.step()": HELD,
    "set_behind_the_back(functor_engines()); steps(3)": HELD,
    "kept = engine(); kept.writeInteractions(); set_behind_the_back([JKRWadaEngine()]); O.step(); kept.prepare()": [
        "other engines have moved"
    ],
}


def test_what_would_lose_contacts_is_refused():
    def attempt(text):
        chain()
        steps(20)
        run(text, set_behind_the_back=set_behind_the_back)

    require_refused(REFUSED, attempt)


# ---- grains that are added ----


@pytest.mark.parametrize("periodic", [False, True])
def test_grains_that_are_added_meet_the_others(periodic):
    """A grain is shot at a vibrating chain in the middle of a run: as if it had been there, far away, from the
    start."""

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


# ---- what YADE's functions find ----


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
