"""LAMMPS and LIGGGHTS.

    python3 adapters/lammps_family.py lammps|liggghts RESULTS.json [CASE ...]      LMP=program: of LAMMPS, lmp

Both run in units of r = 0.1 um, 1 ns and r^3 g/cm^3, in which all numbers are near one.

LAMMPS, pair_style granular, by what options are in the law: normal jkr; damping velocity is K13's drag, viscoelastic
A22's; tangential linear_history has W07's k_s (mindlin scales it with the contact radius), rolling sds and twisting sds
W07's springs. Limits are friction coefficients: right at zero load.
LIGGGHTS, Hertz with sjkr: the cohesion energy density is that which balances Hertz at JKR's equilibrium overlap;
friction coefficients are those of W07's limits under Hertz's force there.
"""

import os
import re
import subprocess
import sys
import tempfile
from math import pi, sqrt
from pathlib import Path

import numpy as np
from answers import NotModelled, main

LMP = os.environ.get("LMP", "lmp")
LENGTH, TIME, DENSITY = 1e-7, 1e-9, 1000.0
MASS, HEAVY = DENSITY * LENGTH**3, 1e20  # of prescribed grains, against their density
FORCE, STIFFNESS, PRESSURE = MASS * LENGTH / TIME**2, MASS / TIME**2, MASS / LENGTH / TIME**2
COLUMNS = "id x y z vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz"
OF_LAMMPS = """units lj
atom_style sphere
boundary f f f
newton off
comm_modify vel yes
read_data grains.data
pair_style granular
pair_coeff * * {contact}
{plane}
neighbor 0.3 bin
neigh_modify delay 0 every 1 check yes
fix move all nve/sphere
timestep {step!r}
dump all all custom 1 grains.dump {columns}
dump_modify all sort id format float %.17g first yes
thermo 1000000
{runs}
"""
OF_LIGGGHTS = """units si
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


def words(vector, unit=1.0):
    return " ".join(repr(x / unit) for x in vector)


def grains_file(scene, materials, kinds):
    """Of read_data: the scene's grains in a large box."""
    grains, heavy = scene["grains"], HEAVY if "prescribed" in scene else 1
    edges, atoms, moving = "".join(f"-10 10 {axis}lo {axis}hi\n" for axis in "xyz"), "", ""
    for k, (kind, g) in enumerate(zip(kinds, grains), 1):
        density = materials[g["material"]]["density"] / DENSITY * heavy
        atoms += f"{k} {kind} {2 * g['radius'] / LENGTH!r} {density!r} {words(g['position'], LENGTH)}\n"
        moving += f"{k} {words(g['velocity'], LENGTH / TIME)} {words(g['spin'], 1 / TIME)}\n"
    head = f"grains\n\n{len(grains)} atoms\n{max(kinds)} atom types\n\n{edges}"
    return f"{head}\nAtoms\n\n{atoms}\nVelocities\n\n{moving}"


def runs(scene, step, spin):
    """Commands that set prescribed motion, and run. spin(k, vector): the one that sets a spin."""
    found = [f"group g{k} id {k}" for k in range(1, len(scene["grains"]) + 1)]
    done = 0
    for segment in scene.get("prescribed", [dict(until=scene["duration"], velocity=[])]):
        for k, v in enumerate(segment["velocity"], 1):
            found += [f"velocity g{k} set {words(v, LENGTH / TIME)} units box", spin(k, segment["spin"][k - 1])]
        until = round(segment["until"] / step)
        # a set-up would meet history and new spins
        found.append(f"run {until - done} pre {'no' if done else 'yes'} post no")
        done = until
    return "\n".join(found)


def run(program, script, grains, scene, materials, steps):
    """The series that a program leaves of an input."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "in").write_text(script)
        Path(folder, "grains.data").write_text(grains)
        done = subprocess.run([program, "-in", "in", "-log", "none"], cwd=folder, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"{program}: {done.stdout[-2000:]}{done.stderr[-2000:]}")
        lines = Path(folder, "grains.dump").read_text().split("\n")
    count, frames = len(scene["grains"]), {}
    for k in range(0, len(lines) - 1, 9 + count):
        frames[int(lines[k + 1])] = [list(map(float, line.split()[1:])) for line in lines[k + 9 : k + 9 + count]]
    table = np.array([frames[k] for k in range(steps + 1)])
    units = (LENGTH, LENGTH / TIME, 1 / TIME, FORCE, FORCE * LENGTH)
    x, v, w, F, T = (table[:, :, 3 * k : 3 * k + 3] * unit for k, unit in enumerate(units))
    masses = [4 / 3 * pi * materials[g["material"]]["density"] * g["radius"] ** 3 for g in scene["grains"]]
    time = scene["duration"] / steps * np.arange(steps + 1)
    return dict(time=time, position=x, velocity=v, spin=w, force=F[:, 0], torque=T, mass=masses)


# ---- LAMMPS ----


def contact_words(c):
    """Of pair_coeff and of fix wall/gran, for the constants of a contact."""
    young, load = 2 * c["reduced_young"] * (1 - 0.25**2), 2 * c["pull_off_force"]  # the load that limits are shares of
    kind, drag = "viscoelastic", c["viscous_drag_per_contact_radius"] / c["reduced_mass"] * LENGTH * TIME
    if c["linear_drag"]:
        kind, drag = "velocity", c["linear_drag"] * TIME / MASS
    found = [f"jkr {young / PRESSURE!r} {drag!r} 0.25 {c['surface_energy'] / STIFFNESS!r}"]
    styles = {"sliding": ("tangential linear_history", 1.0), "rolling": ("rolling sds", 1.0)}
    for mode, (style, unit) in {**styles, "twisting": ("twisting sds", LENGTH)}.items():
        stiffness = c[f"{mode}_stiffness"]
        limit = stiffness * c[f"critical_{mode}"] / load
        found.append(f"{style} {stiffness / STIFFNESS / unit**2!r} 0 {limit / unit!r}")
    return " ".join([*found, "damping", kind])


def lammps_series(scene, materials, steps):
    if scene.get("neck"):
        raise NotModelled("not tried: bond_style bpm/rotational")
    step, contact = scene["duration"] / steps, contact_words(scene["contact"])
    plane = f"fix plane all wall/gran granular {contact} xplane 0 NULL" if "plane" in scene else ""
    commands = runs(scene, step, lambda k, w: f"set atom {k} omega {words(w, 1 / TIME)}")
    script = OF_LAMMPS.format(step=step / TIME, columns=COLUMNS, contact=contact, plane=plane, runs=commands)
    return run(LMP, script, grains_file(scene, materials, (1, 1)), scene, materials, steps)


# ---- LIGGGHTS ----


def liggghts_series(scene, materials, steps):
    c, kinds, step = scene["contact"], [materials[g["material"]] for g in scene["grains"]], scene["duration"] / steps
    if scene.get("neck") or "plane" in scene or c["linear_drag"] or c["viscous_drag_per_contact_radius"]:
        raise NotModelled("no sintered bonds" if scene.get("neck") else "not tried" if "plane" in scene else "no drag")
    d, (r1, r2) = c["equilibrium_overlap"], (g["radius"] for g in scene["grains"])
    distance = r1 + r2 - d
    area = pi / 4 * d * (distance + r1 - r2) * (distance - r1 + r2) * (distance + r1 + r2) / distance**2
    hertz = 4 / 3 * c["reduced_young"] * sqrt(c["reduced_radius"]) * d**1.5
    of_pair = dict(cohesion=hertz / area / PRESSURE, friction=c["sliding_stiffness"] * c["critical_sliding"] / hertz)
    of_pair["rolling"] = c["rolling_stiffness"] * c["critical_rolling"] / hertz
    texts = {name: " ".join([repr(value)] * 4) for name, value in of_pair.items()}
    texts |= dict(young=words([m["young"] for m in kinds], PRESSURE), poisson=words(m["poisson"] for m in kinds))
    spin = lambda k, w: f"set group g{k} omegax {w[0] * TIME!r} omegay {w[1] * TIME!r} omegaz {w[2] * TIME!r}"
    texts |= dict(columns=COLUMNS, format="%.17g " * 15, runs=runs(scene, step, spin))
    script = OF_LIGGGHTS.format(**texts, step=step / TIME)
    return run("liggghts", script, grains_file(scene, materials, (1, 2)), scene, materials, steps)


if __name__ == "__main__":
    code, path, *names = sys.argv[1:]
    program, series_of = (LMP, lammps_series) if code == "lammps" else ("liggghts", liggghts_series)
    help_text = subprocess.run([program, "-h"], cwd=tempfile.gettempdir(), capture_output=True, text=True).stdout
    main(code, re.search(r"Simulator - .+|LIGGGHTS-\S+ [\d.]+", help_text)[0], series_of, path, names)
