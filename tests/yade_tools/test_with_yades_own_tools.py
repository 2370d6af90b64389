"""Functors and engine in the company of YADE's own tools: threads, VTK output, stress, help texts."""

import pydoc

import pytest
from refused import refused
from scenes import *

IN_YADE = pytest.mark.in_yade


def flown_together():
    new_scene(0.1 * unit, verlet=2e-8)
    converging(64, 4, [ice(), soft()], [1e-7, 1.3e-7])
    O.run(250, True)
    return positions(), energies()


def test_threads_change_results_by_rounding_only(yade):
    (x, one), (y, two) = yade(flown_together, threads=1), yade(flown_together, threads=2)
    assert one["slidingDissipation"] > 0
    assert np.abs(x - y).max() < 1e-12 * 1e-7 * 1e3
    assert two == pytest.approx(one, rel=1e-8, abs=1e-26)


def engine_of_27(**options):
    """27 grains that fly together under the fused engine, 20 small steps each O.step."""
    new_scene(0.1 * unit)
    converging(27, 1, [ice()], [1e-7])
    engine_of_sub_steps(20, **options)


@IN_YADE
def test_vtk_recorder_and_stresses_see_the_contacts(tmp_path):
    engine_of_27(exportInteractions=True)
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


@IN_YADE
def test_help_describes_attributes_with_units():
    described = {JKRMat: "Surface energy gamma [J/m^2]", JKRWadaPhys: "overlap", JKRWadaEngine: "subSteps"}
    for kind, words in described.items():
        assert words in pydoc.plain(pydoc.render_doc(kind))


SETTINGS = {
    "functor.neck = 0.71": "neck = 0.71: must be 0 (no bonds), or up to 0.7",
    "JKRMat(young=-1)": "young = -1: must be > 0 [Pa]",
    "JKRMat(surfaceEnergy=0)": "must be > 0 [J/m^2]: all limits of this law follow from adhesion",
}


@IN_YADE
def test_what_the_functors_cannot_do_is_refused_when_it_is_set():
    """Within a step YADE's threads could not pass an exception on: it would end the process. The value before stays."""
    functor = Ip2_JKRMat_JKRMat_JKRWadaPhys(linearDamping=0.5, neck=0.3)
    for setting, words in SETTINGS.items():
        with refused(Exception, words):
            exec(setting, {**globals(), "functor": functor})
    given = functor.linearDamping, functor.neck, functor.slidingStiffnessFactor, functor.rollingStiffnessFactor
    assert given == (0.5, 0.3, 1, 1)
