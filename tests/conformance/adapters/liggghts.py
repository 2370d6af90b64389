"""LIGGGHTS, Hertz with sjkr:  python3 adapters/liggghts.py RESULTS.json [CASE ...]

In the units of lammps.py, whose output has the same form. The cohesion energy density is that which balances Hertz at JKR's
equilibrium overlap; friction coefficients are those of W07's limits under Hertz's force there.
"""

import re
import subprocess
import sys
import tempfile
from math import pi, sqrt
from pathlib import Path

from answers import NotModelled, main
from lammps import COLUMNS, DENSITY, FORCE, HEAVY, LENGTH, TIME, constants, series, words

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
fix m3 all property/global coefficientRestitution peratomtypepair {kinds} {one}
fix m4 all property/global coefficientFriction peratomtypepair {kinds} {friction}
fix m5 all property/global cohesionEnergyDensity peratomtypepair {kinds} {cohesion}
fix m6 all property/global coefficientRollingFriction peratomtypepair {kinds} {rolling}
fix m7 all property/global coefficientRollingViscousDamping peratomtypepair {kinds} {zero}
pair_style gran model hertz tangential history cohesion sjkr rolling_friction epsd2
pair_coeff * *
timestep {step!r}
fix move all nve/sphere
group g1 id 1
group g2 id 2
dump all all custom 1 grains.dump {columns}
dump_modify all sort id format "%d {format}" first yes
thermo 1000000
{runs}
"""


def of_pair(m1, m2, r1, r2):
    """(friction, cohesion energy density, rolling friction) of a contact."""
    c = constants(m1, m2, r1, r2)
    d0 = (9 * pi * c["gamma"] * c["R"] ** 2 / c["E"]) ** (2 / 3) / (3 * c["R"])
    distance = r1 + r2 - d0
    area = pi / 4 * d0 * (distance + r1 - r2) * (distance - r1 + r2) * (distance + r1 + r2) / distance**2
    hertz = 4 / 3 * c["E"] * sqrt(c["R"]) * d0**1.5
    return c["slide"] * c["slid"] / hertz, hertz / area * LENGTH**2 / FORCE, c["roll"] * c["rolled"] / hertz


def script(scene, materials, steps):
    grains, step = scene["grains"], scene["duration"] / steps
    kinds = [materials[g["material"]] for g in grains]
    one, both, two = (
        [kinds[i], kinds[j], grains[i]["radius"], grains[j]["radius"]] for i, j in ((0, 0), (0, 1), (1, 1))
    )
    pairs = [of_pair(*pair) for pair in (one, both, both, two)]
    friction, cohesion, rolling = ([repr(pair[k]) for pair in pairs] for k in range(3))
    runs, done = [], 0
    for segment in scene.get("prescribed", [dict(until=scene["duration"], velocity=[])]):
        for k in range(1, len(segment["velocity"]) + 1):
            runs.append(f"velocity g{k} set {words(segment['velocity'][k - 1], LENGTH / TIME)} units box")
            x, y, z = (repr(w * TIME) for w in segment["spin"][k - 1])
            runs.append(f"set group g{k} omegax {x} omegay {y} omegaz {z}")
        until = round(segment["until"] / step)
        runs.append(f"run {until - done} pre {'no' if done else 'yes'} post no")
        done = until
    each = dict(young=" ".join(repr(m["young"] * LENGTH**2 / FORCE) for m in kinds), poisson=" ".join(repr(m["poisson"]) for m in kinds))  # fmt: skip
    numbers = dict(friction=friction, cohesion=cohesion, rolling=rolling, one=["1.0"] * 4, zero=["0.0"] * 4)
    return SCRIPT.format(**each, **{name: " ".join(v) for name, v in numbers.items()}, kinds=2, step=step / TIME, columns=COLUMNS, format="%.17g " * 15, runs="\n".join(runs))  # fmt: skip


def data(scene, materials):
    rows = [
        "grains",
        "",
        "2 atoms",
        "2 atom types",
        "",
        *(f"-10 10 {axis}lo {axis}hi" for axis in "xyz"),
        "",
        "Atoms",
        "",
    ]
    for k, g in enumerate(scene["grains"], 1):
        density = materials[g["material"]]["density"] / DENSITY * (HEAVY if "prescribed" in scene else 1)
        rows.append(f"{k} {k} {2 * g['radius'] / LENGTH!r} {density!r} {words(g['position'], LENGTH)}")
    moving = [
        f"{k} {words(g['velocity'], LENGTH / TIME)} {words(g['spin'], 1 / TIME)}"
        for k, g in enumerate(scene["grains"], 1)
    ]
    return "\n".join([*rows, "", "Velocities", "", *moving, ""])


def series_of(scene, materials, steps):
    kinds = [materials[g["material"]] for g in scene["grains"]]
    if (
        scene.get("neck")
        or "plane" in scene
        or scene.get("linear_damping")
        or any(m["viscoelastic_time"] for m in kinds)
    ):
        missing = "no sintered bonds" if scene.get("neck") else "planes (fix wall/gran) not tried" if "plane" in scene else "no such drag"  # fmt: skip
        raise NotModelled(missing)
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "in").write_text(script(scene, materials, steps))
        (Path(folder) / "grains.data").write_text(data(scene, materials))
        done = subprocess.run(["liggghts", "-in", "in", "-log", "none"], cwd=folder, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"liggghts: {done.stdout[-2000:]}{done.stderr[-2000:]}")
        return series(Path(folder) / "grains.dump", scene, materials, steps)


if __name__ == "__main__":
    said = subprocess.run(["liggghts", "-h"], cwd=tempfile.gettempdir(), capture_output=True, text=True).stdout
    main("LIGGGHTS", re.search(r"LIGGGHTS-\S+ [\d.]+", said)[0], series_of, sys.argv[1], sys.argv[2:])
