"""JKRWadaEngine in periodic cells against the functors, step by step, and against itself: threads, instruction sets, sub-steps."""

import numpy as np
import pytest

SCENE = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
KINDS = {"like": ([ice()], [1e-7]), "unlike": ([ice(), soft()], [1e-7, 1.6e-7, 1.3e-7]), "drag": ([ice(viscoelasticTime=2e-12)], [1e-7])}
def start(kind, rate, homo, count=27, seed=1, fill=1.02, limit="held"):
    'Grains on a loose lattice that fills the cell, shrinking by `rate` a time unit, and each with some velocity and spin; some lie in other periods.'
    new_scene(0.1 * unit, limit=limit)
    materials, radii = KINDS[kind]
    random = np.random.default_rng(seed)
    side = int(round(count ** (1 / 3)))
    size = side * fill * 2 * max(radii)
    O.periodic = True
    O.cell.setBox(size, 1.02 * size, 1.04 * size)
    O.cell.homoDeform = homo
    for k in range(count):
        x = size * (np.array([k % side, k // side % side, k // side**2]) + 0.5 + 0.001 * random.normal(size=3)) / side + size * random.integers(-1, 2, size=3) * (1, 1.02, 1.04)
        grain(x, radii[k % len(radii)], materials[k % len(materials)], 3 * random.normal(size=3), 2e7 * random.normal(size=3))
    if rate:
        O.cell.velGrad = Matrix3(-rate / unit, 0, 0, 0, -0.7 * rate / unit, 0, 0, 0, -0.4 * rate / unit)
def all_energies():
    have = dict(O.energy.items())
    return {n: have.get(n, 0.0) for n in CHANNELS + ["boundaryWork"]}
"""


@pytest.mark.parametrize(
    "kind,rate,homo,limit",
    [
        ("like", 0, 2, "held"),
        ("unlike", 0, 0, "held"),
        ("like", 2e-3, 0, "held"),
        ("drag", 2e-3, 1, "held"),
        ("unlike", 2e-3, 1, "held"),
        ("like", 2e-3, 2, "held"),
        ("drag", 2e-3, 0, "cut"),
    ],
)
def test_engine_and_functors_agree_step_by_step(yade, kind, rate, homo, limit):
    """Grains of which some lie in other periods than their neighbours, in a cell at rest, in a shrinking one through which they fly (homoDeform 0), and in one whose mean field moves them.

    With prepare() the engine takes the velocity gradient at once, so that its cell is an update ahead of the functors' O.cell at the same grains' positions: the
    functors' forces at these positions see the same size. In the first step with a mean field NewtonIntegrator leaves its convective term (homoDeform 2) out; the
    velocities that the functors are given have what the engine's have of it. Not compared: boundaryWork of the functors, which does not know of mean fields, and
    YADE's kinetic energy, in which velocities are counted from velGrad times position.
    """
    found = yade(
        SCENE
        + """
kind, rate, homo, limit, n = *(parameters[name] for name in ("kind", "rate", "homo", "limit")), 300
def record(n):
    tracks, sums, sizes = [], [], []
    for _ in range(n):
        O.step()
        tracks.append(positions())
        sums.append(all_energies())
        sizes.append([O.cell.hSize[k, k] for k in range(3)])
    return np.array(tracks), sums, np.array(sizes)
start(kind, rate, homo, limit=limit)
if homo == 2 and rate:
    gradient = np.diag(np.array(O.cell.nextVelGrad).reshape(3, 3))
    for b in O.bodies:
        mean = gradient * np.array(b.state.pos)
        b.state.vel = Vector3((np.array(b.state.vel) + mean) * (1 + gradient * O.dt) / (1 + gradient * O.dt / 2) - mean)
functors, functor_energies, functor_sizes = record(n + 1)
start(kind, rate, homo, limit=limit)
fused_engine(limit=limit)
O.engines[0].prepare()
engine, engine_energies, sizes = record(n)
result["sizes"] = float(np.abs(functor_sizes[1:] - sizes).max() / 1e-7)
result["difference"] = np.abs(functors[:n] - engine).max(axis=(1, 2)) / 1e-7
scale = functor_energies[0]["kinetic"]
names = [c for c in CHANNELS + ["boundaryWork"] if not rate or (c != "kinetic" and (c != "boundaryWork" or homo == 0))]
result["energies"] = {c: max(abs(functor_energies[k + 1][c] - engine_energies[k][c]) for k in range(n)) / scale for c in names}
result["events"] = O.engines[0].statistics()["events"]
result["last"] = engine_energies[-1]
""",
        {"kind": kind, "rate": rate, "homo": homo, "limit": limit},
    )
    assert found["events"] > 50 and found["last"]["connection"] > 0 and found["last"]["slidingDissipation"] > 0
    assert (found["last"]["boundaryWork"] != 0) == (rate != 0)
    assert found["sizes"] < 1e-12
    difference = np.array(found["difference"])
    assert difference[:100].max() < 1e-12, difference[:100].max()
    assert difference.max() < 1e-9, difference.max()
    assert max(found["energies"].values()) < 1e-9, found["energies"]


@pytest.mark.parametrize("kind,homo", [("unlike", 2), ("drag", 0)])
def test_same_bits_on_one_and_two_threads_and_steps_are_sub_steps(yade, kind, homo):
    found = yade(
        SCENE
        + """
def end(threads, sub_steps=10, **options):
    start(parameters["kind"], 1e-3, parameters["homo"], count=343)
    fused_engine(threads=threads, subSteps=sub_steps, **options)
    O.dt *= sub_steps
    O.engines[0].prepare()
    O.run(500 // sub_steps, True)
    return positions(), all_energies(), O.engines[0].statistics()
runs = [end(1), end(2), end(1)]
result["same"] = [bool((runs[0][0] == r[0]).all() and runs[0][1] == r[1]) for r in runs[1:]]
result["statistics"] = runs[0][2]
""",
        {"kind": kind, "homo": homo},
    )
    assert found["same"] == [True, True]
    assert found["statistics"]["events"] > 1000 and found["statistics"]["searches"] > 1


def test_instruction_sets_and_domains_agree_to_rounding(yade):
    found = yade(
        SCENE
        + """
def end(**options):
    start("drag", 1e-3, 2)
    fused_engine(**options)
    O.run(300, True)
    return positions(), all_energies()["boundaryWork"]
reference, work = end(instructions="portable")
result["events"] = O.engines[0].statistics()["events"]
for name in ("avx2", "avx512"):
    try:
        x, w = end(instructions=name)
    except RuntimeError:
        continue
    result[name] = max(float(np.abs(x - reference).max() / 1e-7), abs(w / work - 1))
for domains in (1, 3):
    x, w = end(instructions="portable", domains=domains)
    result[str(domains)] = max(float(np.abs(x - reference).max() / 1e-7), abs(w / work - 1))
"""
    )
    assert found.pop("events") > 50
    assert max(found.values()) < 1e-9, found


def test_exported_interactions_are_those_of_the_nearest_images(yade):
    found = yade(
        SCENE
        + """
start("unlike", 1e-3, 1)
fused_engine(exportInteractions=True, subSteps=10)
O.dt *= 10
O.run(100, True)
size = np.array([O.cell.hSize[k, k] for k in range(3)])
result["cells"], result["normals"], result["overlaps"] = 0, 0.0, 0.0
for i in O.interactions:
    a, b = O.bodies[i.id1], O.bodies[i.id2]
    branch = np.array(b.state.pos) + size * np.array(i.cellDist) - np.array(a.state.pos)
    distance = np.linalg.norm(branch)
    result["normals"] = max(result["normals"], float(np.abs(branch / distance - np.array(i.geom.normal)).max()))
    result["overlaps"] = max(result["overlaps"], abs(a.shape.radius + b.shape.radius - distance - i.geom.penetrationDepth) / 1e-7)
    result["cells"] += any(i.cellDist)
stress = np.array(utils.getStress(O.cell.volume)).reshape(3, 3)
shot = contact_law.snapshot()
apart = shot["position"][shot["contact_pairs"][:, 0]] - shot["position"][shot["contact_pairs"][:, 1]]
apart -= size * np.round(apart / size)
result["normal part"] = -float((np.linalg.norm(apart, axis=1) * shot["contact_normal_force"]).sum() / size.prod())
result["stress"] = float(np.trace(stress))
"""
    )
    assert found["cells"] > 5 and found["normals"] < 1e-12 and found["overlaps"] < 1e-12
    assert found["stress"] == pytest.approx(found["normal part"], rel=1e-6)  # sliding forces have no part in the trace


@pytest.mark.parametrize("homo", [0, 1, 2])
def test_a_look_at_the_contacts_does_not_move_the_cell(yade, homo):
    """writeInteractions() before the first step, or the first step after loading, leaves a velocity gradient that was set for when it would hold without the call."""
    found = yade(
        SCENE
        + """
def end(*calls):
    start("like", 1e-3, parameters["homo"])
    fused_engine()
    if "first" in calls: O.engines[0].writeInteractions()
    O.run(20, True)
    O.cell.velGrad = Matrix3(2e-3 / unit, 0, 0, 0, 0, 0, 0, 0, 0)
    if "loaded" in calls:
        O.save("half.yade.gz")
        O.load("half.yade.gz")
        O.engines[0].writeInteractions()
    O.run(20, True)
    return positions(), O.cell.hSize[0, 0], all_energies()
straight = end()
result["same"] = [bool((straight[0] == x).all()) and straight[1:] == tuple(rest) for x, *rest in [end("first"), end("loaded")]]
""",
        {"homo": homo},
    )
    assert found["same"] == [True, True]
