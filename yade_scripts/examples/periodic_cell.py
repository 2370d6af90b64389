"""A periodic cell of 64 grains shrinks: filling factor, pressure, and the work of the boundaries.

yade -n -x yade_scripts/examples/periodic_cell.py
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import numpy as np

import contact_law  # makes JKRMat and the other classes known

RADIUS, SIDE = 1e-7, 4  # m, grains along an edge
RATE = 2e-4  # 1/t0: how fast the edges shrink
ice = JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9)
constants = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice, RADIUS, ice, RADIUS)

O.periodic = True
edge = 2.02 * RADIUS * SIDE
O.cell.setBox(edge, edge, edge)
O.cell.homoDeform = 1  # grains move with the cell at the start
O.cell.velGrad = Matrix3.Identity * -(RATE / constants["timeUnit"])
for site in np.ndindex(SIDE, SIDE, SIDE):
    O.bodies.append(utils.sphere((np.array(site) + 0.5) * edge / SIDE, RADIUS, material=ice))

fused = JKRWadaEngine(subSteps=50)
O.engines = [fused]
O.dt = 50 * 0.1 * constants["timeUnit"]
O.trackEnergy = True
fused.prepare()
start = O.energy.total()

work = volume = None
for _ in range(8):
    O.run(5, True)
    before = (work, volume)
    state = contact_law.snapshot()
    work, volume = O.energy["boundaryWork"], np.prod(state["cell_size"])
    filling = len(O.bodies) * 4 / 3 * np.pi * RADIUS**3 / volume
    line = f"filling {filling:.4f}  contacts {len(state['contact_pairs']):4d}"
    if before[0] is not None:
        line += f"  pressure {(work - before[0]) / (volume - before[1]) + 0.0:.3e} Pa"
    print(line)
largest = max(abs(energy) for _, energy in O.energy.items())
print(f"all channels together changed by {abs(O.energy.total() - start) / largest:.1e} of the largest")
sys.exit(0)
