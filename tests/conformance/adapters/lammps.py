"""LAMMPS, pair_style granular with JKR:  python3 adapters/lammps.py RESULTS.json [CASE ...]   (LMP=program, lmp)

In units of r = 0.1 um, 1 ns and r^3 g/cm^3, in which all numbers are near one. Options, by what they are in the law:
normal jkr; damping velocity is K13's drag, damping viscoelastic A22's; tangential linear_history has W07's k_s (mindlin scales
it with the contact radius), rolling sds and twisting sds W07's springs. Limits are friction coefficients: right at zero load.
"""

import os
import re
import subprocess
import sys
import tempfile
from math import inf, pi, sqrt
from pathlib import Path

import numpy as np
from answers import NotModelled, main

LMP, LENGTH, TIME, DENSITY = os.environ.get("LMP", "lmp"), 1e-7, 1e-9, 1000.0
MASS, HEAVY = DENSITY * LENGTH**3, 1e20  # of prescribed grains, against their density
FORCE = MASS * LENGTH / TIME**2
COLUMNS = "id x y z vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz"
SCRIPT = """units lj
atom_style sphere
boundary f f f
newton off
comm_modify vel yes
region box block -10 10 -10 10 -10 10
create_box {kinds} box
{grains}
pair_style granular
{pairs}
neighbor 0.3 bin
neigh_modify delay 0 every 1 check yes
fix move all nve/sphere
timestep {step!r}
dump all all custom 1 grains.dump {columns}
dump_modify all sort id format float %.17g first yes
thermo 1000000
{runs}
"""


def constants(m1, m2, r1, r2):
    """JKR-Wada's of a contact."""
    E = 1 / sum((1 - m["poisson"] ** 2) / m["young"] for m in (m1, m2))
    shear = [m["young"] / (2 + 2 * m["poisson"]) for m in (m1, m2)]
    G, R = 1 / sum((2 - m["poisson"]) / s for m, s in zip((m1, m2), shear)), 1 / (1 / r1 + 1 / r2)
    G_twist, gamma = 1 / sum(1 / s for s in shear), sqrt(m1["surface_energy"] * m2["surface_energy"])
    a0, pull = (9 * pi * gamma * R**2 / E) ** (1 / 3), 3 * pi * gamma * R
    masses = [4 / 3 * pi * m["density"] * r**3 for m, r in ((m1, r1), (m2, r2))]
    reduced = 1 / sum(1 / m for m in masses)
    t0 = 0.95 * sqrt(2 * reduced / (4 / 3 * pi * (2 * R) ** 3)) * (2 * R) ** (7 / 6) / (E ** (1 / 3) * gamma ** (1 / 6))
    found = dict(E=E, gamma=gamma, R=R, pull=pull, mass=reduced, t0=t0, roll=4 * pull / R, slide=8 * a0 * G)
    limits = dict(rolled=(m1["critical_rolling"] + m2["critical_rolling"]) / 2, slid=G_twist / G * a0 / (16 * pi))
    return {**found, **limits, "twist": 16 / 3 * G_twist * a0**3, "twisted": 1 / (16 * pi)}


def model(m1, m2, r1, r2, damping=0.0):
    """The words of pair_coeff and of fix wall/gran for a contact; r2 = inf: a plane."""
    c = constants(m1, m2, r1, r2)
    young = c["E"] * (1 - 0.25**2) * 2  # like grains of Poisson's ratio 0.25 with this E*
    viscous, drag = (
        sum(m["viscoelastic_time"] / m["poisson"] ** 2 for m in (m1, m2)) * c["E"],
        damping * 2 * c["mass"] / c["t0"],
    )
    if m1["viscoelastic_time"] or not damping:
        kind, drag = "viscoelastic", viscous / c["mass"] * LENGTH * TIME
    else:
        kind, drag = "velocity", drag * TIME / MASS
    load = 2 * c["pull"]  # LAMMPS's critical normal force at equilibrium
    stiffness = FORCE / LENGTH
    return (
        f"jkr {young * LENGTH**2 / FORCE!r} {drag!r} 0.25 {c['gamma'] / stiffness!r} "
        f"tangential linear_history {c['slide'] / stiffness!r} 0 {c['slide'] * c['slid'] / load!r} "
        f"rolling sds {c['roll'] / stiffness!r} 0 {c['roll'] * c['rolled'] / load!r} "
        f"twisting sds {c['twist'] / (FORCE * LENGTH)!r} 0 {c['twist'] * c['twisted'] / load / LENGTH!r} damping {kind}"
    )


def words(vector, unit=1.0):
    return " ".join(repr(x / unit) for x in vector)


def script(scene, materials, steps):
    grains, step = scene["grains"], scene["duration"] / steps
    kinds = [materials[g["material"]] for g in grains]
    runs, done = [], 0
    lines = [f"create_atoms {k} single {words(g['position'], LENGTH)}" for k, g in enumerate(grains, 1)]
    for k, (g, m) in enumerate(zip(grains, kinds), 1):
        density = m["density"] / DENSITY * (HEAVY if "prescribed" in scene else 1)
        lines.append(
            f"set atom {k} diameter {2 * g['radius'] / LENGTH!r} density {density!r} omega {words(g['spin'], 1 / TIME)}"
        )
        lines.append(f"group g{k} id {k}\nvelocity g{k} set {words(g['velocity'], LENGTH / TIME)} sum no")
    for segment in scene.get("prescribed", [dict(until=scene["duration"])]):
        for k in range(1, len(segment.get("velocity", ())) + 1):
            runs.append(f"velocity g{k} set {words(segment['velocity'][k - 1], LENGTH / TIME)} sum no")
            runs.append(f"set atom {k} omega {words(segment['spin'][k - 1], 1 / TIME)}")
        until = round(segment["until"] / step)
        runs.append(
            f"run {until - done} pre {'no' if done else 'yes'} post no"
        )  # a set-up would see history and new spins
        done = until
    each, pairs = list(enumerate(zip(kinds, (g["radius"] for g in grains)), 1)), []
    for i, (m1, r1) in each:
        pairs += [
            f"pair_coeff {i} {j} " + model(m1, m2, r1, r2, scene.get("linear_damping", 0.0))
            for j, (m2, r2) in each[i - 1 :]
        ]
    if "plane" in scene:
        contact = model(kinds[0], materials[scene["plane"]["material"]], grains[0]["radius"], inf)
        pairs.append(f"fix plane all wall/gran granular {contact} xplane 0 NULL")
    return SCRIPT.format(kinds=len(grains), grains="\n".join(lines), pairs="\n".join(pairs), step=step / TIME, columns=COLUMNS, runs="\n".join(runs))  # fmt: skip


def series_of(scene, materials, steps):
    if scene.get("neck"):
        raise NotModelled("pair_style granular has no sintered bonds")
    with tempfile.TemporaryDirectory() as folder:
        (Path(folder) / "in").write_text(script(scene, materials, steps))
        done = subprocess.run([LMP, "-in", "in", "-log", "none"], cwd=folder, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"{LMP}: {done.stdout[-2000:]}{done.stderr[-2000:]}")
        return series(Path(folder) / "grains.dump", scene, materials, steps)


def series(path, scene, materials, steps):
    count, frames = len(scene["grains"]), {}
    lines = path.read_text().split("\n")
    for k in range(0, len(lines) - 1, 9 + count):
        frames[int(lines[k + 1])] = [list(map(float, line.split()[1:])) for line in lines[k + 9 : k + 9 + count]]
    table = np.array([frames[k] for k in range(steps + 1)])
    units = (LENGTH, LENGTH / TIME, 1 / TIME, FORCE, FORCE * LENGTH)
    x, v, w, F, T = (table[:, :, 3 * k : 3 * k + 3] * unit for k, unit in enumerate(units))
    masses = [4 / 3 * pi * materials[g["material"]]["density"] * g["radius"] ** 3 for g in scene["grains"]]
    time = scene["duration"] / steps * np.arange(steps + 1)
    return dict(time=time, position=x, velocity=v, spin=w, force=F[:, 0], torque=T, mass=masses)


def version():
    said = subprocess.run([LMP, "-h"], capture_output=True, text=True).stdout
    return re.search(r"Simulator - (.+)", said)[1]


if __name__ == "__main__":
    main("LAMMPS", version(), series_of, sys.argv[1], sys.argv[2:])
