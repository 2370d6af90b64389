"""A column of adhesive grains of many sizes collapses on a plate to a heap.

yade -n -x yade_scripts/examples/heap.py [RUN FOLDER]

A contact holds 20 times the weight of a grain (Bond number 20), as of ice grains of 0.7 mm on Earth. Five times give a
slope of 24 degrees; without adhesion grains of this law roll off each other.
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import numpy as np

import contact_law  # makes JKRMat and the other classes known

GRAINS, RADIUS, SPREAD, BOND = 300, 1e-7, 0.3, 20  # radius: the median [m]; spread: of its logarithm
ice = JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9, viscoelasticTime=6e-12)
constants = lambda radius: Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice, radius, ice, radius)
gravity = constants(RADIUS)["pullOffForce"] / BOND / (4 / 3 * np.pi * RADIUS**3 * ice.density)

stream = np.random.default_rng(1)
radii = RADIUS * np.exp(SPREAD * np.clip(stream.normal(size=GRAINS), -1.5, 1.5))
sites = [site for site in np.ndindex(20, 7, 7) if np.hypot(site[1] - 3, site[2] - 3) < 3.1]  # layer by layer
O.bodies.append(utils.wall(0, axis=2, material=ice))
for (layer, x, y), radius in zip(sites, radii.tolist()):
    centre = RADIUS * (3.3 * np.array([x, y, layer]) + (0, 0, 2) + stream.uniform(-0.1, 0.1, 3))
    grain = O.bodies.append(utils.sphere(centre, radius, material=ice))
    O.forces.setPermF(grain, (0, 0, -gravity * O.bodies[grain].state.mass))

O.engines = [JKRWadaEngine(subSteps=50)]
O.dt = 50 * 0.1 * constants(radii.min())["timeUnit"]
contact_law.record(sys.argv[1] if len(sys.argv) > 1 else "runs/heap", every=20, overwrite=True)
O.run(800, True)

end = contact_law.snapshot()
mass = end["radius"] ** 3
aside = end["position"][:, :2] - np.average(end["position"][:, :2], axis=0, weights=mass)
height = 4 * np.average(end["position"][:, 2], weights=mass)  # of a cone with the same moments
base = np.sqrt(10 / 3 * np.average((aside**2).sum(axis=1), weights=mass))
print(
    f"{GRAINS} grains, {len(end['contact_pairs'])} contacts, {len(end['plane_contacts'])} with the plate: a cone "
    f"{height / RADIUS:.1f} radii high, with a slope of {np.degrees(np.arctan(height / base)):.0f} degrees"
)
sys.exit(0)
