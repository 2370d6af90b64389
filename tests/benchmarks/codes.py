"""The codes that run a scene of a file (scene_file.py): in YADE, LAMMPS and LIGGGHTS, and the engine without YADE.

open_code(...).measure(threads, seconds, most) returns {contacts (mean of the touching pairs at start and end), steps,
seconds}. LAMMPS and LIGGGHTS have units, contact constants and inputs of the conformance suite's adapter; they run one
material and one size only, contacts start without springs, and a periodic cell keeps its size.
"""

import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from functools import lru_cache
from itertools import product
from pathlib import Path

import numpy as np
import scene_file

HERE = Path(__file__).resolve().parent
TOP = HERE.parents[1]
sys.path[:0] = [str(TOP), str(TOP / "tests/conformance/adapters")]
import lammps_family
from lammps_family import LENGTH, TIME

from analysis.theory import Material, pair_constants

HARNESS = TOP / "build/harness"
NEWEST = TOP / "build/lammps"  # PyPI's, with an MPI of its own (make peers)
ENVIRONMENT = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMP_NUM_THREADS": "1"}
ENVIRONMENT["LD_LIBRARY_PATH"] = str(NEWEST / "lib")


class CodeFailed(RuntimeError):
    """A code did not come to its end, or lost grains."""


@dataclass(frozen=True)
class Code:
    """Title in tables; in YADE law (see in_yade.py) and instructions of the engine; of another program its name, how
    it is started on several cores, and where its physics is not this law."""

    title: str
    law: str = ""
    instructions: str = ""
    program: str = ""
    parallel: tuple = ("mpirun", "--oversubscribe", "--bind-to", "none")
    physics: str = ""


OF_LAMMPS = "JKR, springs of sliding, rolling and twisting; contacts break at the largest pull; no drag, no energies"
OF_LIGGGHTS = "Hertz with sjkr (a pull that goes with the contact area, no neck); no twisting, drag or energies"
OF_NEWEST = {"program": f"{NEWEST}/bin/lmp", "parallel": (f"{NEWEST}/bin/mpiexec",), "physics": "as the other LAMMPS"}
CODES = {
    "engine": Code("JKRWadaEngine", "fused"),
    "engine-avx2": Code("JKRWadaEngine, AVX2", "fused", "avx2"),
    "engine-portable": Code("JKRWadaEngine, portable", "fused", "portable"),
    "functors": Code("functors in YADE's loop", "functors"),
    "lammps": Code("LAMMPS", program="lmp", physics=OF_LAMMPS),
    "lammps-newest": Code("LAMMPS, newest wheel", **OF_NEWEST),
    "liggghts": Code("LIGGGHTS", program="liggghts", physics=OF_LIGGGHTS),
}


def threads_of(code):
    """Numbers of threads, or of another program's processes, that a code is measured with here."""
    code = CODES[code]
    return (1,) if code.instructions or (code.program and not shutil.which(code.parallel[0])) else (1, 2)


def missing(code, scene):
    """Why a code cannot be measured here on this SceneFile, in a line; None when it can."""
    program = CODES[code].program
    if not program:
        return None
    if not shutil.which(program):
        return f"{program} is not installed (make peers installs it)"
    if code != "liggghts" and "granular" not in help_text(program):
        return f"this {program} was built without pair_style granular"
    if scene.head["neck"]:
        return "it has no sintered bonds"
    if len(scene.materials) > 1 or np.ptp(scene.grains["radius"]):
        return "it is measured on like grains only"
    return None


def open_code(code, path, together, how):
    """What measures a code on the scene of a file; together: small steps in an O.step; how: bench.Settings."""
    return OtherCode(code, path, how) if CODES[code].program else YadeCode(CODES[code], path, together)


class YadeCode:
    """A code in YADEs that hold a scene (in_yade.py), each started when it is first used: one for any number of the
    engine's threads; of YADE's own loops one for each number, which they cannot change."""

    def __init__(self, code, path, together):
        opened = {"path": str(path), "together": together, "law": code.law, "instructions": code.instructions}
        self.opened, self.yades = opened, {}

    def measure(self, threads, seconds, most):
        """A measurement of so many seconds, or of a share of `most` small steps."""
        own = 1 if self.opened["law"] == "fused" else threads
        if own not in self.yades:
            command = ["yade", "-n", "-x", f"-j{own}", str(HERE / "in_yade.py"), json.dumps(self.opened)]
            errors, pipe = tempfile.TemporaryFile("w+"), subprocess.PIPE
            self.yades[own] = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=errors, text=True), errors
        yade, errors = self.yades[own]
        print(json.dumps({"threads": threads, "seconds": seconds, "most": most}), file=yade.stdin, flush=True)
        for line in yade.stdout:
            if line.startswith("ANSWER "):
                return json.loads(line[len("ANSWER ") :])
        errors.seek(0)
        raise CodeFailed(f"YADE ended without an answer on {self.opened['path']}:\n{errors.read()[-2000:]}")

    def close(self):
        for yade, errors in self.yades.values():
            yade.communicate()
            errors.close()


# ---- LAMMPS and LIGGGHTS ----

WIDEST = 1500  # edge of a box [grain radii] that LAMMPS can divide into bins of its own size
BINS = 400  # along the edge of a wider one
FEWEST_STEPS, UPDATES = 20, 1e7  # of grains: large scenes take fewer steps
COMMANDS = """compute touching all contact/atom
compute touch all reduce sum c_touching
thermo_style custom step atoms c_touch
thermo_modify norm no
thermo {steps}
run {steps}"""


@lru_cache
def help_text(program):
    with tempfile.TemporaryDirectory() as folder:  # LIGGGHTS leaves a log file where it is called
        environment = {**os.environ, **ENVIRONMENT}
        return subprocess.run([program, "-h"], cwd=folder, capture_output=True, text=True, env=environment).stdout


def version(code):
    found = re.search(r"Version (LIGGGHTS\S* \S+?),|Simulator - (.+)", help_text(CODES[code].program))
    return found[1] or found[2] if found else "unknown"


class OtherCode:
    """LAMMPS or LIGGGHTS on the scene of a file, started anew for each measurement; the first with so many processes
    finds the skin, and newton on or off, that are best for it."""

    def __init__(self, code, path, how):
        self.code, self.scene, self.how, self.best = code, scene_file.load(path), how, {}

    def measure(self, threads, seconds, most):
        """By its own number of steps, not by seconds or `most`."""
        steps = min(self.how.peer_steps, max(FEWEST_STEPS, int(UPDATES / len(self.scene.grains))))
        newton = ("off",) if self.code == "liggghts" else ("off", "on")  # which it must be there
        tried = [self.best[threads]] if threads in self.best else product(self.how.skins, newton)
        runs = [(measure(self.code, self.scene, steps, threads, *options), options) for options in tried]
        found, self.best[threads] = min(runs, key=lambda run: run[0]["seconds"])
        return found

    def close(self):
        pass


def measure(code, scene, steps, processes, skin, newton):
    """{contacts, steps, seconds (of the time loop)} of a run of LAMMPS or LIGGGHTS on a SceneFile.

    Parameters
    ----------
    skin : of its lists [grain radii].
    newton : whether two processes share the forces between their grains ("on") or both take them ("off").
    """
    command = [CODES[code].program, "-in", "in", "-log", "none"]
    if processes > 1:
        command = [*CODES[code].parallel, "-n", str(processes), *command]
    with tempfile.TemporaryDirectory() as folder:
        write_input(Path(folder), code, scene, steps, processes, skin, newton)
        environment = {**os.environ, **ENVIRONMENT}
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environment)
    loop = re.search(r"Loop time of (\S+) on", done.stdout)
    rows = re.findall(r"^ *\d+ +(\d+) +(\S+) *$", done.stdout, re.M)  # grains; contacts, once from each grain
    if done.returncode or not loop or len(rows) < 2 or int(rows[-1][0]) != len(scene.grains):
        printed = f"{done.stdout}\n{done.stderr}"
        errors = re.findall(r"^ERROR.*$", printed, re.M) or [printed[-1500:]]
        raise CodeFailed(f"{CODES[code].program} failed, or lost grains: {errors[-1]}")
    return {"contacts": (float(rows[0][1]) + float(rows[-1][1])) / 4, "steps": steps, "seconds": float(loop[1])}


def write_input(folder, code, scene, steps, processes, skin, newton):
    """The files `in` and grains.data of a run."""
    grains, (record,), r = scene.grains, scene.materials, scene.grains["radius"][0]
    material = Material(*record.tolist())
    c = {**vars(pair_constants(material, r)), "surface_energy": material.surface_energy}
    c.update(linear_drag=0.0, viscous_drag_per_contact_radius=0.0)
    low, high, position = box_of(scene)
    edge = (high - low).max()
    # 0: of LAMMPS' own size, too many where fragments are far apart
    bins = edge / BINS / LENGTH if edge > WIDEST * r else 0
    words = dict(boundary=" ".join(3 * ("p" if scene.periodic else "f")), newton=newton, neighbours="")
    words.update(before=f"processors {processes} 1 1", skin=float(skin * r / LENGTH))
    words.update(step=float(scene.head["step"] / TIME), commands=COMMANDS.format(steps=steps))
    if code == "liggghts":
        template, contact = lammps_family.OF_LIGGGHTS, lammps_family.contact_of_liggghts
        words["contact"] = contact(c, (r, r), [material.young] * 2, [material.poisson] * 2)
    else:
        template, words["contact"] = lammps_family.OF_LAMMPS, lammps_family.contact_of_lammps(c)
        words["before"] += f"\natom_modify sort 1000 {bins}"
        words["neighbours"] = f"binsize {bins}"
    (folder / "in").write_text(template.format(**words))
    moving = dict(position=position, velocity=grains["velocity"], spin=grains["angularVelocity"])
    moving["box"] = (np.column_stack([low, high]) / LENGTH).tolist()
    data = lammps_family.data_file(1, grains["radius"], material.density, **moving)
    (folder / "grains.data").write_text(data)


def box_of(scene):
    """Lowest and highest coordinate (3,) of the cell, or of a box in which all grains stay; positions in it [m]."""
    x, r = scene.grains["position"], scene.grains["radius"][0]
    if scene.periodic:
        return np.zeros(3), scene.head["cellSize"], x % scene.head["cellSize"]
    reach = 2 * np.abs(x).max(axis=0) + 2 * r
    return -reach, reach, x


# ---- the engine without YADE; the machine ----


def harness(path, prefix=(), timeout=None, program=HARNESS, **parameters):
    """What build/harness prints for a scene's file, as a dictionary (build/harness --help lists the parameters).
    prefix: of the command; program: build/harness of a clone."""
    command = [*prefix, str(program), str(path), *(f"{name}={value}" for name, value in parameters.items())]
    done = subprocess.run(command, capture_output=True, text=True, timeout=timeout)
    if done.returncode:
        raise CodeFailed(done.stderr.strip() or f"{program} failed with status {done.returncode}")
    return json.loads(done.stdout)


def machine():
    """{cpu, cores, commit}; the commit ends in -changed when the work tree differs from it."""
    about = re.search(r"model name\s*: (.+)", Path("/proc/cpuinfo").read_text())
    git = lambda *words: subprocess.run(["git", *words], cwd=TOP, capture_output=True, text=True).stdout.strip()
    changed = "-changed" if git("status", "--porcelain", "--", "contact_law", "yade_scripts") else ""
    commit = git("rev-parse", "--short", "HEAD") + changed
    return {"cpu": about[1] if about else platform.processor(), "cores": os.cpu_count(), "commit": commit}
