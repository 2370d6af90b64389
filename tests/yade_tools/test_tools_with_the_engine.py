"""YADE's recorders and stresses around JKRWadaEngine."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade


def start(**options):
    """27 grains that fly together under the fused engine, 20 small steps each O.step."""
    new_scene(0.1 * unit)
    converging(27, 1, [ice()], [1e-7])
    engine_of_sub_steps(20, **options)


def test_vtk_recorder_and_stresses_see_the_contacts(tmp_path):
    start(exportInteractions=True)
    counts = sys.modules["__main__"].counts = []
    recorded = dict(recorders=["spheres", "intr", "velocity"], iterPeriod=5, multiblock=True)
    vtk = VTKRecorder(fileName=str(tmp_path / "out-"), **recorded)
    O.engines += [vtk, PyRunner(command="counts.append(O.interactions.countReal())", iterPeriod=1)]
    O.run(20, True)
    shot = contact_law.snapshot()
    x, pairs, force = shot["position"], shot["contact_pairs"], shot["contact_normal_force"]
    assert counts[-1] == len(pairs) > 10
    by_pair = {tuple(sorted(p)): f for p, f in zip(pairs.tolist(), force)}
    total = np.zeros((3, 3))
    for i in O.interactions:
        way = x[i.id2] - x[i.id1]
        assert np.abs(np.array(i.geom.normal) - way / np.linalg.norm(way)).max() < 1e-12
        assert abs(i.phys.normalForce.dot(i.geom.normal) - by_pair[i.id1, i.id2]) < 1e-12 * np.abs(force).max()
        total += np.outer(i.phys.normalForce + i.phys.shearForce, -way)
    # YADE takes each contact's branches to the contact point: together they are the whole branch
    volumes = [4 / 3 * np.pi * b.shape.radius**3 for b in O.bodies]
    of_bodies = sum(np.array(stress) * volume for stress, volume in zip(utils.bodyStressTensors(), volumes))
    for stress in (np.array(utils.getStress(volume=1.0)), of_bodies):
        assert np.abs(stress - total).max() < 1e-12 * np.abs(total).max()
    written = b"".join(p.read_bytes() for p in tmp_path.rglob("*.vtp"))
    assert len(list(tmp_path.glob("out-*.vtm"))) >= 3 and b"forceN" in written


@pytest.mark.parametrize("other", ["NewtonIntegrator()", "InteractionLoop([], [], [])"])
def test_engines_that_would_move_the_grains_twice_are_refused_unless_dead(other):
    start()
    O.engines += [eval(other)]
    assert refusal().endswith("is among O.engines too; this engine replaces it")
    O.engines[1].dead = True
    O.step()
    assert O.iter == 1
