"""LIGGGHTS, Hertz with sjkr:  python3 adapters/liggghts.py RESULTS.json [CASE ...]

The cohesion energy density is that which balances Hertz at JKR's
equilibrium overlap; friction coefficients are those of W07's limits under Hertz's force there.
"""

import re
import subprocess
import sys
import tempfile
from math import pi, sqrt

from answers import NotModelled, main
from lammps_family import COLUMNS, PRESSURE, TIME, grains_of, run, runs, words

SCRIPT = """units si
atom_style granular
boundary f f f
newton off
communicate single vel yes
read_data grains.data
soft_particles yes
neighbor 0.3 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype {young}
fix m2 all property/global poissonsRatio peratomtype {poisson}
fix m3 all property/global coefficientRestitution peratomtypepair 2 1 1 1 1
fix m4 all property/global coefficientFriction peratomtypepair 2 {friction}
fix m5 all property/global cohesionEnergyDensity peratomtypepair 2 {cohesion}
fix m6 all property/global coefficientRollingFriction peratomtypepair 2 {rolling}
fix m7 all property/global coefficientRollingViscousDamping peratomtypepair 2 0 0 0 0
pair_style gran model hertz tangential history cohesion sjkr rolling_friction epsd2
pair_coeff * *
timestep {step!r}
fix move all nve/sphere
dump all all custom 1 grains.dump {columns}
dump_modify all sort id format "%d {format}" first yes
thermo 1000000
{runs}
"""


def script(scene, materials, steps):
    c, kinds, step = scene["contact"], [materials[g["material"]] for g in scene["grains"]], scene["duration"] / steps
    d, (r1, r2) = c["equilibrium_overlap"], (g["radius"] for g in scene["grains"])
    distance = r1 + r2 - d
    area = pi / 4 * d * (distance + r1 - r2) * (distance - r1 + r2) * (distance + r1 + r2) / distance**2
    hertz = 4 / 3 * c["reduced_young"] * sqrt(c["reduced_radius"]) * d**1.5
    of_pair = dict(cohesion=hertz / area / PRESSURE, friction=c["sliding_stiffness"] * c["critical_sliding"] / hertz)
    of_pair["rolling"] = c["rolling_stiffness"] * c["critical_rolling"] / hertz
    texts = {name: " ".join([repr(value)] * 4) for name, value in of_pair.items()}
    texts |= dict(young=words([m["young"] for m in kinds], PRESSURE), poisson=words(m["poisson"] for m in kinds))
    spin = lambda k, w: f"set group g{k} omegax {w[0] * TIME!r} omegay {w[1] * TIME!r} omegaz {w[2] * TIME!r}"
    return SCRIPT.format(**texts, step=step / TIME, columns=COLUMNS, format="%.17g " * 15, runs="\n".join(runs(scene, step, spin)))  # fmt: skip


def series_of(scene, materials, steps):
    c = scene["contact"]
    drag = c["linear_drag"] or c["viscous_drag_per_contact_radius"]
    if scene.get("neck") or "plane" in scene or drag:
        why = "no sintered bonds" if scene.get("neck") else "no such drag" if drag else "not tried: fix wall/gran"
        raise NotModelled(why)
    files = {"in": script(scene, materials, steps), "grains.data": grains_of(scene, materials, (1, 2))}
    return run(["liggghts"], files, scene, materials, steps)


if __name__ == "__main__":
    said = subprocess.run(["liggghts", "-h"], cwd=tempfile.gettempdir(), capture_output=True, text=True).stdout
    main("LIGGGHTS", re.search(r"LIGGGHTS-\S+ [\d.]+", said)[0], series_of, sys.argv[1], sys.argv[2:])
