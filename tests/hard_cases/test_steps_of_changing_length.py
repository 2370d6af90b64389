"""Steps whose length a script changes in the middle of a run of JKRWadaEngine."""

import numpy as np
import pytest
from changes import SCENE

STEPS = (
    SCENE
    + """
FACTORS = (1, 0.5, 2, 0.25, 1, 2) # of the small step, one after the other
def through(base, time, factors=FACTORS, each=lambda: None):
    'Go on for a time [t0], as many stretches as there are factors; base: the small step [t0].'
    for factor in factors:
        few = max(1, round(time / len(factors) / (base * factor)))
        engine().subSteps = few
        O.dt = time / len(factors) * unit
        O.step()
        each()
def unlike(base, time, change=lambda: None):
    'Go on for a time [t0] by small steps of which each has another length than the one before.'
    engine().subSteps = 1
    for k in range(3 * round(time / (1.75 * base))):
        O.dt = base * (1, 0.5, 0.25)[k % 3] * unit
        change()
        O.step()
def vibrating(kind, base):
    'Four touching grains that vibrate, without slip or event; the small step [t0]: base, shorter for bonds.'
    if kind == "bonds": base *= 0.25
    drag = 1e-12 if kind == "drag" else 0.0
    new_scene(base * unit)
    material = ice(viscoelasticTime=drag)
    d = 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]
    for k in range(4):
        grain((k * d, 0, 0), 1e-7, material, (0.02 * (-1) ** k, 0.002 * k, 0), (0, 1e4 * (-1) ** k, 0))
    if kind == "blocked": O.bodies[1].state.blockedDOFs = "xZ"
    if kind == "cell":
        O.periodic = True
        O.cell.setBox(4 * d, 8e-7, 8e-7)
        O.cell.velGrad = Matrix3(1e5, 0, 0, 0, -1e5, 0, 0, 0, 0)
    fused_engine(neck=0.3 if kind == "bonds" else 0.0)
    engine().prepare()
    if kind == "force":
        O.forces.setPermF(0, Vector3(2e-9, 1e-9, 0))
        O.forces.setPermT(1, Vector3(0, 0, 1e-17))
    return base
"""
)


@pytest.mark.parametrize("kind", ["free", "drag", "bonds", "blocked", "force", "cell"])
def test_trajectories_have_second_order(yade, kind):
    """Of the largest distance from a run of short equal steps, at steps a factor 2 apart: 4, and 2 if the kick between two steps were that of either."""
    found = yade(
        STEPS
        + """
def end(base, factors):
    through(vibrating(parameters["kind"], base), 24.0, factors)
    return np.array([list(b.state.pos) + list(1e-10 * b.state.vel) + list(1e-17 * b.state.angVel) for b in O.bodies])
reference = end(0.0025, (1,) * len(FACTORS)) # O.steps of the same length: by these YADE changes the cell
result["errors"] = [float(np.abs(end(base, FACTORS) - reference).max() / 1e-7) for base in (0.08, 0.04, 0.02)]
""",
        {"kind": kind},
    )
    coarse, middle, fine = found["errors"]
    assert coarse < 1e-3, found
    assert 3.4 < coarse / middle < 4.6 and 3.4 < middle / fine < 4.6, found


@pytest.mark.parametrize("kind", ["free", "drag"])
def test_every_step_may_have_another_length(yade, kind):
    """Second order still: drag, which is extrapolated from the velocities of two steps, knows how long each was."""
    found = yade(
        STEPS
        + """
def end(base, go):
    vibrating(parameters["kind"], base)
    go(base, 21.0)
    return positions()
reference = end(0.0025, lambda base, time: through(base, time, (1,)))
result["errors"] = [float(np.abs(end(base, unlike) - reference).max() / 1e-7) for base in (0.08, 0.04, 0.02)]
""",
        {"kind": kind},
    )
    coarse, middle, fine = found["errors"]
    assert coarse < 1e-3 and 3.4 < coarse / middle < 4.6 and 3.4 < middle / fine < 4.6, found


def test_contacts_form_and_break_in_steps_between_others(yade):
    """Two grains bounce off each other; every contact forms and breaks between two steps of unlike length. Energy over the one at the start, root mean square
    over 16 phases of the first touch within a step, at steps a factor 4 apart: while they touch (16), at the end (8: the last rise of the force, a square
    root, is summed for equal steps), and the largest change by that of the step alone (16)."""
    found = yade(
        STEPS
        + """
def run(base, phase):
    new_scene(base * unit)
    material, step, speed = ice(), base * unit, 20.0
    grain((0, 0, 0), 1e-7, material)
    grain((2e-7 + speed * step * (2 + 1.75 * phase), 0.3e-7, 0), 1e-7, material, (-speed, 0, 0), (0, 0, 3e7))
    fused_engine()
    engine().prepare()
    start, kinetic, jumps, errors = total_energy(), energies()["kinetic"], [], []
    def change():
        before = total_energy()
        errors.append(abs(before - start) / kinetic)
        engine().prepare()
        jumps.append(abs(total_energy() - before) / kinetic)
    unlike(base, 2.1, change)
    touching = max(errors), engine().statistics()["contacts"]
    unlike(base, 29.4, change)
    counts = engine().statistics()
    return touching[0], (total_energy() - start) / kinetic, max(jumps), touching[1], counts["formed"], counts["broken"]
for base in (0.16, 0.04):
    result[base] = [run(base, k / 16) for k in range(16)]
"""
    )
    coarse, fine = (np.array(runs) for runs in found.values())
    assert (coarse[:, 3:] == 1).all() and (fine[:, 3:] == 1).all()
    coarse, fine = (np.sqrt(np.mean(runs[:, :3] ** 2, axis=0)) for runs in (coarse, fine))
    assert (coarse < (5e-3, 2e-3, 1e-2)).all() and (coarse / fine > (9, 6, 10)).all(), (coarse, fine, coarse / fine)


@pytest.mark.parametrize("steps", [2, 3])
def test_no_contact_is_missed_when_steps_become_longer(yade, steps):
    """Twenty times: the neighbour lists reckon in steps. A checkpoint holds no lists, and goes on to the same bits."""
    found = yade(
        STEPS
        + """
def run(load):
    new_scene(0.02 * unit)
    converging(64, 3, [ice()], [1e-7], speed=8.0)
    fused_engine(subSteps=10)
    O.dt *= 10
    for _ in range(parameters["steps"]): O.step()
    formed = engine().statistics()["formed"]
    O.dt *= 20
    engine().prepare()
    if load:
        O.save("longer.yade.gz")
        O.load("longer.yade.gz")
    for _ in range(20): O.step()
    return positions(), engine().statistics()["formed"] - formed
(x, formed), (y, _) = run(False), run(True)
result.update(same=bool((x == y).all()), formed=formed)
""",
        {"steps": steps},
    )
    assert found["same"] and found["formed"] > 20, found


@pytest.mark.parametrize("kind", ["free", "bonds", "blocked", "force", "cell"])
def test_the_ledger_closes_in_every_kind_of_scene(yade, kind):
    """With the work of boundaries, of outside forces and of what holds grains: the largest deviation, at steps a factor 4 apart, 16."""
    found = yade(
        STEPS
        + """
def closure(base):
    base = vibrating(parameters["kind"], base)
    O.step()
    total = lambda: sum(energy for _, energy in O.energy.items())
    start, kinetic, found = total(), sum(b.state.mass * b.state.vel.squaredNorm() / 2 for b in O.bodies), []
    for _ in range(2): through(base, 12.0, each=lambda: found.append(abs(total() - start)))
    return max(found) / kinetic
result["closures"] = [closure(base) for base in (0.08, 0.02)]
""",
        {"kind": kind},
    )
    coarse, fine = found["closures"]
    assert fine < coarse < 0.05 and coarse / fine > 10, found


@pytest.mark.parametrize("drag", [0.0, 2e-12])
def test_the_ledger_closes_with_second_order(yade, drag):
    """While contacts form, slip and break: root mean square over six scenes, at steps a factor 4 apart (16; order 3/2 gives 8, first order 4)."""
    found = yade(
        STEPS
        + """
def closure(base, seed):
    new_scene(base * unit)
    converging(27, seed, [ice(viscoelasticTime=parameters["drag"])], [1e-7])
    fused_engine()
    engine().prepare()
    start, kinetic, worst = total_energy(), energies()["kinetic"], [0.0]
    for _ in range(12):
        through(base, 30.0, each=lambda: worst.append(abs(total_energy() - start) / kinetic))
    return max(worst), energies()["connection"], energies()["disconnection"], energies()["rollingDissipation"]
for base in (0.1, 0.025):
    result[base] = [closure(base, seed) for seed in range(6)]
""",
        {"drag": drag},
    )
    coarse, fine = (np.array(scenes) for scenes in found.values())
    assert (coarse.sum(axis=0) > 0).all() and (fine.sum(axis=0) > 0).all()  # there were such events
    coarse, fine = (np.sqrt(np.mean(scenes[:, 0] ** 2)) for scenes in (coarse, fine))
    assert coarse < 2e-3, (coarse, fine)
    assert coarse / fine > (6 if drag else 9), (coarse, fine)


def test_results_are_the_same_on_any_threads_and_after_a_checkpoint(yade):
    found = yade(
        STEPS
        + """
def run(threads, save):
    new_scene(0.1 * unit)
    converging(64, 1, [ice(viscoelasticTime=1e-12)], [1e-7])
    fused_engine(threads=threads)
    for k in range(10):
        if save and k in (4, 7):
            O.save("changing.yade.gz")
            O.load("changing.yade.gz")
            engine().threads = threads
        through(0.1, 20.0)
    return positions()
straight = run(1, False)
result["same"] = [bool((straight == run(*how)).all()) for how in ((2, False), (1, True))]
"""
    )
    assert all(found["same"])


def test_a_step_changed_and_changed_back_leaves_everything(yade):
    """Positions and velocities to rounding, whatever is called in between, and the same small step with other subSteps too."""
    found = yade(
        STEPS
        + """
def run(change):
    chain(subSteps=4)
    O.dt *= 4
    for _ in range(30):
        O.step()
        change()
    return np.array([list(b.state.pos) + list(1e-9 * b.state.vel) + list(1e-16 * b.state.angVel) for b in O.bodies])
def there_and_back():
    O.dt *= 0.3
    engine().writeInteractions()
    O.dt /= 0.3
def two_by_two():
    engine().subSteps, O.dt = 2, O.dt / 2
    O.step()
    O.step()
    engine().subSteps, O.dt = 4, O.dt * 2
straight = run(lambda: None)
result["back"] = float(np.abs(run(there_and_back) - straight).max() / 1e-7)
result["split"] = float(np.abs(run(two_by_two) - run(O.step)).max() / 1e-7)
"""
    )
    assert found["back"] < 1e-9 and found["split"] < 1e-9, found


def test_the_functors_take_over_after_another_step(yade):
    """handOver() leaves O.dt at the step that was last set, and the functors go on with it."""
    found = yade(
        STEPS
        + """
def run(handed):
    chain()
    for _ in range(20): O.step()
    O.dt *= 0.5
    if not handed:
        for _ in range(41): O.step()
        return positions(), O.dt
    O.step()
    engine().handOver()
    O.engines = functor_engines()
    for _ in range(39): O.step()
    return positions(), O.dt
(x, a), (y, b) = run(False), run(True)
result.update(moved=float(np.abs(x - y).max() / 1e-7), steps=[a, b])
"""
    )
    assert found["moved"] < 1e-9 and found["steps"][0] == found["steps"][1], found
