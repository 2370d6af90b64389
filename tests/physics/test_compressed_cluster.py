"""Pressure of periodic cells by the virial against closed forms: strained crystals, and a compressed cluster."""

import pytest
from scenes import *

from analysis.measures.virial import contact_pressure
from analysis.theory import ICE, normal_force, pair_constants

pytestmark = pytest.mark.in_yade
PAIR = pair_constants(ICE, 1e-7)


def pressure(shot):
    return contact_pressure(shot["position"], shot["contact_pairs"], shot["contact_normal_force"], shot["cell_size"])


def crystal(sites, edge):
    """(pressure [Pa], number of contacts) of grains at sites of a periodic cell."""
    new_scene(1e-11)
    periodic_cell(edge, edge, edge)
    for site in sites:
        grain(site, 1e-7, ice())
    fused_engine()
    O.engines[0].prepare()
    shot = contact_law.snapshot()
    return pressure(shot), len(shot["contact_pairs"])


@pytest.mark.parametrize("strain", [-0.004, 0.0, 0.01])
def test_strained_crystals(strain):
    """Simple cubic: F/a^2; face-centred cubic: 2 sqrt(2) F/a^2, a the distance of neighbours (12 n a F/6, n = sqrt(2)/a^3)."""
    a = (2e-7 - PAIR.equilibrium_overlap) * (1 - strain)
    force = float(normal_force(2e-7 - a, PAIR))
    cubic = a * np.stack(np.meshgrid(*3 * [np.arange(4)], indexing="ij"), axis=-1).reshape(-1, 3)
    corner = np.stack(np.meshgrid(*3 * [np.arange(3)], indexing="ij"), axis=-1).reshape(-1, 1, 3)
    basis = np.array([[0, 0, 0], [0, 0.5, 0.5], [0.5, 0, 0.5], [0.5, 0.5, 0]])
    fcc = (corner + basis).reshape(-1, 3) * 2**0.5 * a
    for sites, edge, contacts, expected in (
        (cubic, 4 * a, 192, force / a**2),
        (fcc, 3 * 2**0.5 * a, 648, 8**0.5 * force / a**2),
    ):
        found, number = crystal(sites, edge)
        # Without strain a contact has no force, and rounding of its overlap is all there is.
        assert number == (contacts if 2e-7 > a else 0)
        if number:
            assert found == pytest.approx(expected, rel=1e-6, abs=1e-6 * PAIR.pull_off_force / a**2)


def test_normal_forces_are_all_that_presses():
    """In a compressed cluster, whose contacts slide, roll and twist, the pressure of normal forces alone is a third of the
    trace of YADE's stress of all forces (which is positive in tension)."""
    from yade_scripts.experiments.compression import KIND

    scene = KIND.prepare(KIND.parse(dict(grains=64, strainRate=1e-4, stepFraction=0.2, threads=1)), 1)
    scene.build()
    O.dt = 20 * scene.time_step
    O.trackEnergy = True
    fused_engine(subSteps=20, threads=1, **scene.law)
    O.engines[0].prepare()
    rows = []
    while O.cell.hSize[0, 0] ** 3 > 64 * 4.19e-21 / 0.4:
        O.run(200, True)
        ours = pressure(contact_law.snapshot())
        O.engines[0].writeInteractions()
        stress = np.array(utils.getStress())
        rows.append([ours, -np.trace(stress) / 3, np.abs(np.diag(stress)).max()])
    ours, theirs, largest = np.array(rows).T
    assert energies()["rollingDissipation"] > 0 and len(ours) > 3 and largest.max() > 1e4
    assert ours == pytest.approx(theirs, abs=1e-8 * largest.max())
