"""A grain hits a cluster of 200: where the energy goes, with the fused engine.

yade -n -x yade_scripts/examples/cluster.py
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import contact_law  # makes JKRMat and the other classes known
from yade_scripts import packings

RADIUS, VELOCITY = 1e-7, 20.0  # m, m/s
ice = JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9)
constants = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice, RADIUS, ice, RADIUS)

cluster = packings.bcca(200, RADIUS, constants["equilibriumOverlap"], seed=3)
for position in cluster.position:
    O.bodies.append(utils.sphere(position, RADIUS, material=ice))
outermost = cluster.position[cluster.position[:, 0].argmax()]
projectile = utils.sphere(outermost + (3 * RADIUS, 0, 0), RADIUS, material=ice)
projectile.state.vel = (-VELOCITY, 0, 0)
O.bodies.append(projectile)

fused = JKRWadaEngine(subSteps=50)
O.engines = [fused]
O.dt = 50 * 0.1 * constants["timeUnit"]  # 50 small steps of 0.1 t0
O.trackEnergy = True
fused.prepare()  # energies and contacts of the start
start = dict(O.energy.items())
contacts = len(contact_law.snapshot()["contact_pairs"])
O.run(200, True)

end = contact_law.snapshot()
print(f"{len(cluster.radius)} grains, {contacts} contacts; after {end['time']:.3g} s {len(end['contact_pairs'])}")
for channel, energy in O.energy.items():
    change = energy - start.get(channel, 0.0)
    print(f"{channel:20s} {change / start['kinetic']:+.4f} K(0)")
print(f"{'sum':20s} {(O.energy.total() - sum(start.values())) / start['kinetic']:+.1e} K(0)")
sys.exit(0)
