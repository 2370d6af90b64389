"""LAMMPS, pair_style granular with JKR:  python3 adapters/lammps.py RESULTS.json [CASE ...]   (LMP=program, lmp)

Options, by what they are in the law:
normal jkr; damping velocity is K13's drag, damping viscoelastic A22's; tangential linear_history has W07's k_s (mindlin scales
it with the contact radius), rolling sds and twisting sds W07's springs. Limits are friction coefficients: right at zero load.
"""

import os
import re
import subprocess
import sys

from answers import NotModelled, main
from lammps_family import COLUMNS, LENGTH, MASS, PRESSURE, STIFFNESS, TIME, grains_of, run, runs, words

LMP = os.environ.get("LMP", "lmp")
SCRIPT = """units lj
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


def contact_words(c):
    """Of pair_coeff and of fix wall/gran, for the constants of a contact."""
    young, load = 2 * c["reduced_young"] * (1 - 0.25**2), 2 * c["pull_off_force"]  # the load that limits are shares of
    kind, drag = ("velocity", c["linear_drag"] * TIME / MASS) if c["linear_drag"] else ("viscoelastic", c["viscous_drag_per_contact_radius"] / c["reduced_mass"] * LENGTH * TIME)  # fmt: skip
    words = [f"jkr {young / PRESSURE!r} {drag!r} 0.25 {c['surface_energy'] / STIFFNESS!r}"]
    for mode, style, unit in (("sliding", "tangential linear_history", 1.0), ("rolling", "rolling sds", 1.0), ("twisting", "twisting sds", LENGTH)):  # fmt: skip
        stiffness = c[f"{mode}_stiffness"]
        limit = stiffness * c[f"critical_{mode}"] / load
        words.append(f"{style} {stiffness / STIFFNESS / unit**2!r} 0 {limit / unit!r}")
    return " ".join([*words, "damping", kind])


def script(scene, steps):
    step, contact = scene["duration"] / steps, contact_words(scene["contact"])
    plane = f"fix plane all wall/gran granular {contact} xplane 0 NULL" if "plane" in scene else ""
    commands = "\n".join(runs(scene, step, lambda k, w: f"set atom {k} omega {words(w, 1 / TIME)}"))
    return SCRIPT.format(step=step / TIME, columns=COLUMNS, contact=contact, plane=plane, runs=commands)


def series_of(scene, materials, steps):
    if scene.get("neck"):
        listed = "bpm/rotational" in help_text()
        raise NotModelled("not tried: bond_style bpm/rotational" if listed else "no sintered bonds")
    files = {"in": script(scene, steps), "grains.data": grains_of(scene, materials, (1, 1))}
    return run([LMP], files, scene, materials, steps)


def help_text():
    return subprocess.run([LMP, "-h"], capture_output=True, text=True).stdout


def version():
    return re.search(r"Simulator - (.+)", help_text())[1]


if __name__ == "__main__":
    main("LAMMPS", version(), series_of, sys.argv[1], sys.argv[2:])
