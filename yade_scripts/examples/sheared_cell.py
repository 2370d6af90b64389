"""A periodic cell is sheared at constant pressure, with YADE's own loop: shear stress against strain.

yade -n -x yade_scripts/examples/sheared_cell.py [RUN FOLDER]

The fused engine refuses sheared cells; it moves grains between two plates (utils.wall across z) that slide past each
other.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import numpy as np

import contact_law  # makes JKRMat and the other classes known

RADIUS, SIDE, PRESSURE = 1e-7, 5, 3e6  # m, grains along an edge, Pa
SHEAR, GIVE = 5e-4, 1e-3  # 1/t0: rate of shear, and that of an edge which gives way to twice the pressure
ice = JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9, viscoelasticTime=6e-12)
constants = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice, RADIUS, ice, RADIUS)

O.periodic = True
edge = 2.4 * RADIUS * SIDE
O.cell.setBox(edge, edge, edge)
stream = np.random.default_rng(1)
for site in np.ndindex(SIDE, SIDE, SIDE):
    centre = (np.array(site) + 0.5 + stream.uniform(-0.08, 0.08, 3)) * edge / SIDE
    O.bodies.append(utils.sphere(centre, RADIUS, material=ice))


def hold_pressure(shear=0.0):
    """Have edges give way to the pressure of the contacts, and the cell sheared along x, at a rate [1/t0]."""
    excess = np.clip(-np.diag(np.array(getStress())) / PRESSURE - 1, -1, 1)
    gradient = np.diag(GIVE * excess)
    gradient[0, 2] = shear
    O.cell.velGrad = Matrix3(*(gradient / constants["timeUnit"]).ravel().tolist())


def series():
    filling, stress = len(O.bodies) * 4 / 3 * np.pi * RADIUS**3 / O.cell.volume, np.array(getStress())
    found = {"stress": stress[0, 2], "pressure": -np.trace(stress) / 3, "filling": filling}
    return {"strain": O.cell.hSize[0, 2] / O.cell.hSize[2, 2], **found}


control = PyRunner(command="hold_pressure()", iterPeriod=20)
O.engines = [
    ForceResetter(),
    InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.1 * RADIUS),
    InteractionLoop(
        [Ig2_Sphere_Sphere_ScGeom()], [Ip2_JKRMat_JKRMat_JKRWadaPhys()], [Law2_ScGeom_JKRWadaPhys_JKRWada()]
    ),
    control,
    NewtonIntegrator(damping=0),
]
O.dt = 0.1 * constants["timeUnit"]
run = contact_law.record(
    sys.argv[1] if len(sys.argv) > 1 else "runs/sheared_cell", every=100, series=series, overwrite=True
)
O.run(5000, True)  # until the pressure is there
control.command = f"hold_pressure({SHEAR})"
O.run(10001, True)

half = 5000 * O.dt  # s: the last half of the shear
stress, pressure, filling = (run.recent(name, half) for name in ("stress", "pressure", "filling"))
print(
    f"sheared by {run.recent('strain')[0]:.2f}: over the last half the shear stress is "
    f"{stress.mean() / pressure.mean():.3f} of the pressure, which is {pressure.mean() / PRESSURE:.3f} of that held; "
    f"the filling factor rises from {filling[0]:.3f} to {filling[-1]:.3f}"
)
sys.exit(0)
