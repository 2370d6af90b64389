"""Two grains of ice fly at each other: below the sticking velocity they stick, above it they part.

yade -n -x yade_scripts/examples/pair.py
"""

import os
import sys

sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
import contact_law  # makes JKRMat and the other classes known

RADIUS = 1e-7  # m
ice = JKRMat(young=7e9, poisson=0.25, density=1000, surfaceEnergy=0.1, criticalRolling=0.8e-9)
constants = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice, RADIUS, ice, RADIUS)
# What a contact takes when it forms and breaks: (8/15 2^(2/3) + 4/45) F_c delta_c (Arakawa et al. 2022, eqs 9, 10), all
# of m* v^2/2
lost = (8 / 15 * 2 ** (2 / 3) + 4 / 45) * constants["pullOffForce"] * constants["pullOffOverlap"]
sticking = (2 * lost / constants["reducedMass"]) ** 0.5


def collide(velocity):
    """(number of contacts at the end, relative velocity [m/s] over the one at the start)."""
    O.reset()
    for side in (-1, 1):
        grain = utils.sphere((side * 1.01 * RADIUS, 0, 0), RADIUS, material=ice)
        grain.state.vel = (-side * velocity / 2, 0, 0)
        O.bodies.append(grain)
    O.engines = [
        ForceResetter(),
        InsertionSortCollider([Bo1_Sphere_Aabb()], verletDist=0.1 * RADIUS),
        InteractionLoop(
            [Ig2_Sphere_Sphere_ScGeom()], [Ip2_JKRMat_JKRMat_JKRWadaPhys()], [Law2_ScGeom_JKRWadaPhys_JKRWada()]
        ),
        NewtonIntegrator(damping=0),
    ]
    O.dt = 0.02 * constants["timeUnit"]
    O.run(int(0.4 * RADIUS / velocity / O.dt) + 5000, True)
    apart = O.bodies[1].state.vel[0] - O.bodies[0].state.vel[0]
    return len(contact_law.snapshot()["contact_pairs"]), apart / velocity


print(f"sticking velocity without drag: {sticking:.4f} m/s")
for fraction in (0.5, 0.95, 1.05, 2.0):
    contacts, restitution = collide(fraction * sticking)
    print(f"{fraction:4.2f} of it: {'stick' if contacts else f'part, restitution {restitution:.3f}'}")
sys.exit(0)
