"""An aggregate is stretched between its two ends until it breaks: strain, force, and the work that this takes.

yade -n -x yade_scripts/examples/stretching.py [RUN FOLDER]
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import numpy as np

import contact_law  # makes JKRMat and the other classes known
from analysis import fragment_labels
from yade_scripts import packings

GRAINS, RADIUS, VELOCITY = 300, 1e-7, 0.2  # m, m/s: of each end
ice = JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9, viscoelasticTime=6e-12)
constants = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice, RADIUS, ice, RADIUS)
overlap = constants["equilibriumOverlap"]
aggregate = packings.bpca(GRAINS, RADIUS, overlap, seed=1)
aggregate = packings.brought_to_rest(aggregate, RADIUS, overlap)
left, right = np.quantile(aggregate.position[:, 0], (0.1, 0.9))
for position in aggregate.position:
    O.bodies.append(utils.sphere(position, RADIUS, material=ice))
    if not left < position[0] < right:  # a tenth of the grains at each end moves as it is told
        O.bodies[-1].state.blockedDOFs = "xyzXYZ"
        O.bodies[-1].state.vel = (VELOCITY if position[0] > 0 else -VELOCITY, 0, 0)


def ends_hold_together():
    label = fragment_labels(GRAINS, contact_law.snapshot()["contact_pairs"])
    return label[aggregate.position[:, 0].argmin()] == label[aggregate.position[:, 0].argmax()]


O.engines = [JKRWadaEngine(subSteps=50)]
O.dt = 50 * 0.1 * constants["timeUnit"]
series = lambda: {"strain": 2 * VELOCITY * O.time / (right - left)}
run = contact_law.record(
    sys.argv[1] if len(sys.argv) > 1 else "runs/stretching", every=20, series=series, overwrite=True
)
while ends_hold_together():
    O.run(100, True)

work = -run.recent("constraintWork", O.time)  # on the grains
force = np.diff(work) / np.diff(2 * VELOCITY * run.recent("time", O.time))
print(
    f"broke at a strain of {series()['strain']:.2f}, after {work[-1] - work[0]:.2e} J; the largest force was "
    f"{force.max() / constants['pullOffForce']:.1f} pull-off forces"
)
sys.exit(0)
