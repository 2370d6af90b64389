"""YADE's recorders, stresses and PyRunners around JKRWadaEngine."""

import pytest

SCENE = """
from scenes import *
c = constants(ice(), 1e-7)
def start(sub_steps=20, **options):
    new_scene(0.1 * c["timeUnit"])
    converging(27, 1, [ice()], [1e-7])
    fused_engine(subSteps=sub_steps, **options)
    O.dt *= sub_steps
"""


def test_vtk_recorder_and_stresses_see_the_contacts(yade, tmp_path):
    found = yade(
        SCENE
        + """
start(exportInteractions=True)
O.engines += [VTKRecorder(fileName=parameters["base"], recorders=["spheres", "intr", "velocity"], iterPeriod=5, multiblock=True), PyRunner(command="count.append(O.interactions.countReal())", iterPeriod=1)]
count = []
O.run(20, True)
s = contact_law.snapshot()
x, pairs, force = s["position"], s["contact_pairs"], s["contact_normal_force"]
result["count"] = [count[-1], len(pairs)]
by_pair = {tuple(sorted(p)): f for p, f in zip(pairs.tolist(), force)}
result["force"] = max(abs(i.phys.normalForce.dot(i.geom.normal) - by_pair[i.id1, i.id2]) for i in O.interactions) / np.abs(force).max()
result["normal"] = max(float(np.abs(np.array(i.geom.normal) - (x[i.id2] - x[i.id1]) / np.linalg.norm(x[i.id2] - x[i.id1])).max()) for i in O.interactions)
total = sum(np.outer(i.phys.normalForce + i.phys.shearForce, x[i.id1] - x[i.id2]) for i in O.interactions)
result["stress"] = float(np.abs(np.array(utils.getStress(volume=1.0)) - total).max() / np.abs(total).max())
each = bodyStressTensors()
volumes = [4 / 3 * math.pi * b.shape.radius**3 for b in O.bodies]
# YADE takes each contact's branches to the contact point: together they are the whole branch
both = sum(np.array(t) * v for t, v in zip(each, volumes))
result["each"] = float(np.abs(both - total).max() / np.abs(total).max())
""",
        {"base": str(tmp_path / "out-")},
    )
    assert found["count"][0] == found["count"][1] > 10
    assert found["force"] < 1e-12 and found["normal"] < 1e-12 and found["stress"] < 1e-12 and found["each"] < 1e-12
    written = b"".join(p.read_bytes() for p in tmp_path.rglob("*.vtp"))
    assert len(list(tmp_path.glob("out-*.vtm"))) >= 3 and b"forceN" in written


def test_a_pyrunner_asks_for_the_contacts_when_it_wants_them(yade):
    found = yade(
        SCENE
        + """
start()
seen = []
O.engines += [PyRunner(command="O.engines[0].writeInteractions(); seen.append(O.interactions.countReal())", iterPeriod=4, initRun=False),
              PyRunner(command="between.append(len(O.interactions))", iterPeriod=1)]
between = []
O.run(20, True)
result.update(seen=seen, between=between)
"""
    )
    assert len(found["seen"]) >= 4 and found["seen"][-1] > 10
    assert 0 < sum(n > 0 for n in found["between"]) <= len(found["seen"])  # none that are out of date


@pytest.mark.parametrize("other", ["NewtonIntegrator()", "InteractionLoop([], [], [])"])
def test_engines_that_would_move_the_grains_twice_are_refused(yade, other):
    found = yade(
        SCENE
        + f"""
start()
O.engines += [{other}]
result["message"] = refusal()
O.engines[1].dead = True
O.step()
result["steps"] = O.iter
"""
    )
    assert found["message"].endswith("is among O.engines too; this engine replaces it") and found["steps"] == 1
