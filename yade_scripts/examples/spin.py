"""An aggregate is spun up until it breaks, by forces whose work the ledger books.

yade -n -x yade_scripts/examples/spin.py [RUN FOLDER]
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import numpy as np

import contact_law  # makes JKRMat and the other classes known
from analysis import fragment_labels
from yade_scripts import packings

GRAINS, RADIUS, RATE = 300, 1e-7, 3e13  # m, rad/s^2
ice = JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9, viscoelasticTime=6e-12)
constants = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice, RADIUS, ice, RADIUS)
aggregate = packings.bpca(GRAINS, RADIUS, constants["equilibriumOverlap"], seed=1)
for position in aggregate.position:
    O.bodies.append(utils.sphere(position, RADIUS, material=ice))


def spin_up():
    """Forces and torques of RATE about z, which act throughout the next O.step."""
    for body in O.bodies:
        x, y, _ = body.state.pos
        O.forces.addF(body.id, RATE * body.state.mass * Vector3(-y, x, 0))
        O.forces.addT(body.id, RATE * body.state.inertia[2] * Vector3(0, 0, 1))


def spin():
    """Angular velocity [rad/s] about z of a rigid body with this angular momentum."""
    state = contact_law.snapshot()
    (x, y, _), (vx, vy, _), turn = state["position"].T, state["velocity"].T, state["angular_velocity"][:, 2]
    own = 0.4 * RADIUS**2
    return (x * vy - y * vx + own * turn).sum() / (x**2 + y**2 + own).sum()


def pieces():
    return np.bincount(fragment_labels(GRAINS, contact_law.snapshot()["contact_pairs"]))


O.engines = [PyRunner(command="spin_up()", iterPeriod=1), JKRWadaEngine(subSteps=50)]
O.dt = 50 * 0.1 * constants["timeUnit"]
series = lambda: {"spin": spin(), "pieces": len(pieces())}
contact_law.record(sys.argv[1] if len(sys.argv) > 1 else "runs/spin", every=10, series=series, overwrite=True)
fastest = 0.0
while len(pieces()) == 1:
    O.run(40, True)
    fastest = max(fastest, spin())

print(f"{GRAINS} grains broke at {fastest:.2e} rad/s, after {O.time:.2e} s; the pieces have {pieces().tolist()} grains")
sys.exit(0)
