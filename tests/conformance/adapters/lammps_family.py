"""What LAMMPS and LIGGGHTS share: units of r = 0.1 um, 1 ns and r^3 g/cm^3, in which all numbers are near one, and their output."""

import subprocess
import sys
import tempfile
from math import pi
from pathlib import Path

import numpy as np

LENGTH, TIME, DENSITY = 1e-7, 1e-9, 1000.0
MASS, HEAVY = DENSITY * LENGTH**3, 1e20  # of prescribed grains, against their density
FORCE, STIFFNESS, PRESSURE = MASS * LENGTH / TIME**2, MASS / TIME**2, MASS / LENGTH / TIME**2
COLUMNS = "id x y z vx vy vz omegax omegay omegaz fx fy fz tqx tqy tqz"


def words(vector, unit=1.0):
    return " ".join(repr(x / unit) for x in vector)


def grains_file(reach, kinds, diameters, densities, position, velocity, spin):
    """Of read_data, for grains in a box of this reach; SI units but for diameters and densities."""
    edges, atoms, moving = "".join(f"{-reach!r} {reach!r} {axis}lo {axis}hi\n" for axis in "xyz"), "", ""
    each = zip(kinds, diameters, densities, position, velocity, spin)
    for k, (kind, diameter, density, x, v, w) in enumerate(each, 1):
        atoms += f"{k} {kind} {diameter!r} {density!r} {words(x, LENGTH)}\n"
        moving += f"{k} {words(v, LENGTH / TIME)} {words(w, 1 / TIME)}\n"
    return f"grains\n\n{k} atoms\n{max(kinds)} atom types\n\n{edges}\nAtoms\n\n{atoms}\nVelocities\n\n{moving}"


def grains_of(scene, materials, kinds):
    """The same of a scene."""
    grains, heavy = scene["grains"], HEAVY if "prescribed" in scene else 1
    densities = [materials[g["material"]]["density"] / DENSITY * heavy for g in grains]
    motion = ([g[name] for g in grains] for name in ("position", "velocity", "spin"))
    return grains_file(10, kinds, [2 * g["radius"] / LENGTH for g in grains], densities, *motion)


def runs(scene, step, spin):
    """Commands that set prescribed motion, and run. spin(k, vector): the one that sets a spin."""
    yield from (f"group g{k} id {k}" for k in range(1, len(scene["grains"]) + 1))
    done = 0
    for segment in scene.get("prescribed", [dict(until=scene["duration"], velocity=[])]):
        for k, v in enumerate(segment["velocity"], 1):
            yield f"velocity g{k} set {words(v, LENGTH / TIME)} units box\n{spin(k, segment['spin'][k - 1])}"
        until = round(segment["until"] / step)
        yield f"run {until - done} pre {'no' if done else 'yes'} post no"  # a set-up would meet history and new spins
        done = until


def left_by(program, files, name):
    """The text of the file `name` that a program leaves, which is given files {name: text} and the input `in` among them."""
    with tempfile.TemporaryDirectory() as folder:
        for file, text in files.items():
            (Path(folder) / file).write_text(text)
        done = subprocess.run([*program, "-in", "in", "-log", "none"], cwd=folder, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"{program[0]}: {done.stdout[-2000:]}{done.stderr[-2000:]}")
        return (Path(folder) / name).read_text()


def run(program, files, scene, materials, steps):
    """The series that a program leaves of the input `in`."""
    lines = left_by(program, files, "grains.dump").split("\n")
    count, frames = len(scene["grains"]), {}
    for k in range(0, len(lines) - 1, 9 + count):
        frames[int(lines[k + 1])] = [list(map(float, line.split()[1:])) for line in lines[k + 9 : k + 9 + count]]
    table = np.array([frames[k] for k in range(steps + 1)])
    units = (LENGTH, LENGTH / TIME, 1 / TIME, FORCE, FORCE * LENGTH)
    x, v, w, F, T = (table[:, :, 3 * k : 3 * k + 3] * unit for k, unit in enumerate(units))
    masses = [4 / 3 * pi * materials[g["material"]]["density"] * g["radius"] ** 3 for g in scene["grains"]]
    time = scene["duration"] / steps * np.arange(steps + 1)
    return dict(time=time, position=x, velocity=v, spin=w, force=F[:, 0], torque=T, mass=masses)
