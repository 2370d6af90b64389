"""LAMMPS and LIGGGHTS.

    python3 adapters/lammps_family.py lammps|liggghts RESULTS.json [CASE ...]      LMP=program: of LAMMPS, lmp

Both run in units of r = 0.1 um, 1 ns and r^3 g/cm^3, in which all numbers are near one. What does not concern the cases
serves the benchmarks too (tests/benchmarks/peers.py).

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
OF_LAMMPS = """units lj
atom_style sphere
boundary {boundary}
newton {newton}
comm_modify vel yes
{before}
read_data grains.data
pair_style granular
pair_coeff * * {contact}
neighbor {skin!r} bin
neigh_modify delay 0 every 1 check yes {neighbours}
fix move all nve/sphere
timestep {step!r}
{commands}
"""
OF_LIGGGHTS = """units si
atom_style granular
boundary {boundary}
newton {newton}
communicate single vel yes
{before}
read_data grains.data
soft_particles yes
neighbor {skin!r} bin
neigh_modify delay 0
{contact}
pair_style gran model hertz tangential history cohesion sjkr rolling_friction epsd2
pair_coeff * *
timestep {step!r}
fix move all nve/sphere
{commands}
"""
# sorting may swap the grains of a pair, whose springs then jump (free-rotation: spins off by 3e-2)
OPEN_SPACE = dict(boundary="f f f", newton="off", before="atom_modify sort 0 0", skin=0.3, neighbours="")


# ---- what the benchmarks have as well ----


def data_file(kind, radius, density, position, velocity, spin, box):
    """Of read_data: arrays of grains, a row each; kind: 1 or 2; box: its edges, in LENGTH; the rest in SI."""
    edges = "".join(f"{low!r} {high!r} {axis}lo {axis}hi\n" for axis, (low, high) in zip("xyz", box))
    columns = np.broadcast_to(kind, len(radius)), 2 * radius / LENGTH, density / DENSITY * np.ones(len(radius))
    atoms = zip(*(column.tolist() for column in columns), (position / LENGTH).tolist())
    moving = np.hstack([velocity / (LENGTH / TIME), spin / (1 / TIME)]).tolist()
    lines = [f"grains\n\n{len(radius)} atoms\n2 atom types\n\n{edges}\nAtoms\n"]
    lines += [f"{k} {kind} {size!r} {rho!r} {numbers(x)}" for k, (kind, size, rho, x) in enumerate(atoms, 1)]
    lines += ["\nVelocities\n", *(f"{k} {numbers(row)}" for k, row in enumerate(moving, 1))]
    return "\n".join(lines) + "\n"


def numbers(row, unit=1.0):
    return " ".join(repr(x / unit) for x in row)


def contact_of_lammps(c):
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


def contact_of_liggghts(c, radii, young, poisson):
    """Properties of the contacts of grains with the constants c, and with these radii, moduli and ratios."""
    d, (r1, r2) = c["equilibrium_overlap"], radii
    distance = r1 + r2 - d
    area = pi / 4 * d * (distance + r1 - r2) * (distance - r1 + r2) * (distance + r1 + r2) / distance**2
    hertz = 4 / 3 * c["reduced_young"] * sqrt(c["reduced_radius"]) * d**1.5
    properties = {
        "youngsModulus peratomtype": numbers(young, PRESSURE),
        "poissonsRatio peratomtype": numbers(poisson),
        "coefficientRestitution peratomtypepair 2": numbers([1.0] * 4),
        "coefficientFriction peratomtypepair 2": numbers([c["sliding_stiffness"] * c["critical_sliding"] / hertz] * 4),
        "cohesionEnergyDensity peratomtypepair 2": numbers([hertz / area / PRESSURE] * 4),
        "coefficientRollingFriction peratomtypepair 2": numbers(
            [c["rolling_stiffness"] * c["critical_rolling"] / hertz] * 4
        ),
        "coefficientRollingViscousDamping peratomtypepair 2": numbers([0.0] * 4),
    }
    return "\n".join(f"fix m{k} all property/global {name} {text}" for k, (name, text) in enumerate(properties.items()))


# ---- cases ----


def runs(scene, step, set_spin):
    """Commands that set prescribed motion, and run. set_spin(k, vector): the one that sets a spin."""
    found = [f"group g{k} id {k}" for k in range(1, len(scene["grains"]) + 1)]
    done = 0
    for segment in scene.get("prescribed", [dict(until=scene["duration"], velocity=[])]):
        for k, v in enumerate(segment["velocity"], 1):
            found.append(f"velocity g{k} set {numbers(v, LENGTH / TIME)} units box")
            found.append(set_spin(k, numbers(segment["spin"][k - 1], 1 / TIME)))
        until = round(segment["until"] / step)
        # a set-up would meet history and new spins
        found.append(f"run {until - done} pre {'no' if done else 'yes'} post no")
        done = until
    return "\n".join(found)


def run(program, template, contact, set_spin, format, before, scene, materials, steps):
    """The series of a scene; format: of the numbers that are dumped; before: commands."""
    grains, step = scene["grains"], scene["duration"] / steps
    columns = {name: np.array([g[name] for g in grains]) for name in ("radius", "position", "velocity", "spin")}
    reach = 10 + float(abs(columns["position"]).max()) / LENGTH
    density, box = np.array([materials[g["material"]]["density"] for g in grains]), ((-reach, reach),) * 3
    heavy = density * HEAVY if "prescribed" in scene else density
    dump = "dump all all custom 1 grains.dump id x y z vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz"
    dumped = f"dump_modify all sort id format {format} first yes\nthermo 1000000"
    commands = "\n".join([before, dump, dumped, runs(scene, step, set_spin)])
    with tempfile.TemporaryDirectory() as folder:
        script = template.format(**OPEN_SPACE, contact=contact, step=step / TIME, commands=commands)
        Path(folder, "in").write_text(script)
        kinds = np.minimum(np.arange(1, len(grains) + 1), 2)  # of more grains all are alike
        Path(folder, "grains.data").write_text(data_file(kinds, density=heavy, box=box, **columns))
        done = subprocess.run([program, "-in", "in", "-log", "none"], cwd=folder, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"{program}: {done.stdout[-2000:]}{done.stderr[-2000:]}")
        lines = Path(folder, "grains.dump").read_text().split("\n")
    count, frames = len(grains), {}
    for k in range(0, len(lines) - 1, 9 + count):
        frames[int(lines[k + 1])] = [list(map(float, line.split()[1:])) for line in lines[k + 9 : k + 9 + count]]
    table = np.array([frames[k] for k in range(steps + 1)])
    units = (LENGTH, LENGTH / TIME, 1 / TIME, FORCE, FORCE * LENGTH)
    x, v, w, F, T = (table[:, :, 3 * k : 3 * k + 3] * unit for k, unit in enumerate(units))
    mass = 4 / 3 * pi * density * columns["radius"] ** 3
    return dict(time=step * np.arange(steps + 1), position=x, velocity=v, spin=w, force=F[:, 0], torque=T, mass=mass)


def lammps_series(scene, materials, steps):
    if scene.get("neck"):
        raise NotModelled("not tried: bond_style bpm/rotational")
    contact = contact_of_lammps(scene["contact"])
    plane = f"fix plane all wall/gran granular {contact} xplane 0 NULL" if "plane" in scene else ""
    set_spin = lambda k, spin: f"set atom {k} omega {spin}"
    return run(LMP, OF_LAMMPS, contact, set_spin, "float %.17g", plane, scene, materials, steps)


def liggghts_series(scene, materials, steps):
    c, kinds = scene["contact"], [materials[g["material"]] for g in scene["grains"][:2]]
    if scene.get("neck") or "plane" in scene or c["linear_drag"] or c["viscous_drag_per_contact_radius"]:
        raise NotModelled("no sintered bonds" if scene.get("neck") else "not tried" if "plane" in scene else "no drag")
    young, poisson = ([material[name] for material in kinds] for name in ("young", "poisson"))
    contact = contact_of_liggghts(c, [g["radius"] for g in scene["grains"][:2]], young, poisson)
    set_spin = lambda k, spin: "set group g{} omegax {} omegay {} omegaz {}".format(k, *spin.split())
    format = '"%d ' + "%.17g " * 15 + '"'
    return run("liggghts", OF_LIGGGHTS, contact, set_spin, format, "", scene, materials, steps)


if __name__ == "__main__":
    code, path, *names = sys.argv[1:]
    program, series_of = (LMP, lammps_series) if code == "lammps" else ("liggghts", liggghts_series)
    printed = subprocess.run([program, "-h"], cwd=tempfile.gettempdir(), capture_output=True, text=True).stdout
    main(code, re.search(r"Simulator - .+|LIGGGHTS-\S+ [\d.]+", printed)[0], series_of, path, names)
