"""Pressure of a compressed cluster by the virial, against the stress that YADE finds."""

import pytest
from scenes import *

from analysis.measures.periodic_cell import contact_pressure

pytestmark = pytest.mark.in_yade


def test_normal_forces_are_all_that_presses():
    """In a compressed cluster, whose contacts slide, roll and twist, the pressure of normal forces alone is a third of
    the trace of YADE's stress of all forces (which is positive in tension)."""
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
        shot = contact_law.snapshot()
        of_shot = ("position", "contact_pairs", "contact_normal_force", "cell_size")
        ours = contact_pressure(*map(shot.get, of_shot))
        O.engines[0].writeInteractions()
        stress = np.array(utils.getStress())
        rows.append([ours, -np.trace(stress) / 3, np.abs(np.diag(stress)).max()])
    ours, theirs, largest = np.array(rows).T
    assert energies()["rollingDissipation"] > 0 and len(ours) > 3 and largest.max() > 1e4
    assert ours == pytest.approx(theirs, abs=1e-8 * largest.max())
