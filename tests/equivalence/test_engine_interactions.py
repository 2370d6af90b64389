"""What JKRWadaEngine leaves in O.interactions and in State.ori is what the functors leave there."""

import pytest

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
KINDS = {"like": ([ice()], [1e-7]), "unlike": ([ice(), soft()], [1e-7, 1.6e-7, 1.3e-7]), "drag": ([ice(viscoelasticTime=2e-12)], [1e-7])}
def start(kind, count=27, seed=1):
    new_scene(0.1 * unit)
    converging(count, seed, *KINDS[kind])
def contacts():
    'By ids, each in the order of rising ids.'
    found = {}
    for i in O.interactions:
        p, g = i.phys, i.geom
        s = 1 if i.id1 < i.id2 else -1
        first, second = (p.pointer1, p.pointer2)[::s]
        found[min(i.id1, i.id2), max(i.id1, i.id2)] = dict(
            normalForce=s * p.normalForce, shearForce=s * p.shearForce, pointer1=first, pointer2=second, overlap=p.overlap, dragForce=p.dragForce, twist=p.twist,
            sliding=s * p.slidingDisplacement, rolling=p.rollingDisplacement, kn=p.kn, ks=p.ks, normal=s * g.normal, point=g.contactPoint,
            depth=g.penetrationDepth, radii=[g.refR1, g.refR2][::s], constants=[p.constants.radius1, p.constants.radius2][::s], stiffness=p.constants.twistingStiffness)
    return found
"""


@pytest.mark.parametrize("kind", ["like", "unlike", "drag"])
def test_interactions_are_those_of_the_functors(yade, kind):
    """After n O.steps the engine's contacts are of the positions then; the functors have them one step later."""
    found = yade(
        SCENE
        + """
steps = parameters["steps"]
start(parameters["kind"])
O.run(steps, True)
x = positions()  # of the forces of the next step, after which YADE's bodies are a step further than the forces
O.run(1, True)
functors = contacts()
stress = sum(np.outer(c["normalForce"] + c["shearForce"], x[a] - x[b]) for (a, b), c in functors.items()) / 1e-18
start(parameters["kind"])
fused_engine(exportInteractions=True, orientations=True)
O.run(steps, True)
engine = contacts()
result["order"] = [(i.id1, i.id2) for i in O.interactions]
result["count"] = [len(functors), len(engine), O.interactions.countReal(), O.engines[0].statistics()["contacts"]]
result["same"] = sorted(functors) == sorted(engine)
result["bodies"] = sum(len(b.intrs()) for b in O.bodies)
scales = {}
for key in functors[min(functors)]:
    a, b = (np.array([np.ravel(x[pair][key]) for pair in sorted(functors)], float) for x in (functors, engine))
    scales[key] = float(np.abs(a).max())
    result[key] = float(np.abs(a - b).max() / scales[key]) if scales[key] else float(np.abs(b).max())
result["stress"] = float(np.abs(np.array(utils.getStress(volume=1e-18)) - stress).max() / np.abs(stress).max())
""",
        {"kind": kind, "steps": 700 if kind == "unlike" else 200},
    )
    count = found.pop("count")
    assert len(set(count)) == 1 and count[0] > 10, count
    order = found.pop("order")
    assert (
        order == sorted(order)
        and all(a < b for a, b in order)
        and found.pop("same")
        and found.pop("bodies") == 2 * count[0]
    )
    for key, difference in found.items():
        assert difference < 1e-9, (key, difference)


def test_interactions_follow_the_contacts_and_stay_the_same_objects(yade):
    found = yade(
        SCENE
        + """
start("like", count=64)
fused_engine(subSteps=5, exportInteractions=True)
O.dt *= 5
seen, ended, kept, same = None, 0, 0, True
for _ in range(80):
    O.step()
    now = {(i.id1, i.id2): i for i in O.interactions}
    same = same and len(now) == O.engines[0].statistics()["contacts"] and all(i.isReal for i in now.values())
    if seen:
        ended += len(set(seen) - set(now))
        kept += sum(seen[pair].iterMadeReal == now[pair].iterMadeReal for pair in set(seen) & set(now))
        same = same and all(seen[pair].phys is now[pair].phys or seen[pair].phys.twist == now[pair].phys.twist for pair in set(seen) & set(now))
    seen = now
result.update(ended=ended, kept=kept, same=same)
O.engines[0].exportInteractions = False
O.step()
result["without"] = len(O.interactions)
O.engines[0].writeInteractions()
result["asked"] = len(O.interactions) - O.engines[0].statistics()["contacts"]
"""
    )
    assert found["ended"] > 3 and found["kept"] > 100 and found["same"]
    assert found["without"] == 0 and found["asked"] == 0


def test_exporting_changes_no_bit_and_checkpoints_go_on(yade):
    found = yade(
        SCENE
        + """
def run(**options):
    start("unlike", count=64)
    fused_engine(subSteps=7, **options)
    O.dt *= 7
    O.run(60, True)
    O.save("checkpoint.yade.gz")
    O.run(60, True)
    return positions()
def described():
    return {pair: [np.ravel(x).tolist() for x in values.values()] for pair, values in contacts().items()}
plain = run()
full = run(exportInteractions=True, orientations=True)
straight, turned = described(), [list(b.state.ori) for b in O.bodies]
O.load("checkpoint.yade.gz")
result["loaded"] = len(O.interactions)
O.run(60, True)
result["same"] = [bool((plain == full).all()), bool((positions() == full).all()), straight == described(), turned == [list(b.state.ori) for b in O.bodies]]
"""
    )
    assert found["loaded"] > 10 and found["same"] == [True] * 4, found


def test_orientations_are_those_of_the_functors(yade):
    """To rounding, whatever the sub-steps, with contacts that form, slips and fast spins."""
    found = yade(
        SCENE
        + """
def end(sub_steps):
    new_scene(0.05 * unit)
    grain((0, 0, 0), 1e-7, ice(), (1, 0, 0), (2e7, 1e8, -1e8))
    grain((2.0001e-7, 0.3e-7, 0), 1e-7, ice(), (-1, 0.5, 0), (1e8, -3e8, 1e8))
    grain((1e-7, -2e-7, 0.2e-7), 1e-7, ice(), (0, 4, 0), (0, 3e8, 1e7))
    if sub_steps:
        fused_engine(subSteps=sub_steps, orientations=True)
        O.dt *= sub_steps
    O.run(480 // max(1, sub_steps), True)
    return np.array([list(b.state.ori) for b in O.bodies])
functors = end(0)
result["turned"] = float(np.abs(functors - [0, 0, 0, 1]).max())
result["differences"] = [float(np.abs(end(n) - functors).max()) for n in (1, 16)]
"""
    )
    assert found["turned"] > 0.1 and max(found["differences"]) < 1e-12, found


def test_orientations_converge_with_second_order(yade):
    """Three grains that stick, turn together by a quarter of a radian and quiver."""
    found = yade(
        SCENE
        + """
def end(step, time=24):
    new_scene(step * unit)
    w, d = np.array([2e7, -5e7, 4e7]), 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]
    for k, x in enumerate(([0, 0, 0], [d, 0, 0], [0, d, 0])):
        grain(x, 1e-7, ice(), np.cross(w, x) + 0.02 * np.array([k, 1 - k, 0]), w + 2e5 * np.array([k, 0, 1 - k]))
    fused_engine(orientations=True)
    O.run(round(time / step), True)
    return np.array([list(b.state.ori) for b in O.bodies])
fine = end(0.00625)
result["errors"] = [float(np.abs(end(step) - fine).max()) for step in (0.1, 0.05, 0.025)]
result["lost"] = sum(energies()[name] for name in LOST)
start("like")
fused_engine()
O.run(20, True)
result["untouched"] = all(tuple(b.state.ori) == (0, 0, 0, 1) for b in O.bodies)
"""
    )
    coarse, middle, fine = found["errors"]
    assert found["lost"] == 0 and 3.5 < coarse / middle < 4.6 and 3.5 < middle / fine < 4.6, found
    assert found["untouched"]


def test_orientations_given_by_a_script_are_kept_and_turned_on(yade):
    found = yade(
        SCENE
        + """
new_scene(0.1 * unit)
grain((0, 0, 0), 1e-7, ice(), (0, 0, 0), (0, 0, 1e7))
fused_engine(orientations=True)
O.run(10, True)
O.bodies[0].state.ori = Quaternion((0, 0, 1), 1.0)
O.run(10, True)
axis, angle = O.bodies[0].state.ori.toAxisAngle()
result.update(angle=angle * axis[2], expected=1.0 + 1e7 * 10 * O.dt)
"""
    )
    assert found["angle"] == pytest.approx(found["expected"], rel=1e-12)
