"""The functors in the company of YADE's own tools: periodic cells, threads, VTK output, stress, help texts, energies."""

import numpy as np
import pytest

PAIR = """
from scenes import *
unit = constants(ice(), 1e-7)["timeUnit"]
def collide(periodic, shift=(0, 0, 0), velGrad=None, steps=1500):
    'Two grains meet off the axis; in the periodic case across the boundary of the cell.'
    new_scene(0.05 * unit)
    if periodic:
        O.periodic = True
        O.cell.setBox(2e-6, 2e-6, 2e-6)
    a, b = np.array([1e-7, 1e-6, 1e-6]), np.array([-1.02e-7, 1.09e-6, 1e-6])
    if periodic: b += np.array([2e-6, 0, 0])
    grain(a, 1e-7, ice(), (-3, 0, 1), (2e7, 0, 1e7))
    grain(b, 1e-7, ice(), (3, 0, 0), (0, 3e7, -4e7))
    O.run(steps, True)
    return [list(O.bodies[k].state.vel) + list(O.bodies[k].state.angVel) for k in (0, 1)], energies()
"""


def test_a_contact_across_a_periodic_boundary_is_like_any_other(yade):
    found = yade(PAIR + "result['inside'], result['across'] = collide(False), collide(True)")
    inside, across = found["inside"], found["across"]
    assert inside[1]["rollingDissipation"] > 0
    # the same but for the rounding of positions 20 grain radii from the origin
    assert np.allclose(inside[0], across[0], rtol=1e-6, atol=0)
    for channel, value in inside[1].items():
        assert across[1][channel] == pytest.approx(value, rel=1e-6, abs=1e-24), channel


def test_a_contact_moves_with_a_deforming_cell(yade):
    """In a cell that shrinks, a pair at rest relative to the mean flow across the boundary closes at the flow's rate."""
    found = yade("""
from scenes import *
c = constants(ice(), 1e-7)
new_scene(0.02 * c["timeUnit"])
O.periodic = True
O.cell.setBox(2e-6, 2e-6, 2e-6)
rate = -1e5
O.cell.velGrad = Matrix3(rate, 0, 0, 0, 0, 0, 0, 0, 0)
for x in (1e-7 - 0.1e-9, 2e-6 - 1e-7 + 0.1e-9):
    grain((x, 1e-6, 1e-6), 1e-7, ice(viscoelasticTime=1e-12), blocked="xyzXYZ")  # YADE adds the mean flow
O.run(2, True)
i = O.interactions[0, 1]
o0, t0 = i.phys.overlap, O.time
O.run(50, True)
result.update(drag=O.interactions[0, 1].phys.dragForce, overlap=O.interactions[0, 1].phys.overlap)
result["closing"] = (O.interactions[0, 1].phys.overlap - o0) / (O.time - t0)
result["expected"] = -rate * 2e-7
""")
    assert found["closing"] == pytest.approx(found["expected"], rel=2e-2)
    from analysis.theory import ICE, Material, contact_radius, pair_constants

    pair = pair_constants(Material(**{**ICE.__dict__, "viscoelastic_time": 1e-12}), 1e-7)
    drag = pair.drag_per_contact_radius * contact_radius(found["overlap"], pair) * found["expected"]
    assert found["drag"] == pytest.approx(drag, rel=2e-2)


def test_threads_change_results_by_rounding_only(yade):
    script = """
from scenes import *
new_scene(0.1 * constants(ice(), 1e-7)["timeUnit"], verlet=2e-8)
converging(64, 4, [ice(), soft()], [1e-7, 1.3e-7])
O.run(250, True)
result.update(x=positions(), e=energies())
"""
    one, two = yade(script, threads=1), yade(script, threads=2)
    assert one["e"]["slidingDissipation"] > 0
    assert np.abs(np.array(one["x"]) - np.array(two["x"])).max() < 1e-12 * 1e-7 * 1e3
    for channel, value in one["e"].items():
        assert two["e"][channel] == pytest.approx(value, rel=1e-8, abs=1e-26), channel


def test_vtk_recorder_writes_the_contact_forces(yade, tmp_path):
    found = yade(
        """
from scenes import *
c = constants(ice(), 1e-7)
new_scene(0.1 * c["timeUnit"])
grain((0, 0, 0), 1e-7, ice())
grain((2e-7 - 3 * c["equilibriumOverlap"], 0, 0), 1e-7, ice(), blocked="xyzXYZ")
O.bodies[0].state.blockedDOFs = "xyzXYZ"
O.run(1, True)
O.engines += [VTKRecorder(fileName=parameters["base"], recorders=["spheres", "intr"], iterPeriod=1, multiblock=True)]
O.run(2, True)
i = O.interactions[0, 1]
result.update(force=i.phys.normalForce.norm(), sign=i.phys.normalForce.dot(i.geom.normal), constants=c)
result["stress"] = [list(row) for row in utils.getStress(volume=1e-18)]
result["d"] = 2e-7 - 3 * c["equilibriumOverlap"]
""",
        {"base": str(tmp_path / "out-")},
    )
    from analysis.theory import ICE, normal_force, pair_constants

    pair = pair_constants(ICE, 1e-7)
    expected = normal_force(3 * pair.equilibrium_overlap, pair)
    assert found["sign"] == pytest.approx(expected, rel=1e-9)  # repulsive: positive along YADE's normal
    # stress of one contact: force x distance / volume, negative in compression as in all of YADE
    assert found["stress"][0][0] == pytest.approx(-expected * found["d"] / 1e-18, rel=1e-9)
    written = list(tmp_path.glob("out-*"))
    assert any(p.suffix == ".vtm" for p in written)
    text = b"".join(p.read_bytes() for p in tmp_path.rglob("*.vtp"))
    assert b"forceN" in text


def test_help_describes_classes_attributes_and_units(yade):
    found = yade("""
import pydoc
for name in ("JKRMat", "JKRWadaPhys", "Ip2_JKRMat_JKRMat_JKRWadaPhys", "Law2_ScGeom_JKRWadaPhys_JKRWada", "JKRWadaEngine"):
    result[name] = pydoc.plain(pydoc.render_doc(globals()[name]))
""")
    assert "Surface energy gamma [J/m^2]" in found["JKRMat"]
    for text, word in (
        ("JKRWadaPhys", "overlap"),
        ("Ip2_JKRMat_JKRMat_JKRWadaPhys", "pairConstants"),
        ("Law2_ScGeom_JKRWadaPhys_JKRWada", "connection"),
        ("JKRWadaEngine", "subSteps"),
    ):
        assert word in found[text]


@pytest.mark.parametrize(
    "setting,message",
    [
        ("surfaceEnergy=-1", "surfaceEnergy = -1: must be > 0 [J/m^2]"),
        ("poisson=0.6", "poisson = 0.6: must be from 0 to 0.5"),
        ("poisson=0, viscoelasticTime=1e-12", "poisson = 0: must be from 0 to 0.5, and above 0 with drag"),
        ("criticalRolling=float('nan')", "criticalRolling = nan: must be > 0 [m]"),
    ],
)
def test_materials_out_of_range_are_refused_in_one_line(yade, setting, message):
    found = yade(f"""
from scenes import *
try:
    constants(ice({setting}), 1e-7)
    result["message"] = ""
except Exception as error:
    result["message"] = str(error)
""")
    assert message in found["message"] and "\\n" not in found["message"]


def test_energies_start_anew_after_they_are_cleared(yade):
    found = yade("""
from scenes import *
new_scene(0.1 * constants(ice(), 1e-7)["timeUnit"])
converging(8, 4, [ice()], [1e-7])
O.run(300, True)
result["before"] = energies()
O.energy.clear()
O.run(1, True)
result["after"] = energies()
""")
    assert found["before"]["connection"] > 0
    assert found["after"]["connection"] < found["before"]["connection"] and found["after"]["normal"] < 0


@pytest.mark.parametrize(
    "setting,message",
    [
        ("functor.neck = 2", "neck = 2: must be 0 (no bonds), or up to 0.7"),
        ("functor.linearDamping = -1", "linearDamping = -1: must be >= 0"),
        ("Ip2_JKRMat_JKRMat_JKRWadaPhys(linearDamping=float('nan'))", "linearDamping = nan: must be >= 0"),
        ("functor.slidingStiffnessFactor = 0", "slidingStiffnessFactor = 0: must be > 0"),
        ("material.surfaceEnergy = 0", "surfaceEnergy = 0: must be > 0 [J/m^2]"),
        ("JKRMat(young=-1)", "young = -1: must be > 0 [Pa]"),
    ],
)
def test_what_the_functors_cannot_do_is_refused_when_it_is_set(yade, setting, message):
    """Within a step YADE's threads could not pass an exception on: it would end the process."""
    found = yade(f"""
from scenes import *
functor, material = Ip2_JKRMat_JKRMat_JKRWadaPhys(), ice()
try:
    {setting}
except ValueError as error:
    result["message"] = str(error)
""")
    assert message in found["message"] and "\\n" not in found["message"]


def test_a_functor_keeps_no_value_that_it_refused(yade):
    """Where setting an attribute is refused, the one before stays."""
    found = yade("""
from scenes import *
functor = Ip2_JKRMat_JKRMat_JKRWadaPhys(linearDamping=0.5, neck=0.3)
for name, value in (("linearDamping", -1), ("neck", 0.9)):
    try:
        setattr(functor, name, value)
        result[name] = "not refused"
    except ValueError as error:
        result[name] = str(error)
result["kept"] = [functor.linearDamping, functor.neck]
""")
    assert "linearDamping = -1" in found["linearDamping"] and "neck = 0.9" in found["neck"]
    assert found["kept"] == [0.5, 0.3]
