"""set_material() changes the contacts of a running scene, and books what that takes from them."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade
BOTH = pytest.mark.parametrize("mover", ["functors", "fused"])
WORK = "constraintWork"


def running(mover, step=0.02, **options):
    """Thirty grains of two materials, one of them on a wall where nothing is bonded; returns the first material."""
    new_scene(step * unit, mover, **options)
    first = ice()
    cluster(30, 1, [first, soft()], [1e-7, 0.8e-7], 1.0, 1e6)
    if not options.get("neck"):
        O.bodies.append(utils.wall((0, 0, positions()[:, 2].min() - 0.99e-7), axis=2, material=first))
    O.run(round(20 / step), True)
    return first


CHANGES = [
    dict(surfaceEnergy=0.03),
    dict(surfaceEnergy=0.2),
    dict(young=4e9, poisson=0.3, viscoelasticTime=2e-12),
    dict(criticalRolling=1e-10),
]


@BOTH
@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("options", [{}, {"neck": 0.3}, {"limit": "cut"}])
def test_the_ledger_stays_closed(mover, change, options):
    """To rounding at the change, to second order in the steps after it."""
    material = running(mover, **options)
    kinetic, before, work = O.energy["kinetic"], O.energy.total(), O.energy[WORK]
    contact_law.set_material(material, **change)
    assert O.energy.total() == pytest.approx(before, abs=1e-12 * kinetic)
    O.step()
    assert O.energy.total() == pytest.approx(before, abs=1e-4 * kinetic)
    O.run(500, True)
    assert O.energy.total() == pytest.approx(before, abs=1e-3 * kinetic)
    if "surfaceEnergy" in change and not options.get("neck"):
        assert (O.energy[WORK] < work - kinetic) == (change["surfaceEnergy"] < 0.1)


@pytest.mark.parametrize("change", CHANGES)
def test_functors_and_engine_book_the_same_work(change):
    works = []
    for mover in ("functors", "fused"):
        material = running(mover, 0.01)
        contact_law.set_material(material, **change)
        O.step()
        works.append(O.energy[WORK] / O.energy["kinetic"])
    assert works[0] == pytest.approx(works[1], rel=1e-2, abs=1e-4)


@BOTH
def test_contacts_have_their_new_constants(mover):
    material = running(mover)
    O.materials.append(material)
    contact_law.set_material(len(O.materials) - 1, surfaceEnergy=0.05)
    O.step()
    if mover == "fused":
        O.engines[0].writeInteractions()
    for contact in O.interactions:
        one, other = O.bodies[contact.id1], O.bodies[contact.id2]
        if isinstance(one.shape, Sphere):
            wanted = constants(one.mat, one.shape.radius, other.mat, other.shape.radius)
            assert contact.phys.constants.pullOffForce == wanted["pullOffForce"]


@BOTH
def test_a_run_with_a_changed_material_is_saved_and_loaded_to_the_bit(mover):
    def end(saved):
        contact_law.set_material(running(mover), surfaceEnergy=0.05)
        if saved:
            saved_and_loaded()
        O.run(100, True)
        return all_states(), energies()

    assert end(False) == end(True)


@BOTH
def test_without_it_a_changed_material_is_refused(mover):
    material = running(mover)
    material.surfaceEnergy = 0.05
    message = refusal()
    assert "surfaceEnergy of the material of body " in message and "set_material()" in message
    material.surfaceEnergy = 0.1
    assert refusal() == ""
    for wrong in (dict(young=-1), dict(density=3000), dict(young=None), dict(viscoelasticTime=1e-9)):
        contact_law.set_material(material, surfaceEnergy=0.1)
        assert message_of(lambda: [contact_law.set_material(material, **wrong), O.step()])  # noqa: B023
