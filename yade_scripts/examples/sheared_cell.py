"""A periodic cell is sheared at constant pressure, with YADE's own loop: shear stress against strain.

yade -n -x yade_scripts/examples/sheared_cell.py [material=ice pressure=3 side=5 seed=1 out=runs/sheared_cell]

The fused engine refuses sheared cells; it moves grains between two plates (utils.wall across z) that slide past each
other. study.py runs it for each row of a table with a column !SCRIPT.
"""

import os
import sys
from dataclasses import dataclass

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import numpy as np

import contact_law  # makes JKRMat and the other classes known
from yade_scripts.materials import MATERIALS, PROPERTIES
from yade_scripts.parameters import POSITIVE, SWITCH, Parameters, between, one_line_errors, one_of, parameter
from yade_scripts.run.parameters import FOLDER, from_arguments


@dataclass(frozen=True)
class ShearParameters(Parameters):
    """What a table or the command line may set."""

    material: str = parameter("ice", one_of(list(MATERIALS)), "of the grains")
    pressure: float = parameter(3.0, POSITIVE, "that is held", "gamma/r")
    side: int = parameter(5, between(3, 50), "grains along an edge")
    seed: int = parameter(1, POSITIVE, "of the places of the grains")
    out: str = parameter("runs/sheared_cell", FOLDER, "run folder")
    resume: int = parameter(0, SWITCH, "as study.py gives it")


with one_line_errors("sheared_cell.py"):
    given = ShearParameters.parse(from_arguments(sys.argv[1:]))
own, SIDE = MATERIALS[given.material], given.side
RADIUS, PRESSURE = own.grainRadius, given.pressure * own.surfaceEnergy / own.grainRadius  # m, Pa
SHEAR, GIVE = 5e-4, 1e-3  # 1/t0: rate of shear, and that of an edge which gives way to twice the pressure
grain = JKRMat(viscoelasticTime=6e-12, **{name: getattr(own, name) for name in PROPERTIES})
constants = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(grain, RADIUS, grain, RADIUS)

O.periodic = True
edge = 2.4 * RADIUS * SIDE
O.cell.setBox(edge, edge, edge)
stream = np.random.default_rng(given.seed)
for site in np.ndindex(SIDE, SIDE, SIDE):
    centre = (np.array(site) + 0.5 + stream.uniform(-0.08, 0.08, 3)) * edge / SIDE
    O.bodies.append(utils.sphere(centre, RADIUS, material=grain))


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
about = {"material": given.material, "pressure": given.pressure, "side": SIDE, "seed": given.seed}
run = contact_law.record(given.out, every=100, series=series, parameters=about, overwrite=True)
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
