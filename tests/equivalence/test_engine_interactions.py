"""What JKRWadaEngine leaves in O.interactions and in State.ori is what the functors leave there."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade


def contacts():
    """{ids: {name: numbers}}, each pair in the order of rising ids."""
    found = {}
    for i in O.interactions:
        p, g = i.phys, i.geom
        s = 1 if i.id1 < i.id2 else -1
        first, second = (p.pointer1, p.pointer2)[::s]
        values = dict(
            normalForce=s * p.normalForce,
            shearForce=s * p.shearForce,
            pointer1=first,
            pointer2=second,
            overlap=p.overlap,
            dragForce=p.dragForce,
            twist=p.twist,
            sliding=s * p.slidingDisplacement,
            rolling=p.rollingDisplacement,
            kn=p.kn,
            ks=p.ks,
            normal=s * g.normal,
            point=g.contactPoint,
            depth=g.penetrationDepth,
            radii=[g.refR1, g.refR2][::s],
            constants=[p.constants.radius1, p.constants.radius2][::s],
            stiffness=p.constants.twistingStiffness,
        )
        found[min(i.id1, i.id2), max(i.id1, i.id2)] = {name: np.ravel(x) for name, x in values.items()}
    return found


def orientations():
    return np.array([list(b.state.ori) for b in O.bodies])


@pytest.mark.parametrize(
    "kind, steps, springs, zero",
    [
        ("unlike", 700, {}, ["dragForce"]),
        ("drag", 200, {}, []),
        ("like", 200, {"rolling": False}, ["dragForce", "rolling"]),
    ],
)
def test_interactions_are_those_of_the_functors(kind, steps, springs, zero):
    """After n O.steps the engine's contacts are of the positions then; the functors have them one step later."""
    meeting(kind, **springs)
    O.run(steps, True)
    x = positions()  # of the forces of the next step, after which YADE's bodies are a step further than the forces
    O.run(1, True)
    functors = contacts()
    stress = sum(np.outer(c["normalForce"] + c["shearForce"], x[a] - x[b]) for (a, b), c in functors.items()) / 1e-18
    meeting(kind, mover="fused", exportInteractions=True, orientations=True, **springs)
    O.run(steps, True)
    engine = contacts()
    order = [(i.id1, i.id2) for i in O.interactions]
    assert order == sorted(order) == sorted(functors) == sorted(engine)
    assert len(order) == O.interactions.countReal() == O.engines[0].statistics()["contacts"] > 10
    assert sum(len(b.intrs()) for b in O.bodies) == 2 * len(order)
    for name in functors[order[0]]:
        a, b = (np.array([found[pair][name] for pair in order], float) for found in (functors, engine))
        assert np.abs(a - b).max() <= 1e-9 * np.abs(a).max(), name
        assert a.any() == (name not in zero), name
    assert np.abs(np.array(utils.getStress(volume=1e-18)) - stress).max() < 1e-9 * np.abs(stress).max()


def test_exporting_changes_no_bit_and_checkpoints_go_on():
    def end(**options):
        meeting("unlike", count=64)
        engine_of_sub_steps(7, **options)
        O.run(60, True)
        O.save("checkpoint.yade.gz")
        O.run(60, True)
        return positions()

    def described():
        return {pair: [x.tolist() for x in values.values()] for pair, values in contacts().items()}

    plain = end()
    full = end(exportInteractions=True, orientations=True)
    straight, turned = described(), orientations()
    O.load("checkpoint.yade.gz")
    assert len(O.interactions) > 10
    O.run(60, True)
    assert (plain == full).all() and (positions() == full).all()
    assert straight == described() and (turned == orientations()).all()


def test_orientations_are_those_of_the_functors():
    """To rounding, whatever the sub-steps, with contacts that form, slips and fast spins."""

    def end(sub_steps):
        new_scene(0.05 * unit)
        grain((0, 0, 0), 1e-7, ice(), (1, 0, 0), (2e7, 1e8, -1e8))
        grain((2.0001e-7, 0.3e-7, 0), 1e-7, ice(), (-1, 0.5, 0), (1e8, -3e8, 1e8))
        grain((1e-7, -2e-7, 0.2e-7), 1e-7, ice(), (0, 4, 0), (0, 3e8, 1e7))
        if sub_steps:
            engine_of_sub_steps(sub_steps, orientations=True)
        O.run(480 // max(1, sub_steps), True)
        return orientations()

    functors = end(0)
    assert np.abs(functors - [0, 0, 0, 1]).max() > 0.1
    for sub_steps in (1, 16):
        assert np.abs(end(sub_steps) - functors).max() < 1e-12


def test_orientations_converge_with_second_order():
    """Three grains that stick, turn together by a quarter of a radian and quiver."""

    def end(step):
        new_scene(step * unit)
        w, d = np.array([2e7, -5e7, 4e7]), 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]
        for k, x in enumerate(([0, 0, 0], [d, 0, 0], [0, d, 0])):
            velocity = np.cross(w, x) + 0.02 * np.array([k, 1 - k, 0])
            grain(x, 1e-7, ice(), velocity, w + 2e5 * np.array([k, 0, 1 - k]))
        fused_engine(orientations=True)
        O.run(round(24 / step), True)
        return orientations()

    reference = end(0.00625)
    coarse, middle, fine = (np.abs(end(step) - reference).max() for step in (0.1, 0.05, 0.025))
    assert sum(energies()[name] for name in LOST) == 0
    assert 3.5 < coarse / middle < 4.6 and 3.5 < middle / fine < 4.6
