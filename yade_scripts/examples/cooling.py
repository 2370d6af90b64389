"""A spinning cluster cools: its surface energy falls with time, until grains fly off.

yade -n -x yade_scripts/examples/cooling.py
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import numpy as np

import contact_law  # makes JKRMat and the other classes known
from yade_scripts import packings

RADIUS, SPIN = 1e-7, 6e7  # m, rad/s
ice = JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9)
constants = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice, RADIUS, ice, RADIUS)

cluster = packings.cpe(0.4, 6e-7, RADIUS, constants["equilibriumOverlap"], 1, 0)
for position in cluster.position:
    grain = utils.sphere(position, RADIUS, material=ice)
    grain.state.vel = np.cross((0, 0, SPIN), position)
    grain.state.angVel = (0, 0, SPIN)
    O.bodies.append(grain)

O.engines = [JKRWadaEngine(subSteps=50)]
O.dt = 50 * 0.1 * constants["timeUnit"]  # 50 small steps of 0.1 t0
O.trackEnergy = True
O.engines[0].prepare()
start, scale = O.energy.total(), O.energy["kinetic"]

for gamma in np.linspace(0.1, 0.01, 10):  # J/m^2
    contact_law.set_material(ice, surfaceEnergy=gamma)  # with YADE's own engines too
    O.run(20, True)
    contacts = len(contact_law.snapshot()["contact_pairs"])
    work = -O.energy["constraintWork"] / scale
    print(f"{O.time:.2e} s: gamma {gamma:.2f} J/m^2, {contacts:3d} contacts, {work:.4f} K(0) done on the grains")
print(f"all channels together changed by {abs(O.energy.total() - start) / scale:.1e} K(0)")
sys.exit(0)
