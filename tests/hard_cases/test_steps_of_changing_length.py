"""Steps whose length a script changes in the middle of a run of JKRWadaEngine."""

import pytest
from changes import *

pytestmark = pytest.mark.in_yade
FACTORS = (1, 0.5, 2, 0.25, 1, 2)  # of the small step, one after the other


def through(base, time, factors=FACTORS, each=lambda: None):
    """Go on for a time [t0], as many stretches as there are factors; base: the small step [t0]."""
    for factor in factors:
        few = max(1, round(time / len(factors) / (base * factor)))
        engine().subSteps = few
        O.dt = time / len(factors) * unit
        O.step()
        each()


def unlike(base, time, change=lambda: None):
    """Go on for a time [t0] by small steps of which each has another length than the one before."""
    engine().subSteps = 1
    for k in range(3 * round(time / (1.75 * base))):
        O.dt = base * (1, 0.5, 0.25)[k % 3] * unit
        change()
        O.step()


def vibrating(kind, base):
    """Four touching grains that vibrate, without slip or event; the small step [t0]: base, shorter for bonds."""
    if kind == "bonds":
        base *= 0.25
    new_scene(base * unit)
    material = ice(viscoelasticTime=1e-12 if kind == "drag" else 0.0)
    d = 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]
    for k in range(4):
        grain((k * d, 0, 0), 1e-7, material, (0.02 * (-1) ** k, 0.002 * k, 0), (0, 1e4 * (-1) ** k, 0))
    if kind == "blocked":
        O.bodies[1].state.blockedDOFs = "xZ"
    if kind == "cell":
        periodic_cell(4 * d, 8e-7, 8e-7, velocity_gradient=(1e5, -1e5, 0))
    fused_engine(neck=0.3 if kind == "bonds" else 0.0)
    engine().prepare()
    if kind == "force":
        O.forces.setPermF(0, Vector3(2e-9, 1e-9, 0))
        O.forces.setPermT(1, Vector3(0, 0, 1e-17))
    return base


def motion():
    """Positions, velocities and spins of all grains, in lengths like their positions' [m]."""
    return np.array([[*b.state.pos, *(1e-10 * b.state.vel), *(1e-17 * b.state.angVel)] for b in O.bodies])


def far_apart(x, y):
    """The largest distance, in radii."""
    return np.abs(x - y).max() / 1e-7


def closure_of(base, times, through_time):
    """Largest change of all energies and works in so many rounds of stretches, over the kinetic energy at the start."""
    total = lambda: sum(energy for _, energy in O.energy.items())
    start, kinetic, found = total(), energies()["kinetic"], [0.0]
    through(base, through_time, times * FACTORS, each=lambda: found.append(abs(total() - start)))
    return max(found) / kinetic


BY_STRETCHES = [("through", kind) for kind in ("free", "drag", "bonds", "blocked", "force", "cell")]


@pytest.mark.parametrize("go, kind", [*BY_STRETCHES, ("unlike", "free"), ("unlike", "drag")])
def test_trajectories_have_second_order(go, kind):
    """Of the largest distance from a run of short equal steps, at steps a factor 2 apart: 4."""

    def end(base, by, *factors):
        by(vibrating(kind, base), 24.0 if go == "through" else 21.0, *factors)
        return motion()

    # O.steps of the same length: by these YADE changes the cell
    reference = end(0.0025, through, (1,) * (len(FACTORS) if go == "through" else 1))
    coarse, middle, fine = (far_apart(end(base, globals()[go]), reference) for base in (0.08, 0.04, 0.02))
    assert coarse < 1e-3 and 3.4 < coarse / middle < 4.6 and 3.4 < middle / fine < 4.6


def test_contacts_form_and_break_in_steps_between_others():
    """Two grains bounce off each other; every contact forms and breaks between two steps of unlike length. Energy
    over the one at the start, root mean square over 16 phases of the first touch within a step, at steps a factor 4
    apart: while they touch (16), at the end (8: the last rise of the force, a square root, is summed for equal
    steps), and the largest change by that of the step alone (16)."""

    def errors(base, phase):
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
        touching = max(errors)
        assert engine().statistics()["contacts"] == 1
        unlike(base, 29.4, change)
        counts = engine().statistics()
        assert counts["formed"] == counts["broken"] == 1
        return touching, (total_energy() - start) / kinetic, max(jumps)

    coarse, fine = (rms(errors(base, k / 16) for k in range(16)) for base in (0.16, 0.04))
    assert (coarse < (5e-3, 2e-3, 1e-2)).all() and (coarse / fine > (9, 6, 10)).all()


@pytest.mark.parametrize("number", [2, 3])
def test_no_contact_is_missed_when_steps_become_longer(number):
    """Twenty times: the neighbour lists reckon in steps. A checkpoint holds no lists, and goes on to the same bits."""

    def end(load):
        new_scene(0.02 * unit)
        converging(64, 3, [ice()], [1e-7], speed=8.0)
        engine_of_sub_steps(10)
        steps(number)
        formed = engine().statistics()["formed"]
        O.dt *= 20
        engine().prepare()
        if load:
            saved_and_loaded()
        steps(20)
        return positions(), engine().statistics()["formed"] - formed

    (x, formed), (y, _) = end(False), end(True)
    assert (x == y).all() and formed > 20


@pytest.mark.parametrize("kind", ["free", "bonds", "blocked", "force", "cell"])
def test_the_ledger_closes_in_every_kind_of_scene(kind):
    """With the work of boundaries, of outside forces and of what holds grains: the largest deviation, at steps a
    factor 4 apart, 16."""

    def closure(base):
        base = vibrating(kind, base)
        O.step()
        return closure_of(base, 2, 24.0)

    coarse, fine = closure(0.08), closure(0.02)
    assert fine < coarse < 0.05 and coarse / fine > 10


@pytest.mark.parametrize("drag", [0.0, 2e-12])
def test_the_ledger_closes_with_second_order(drag):
    """While contacts form, slip and break: root mean square over six scenes, at steps a factor 4 apart (16; order
    3/2 gives 8, first order 4)."""

    def closure(base, seed):
        new_scene(base * unit)
        converging(27, seed, [ice(viscoelasticTime=drag)], [1e-7])
        fused_engine()
        engine().prepare()
        found = closure_of(base, 12, 12 * 30.0)
        happened.append([energies()[name] for name in ("connection", "disconnection", "rollingDissipation")])
        return found

    errors = []
    for base in (0.1, 0.025):
        happened = []
        errors.append(rms(closure(base, seed) for seed in range(6)))
        assert (np.sum(happened, axis=0) > 0).all()
    coarse, fine = errors
    assert coarse < 2e-3 and coarse / fine > (6 if drag else 9)
