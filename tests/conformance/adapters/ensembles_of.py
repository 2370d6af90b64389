"""A code's aggregates beside ensembles.json:  /usr/bin/python3 adapters/ensembles_of.py CODE SAMPLES.json RUNS

CODE: engine, or lammps (LMP=program, lmp) with the options of adapters/lammps.py. Both take the same aggregates, made by this
repository's scripts by the recipe of each scene, with other random numbers than the suite's own; RUNS is the folder for them.
CPE aggregates and compressed cells are not among them.
"""

import json
import os
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
from answers import SUITE
from lammps import LMP, contact_words, version
from lammps_family import LENGTH, TIME, grains_file, left_by

ROOM = Path(__file__).resolve().parents[1]
TOP = ROOM.parents[1]
sys.path[:0] = [str(TOP), str(ROOM / "generator")]
from ensembles import MASS_OF, SCENES, STICKS

import analysis
from analysis import fragment_labels, fragment_sizes, open_run
from yade_scripts import collide

STEP = 0.1  # t0, LAMMPS's: half of the suite's, since events at whole steps leave errors of first order
FIRST = 1001  # seed
SCRIPT = """units lj
atom_style sphere
atom_modify sort 1000 20
boundary f f f
comm_modify vel yes
read_data grains
pair_style granular
pair_coeff * * {contact}
neighbor 0.3 bin
neigh_modify delay 0 every 1 check yes binsize 20
fix move all nve/sphere
compute pairs all property/local patom1 patom2 cutoff type
compute forces all pair/local force cutoff type
timestep {step!r}
thermo 1000000
dump contacts all local {steps} contacts.* index c_pairs[1] c_pairs[2] c_forces
run {steps}
"""


def contacts_at_end(state, contact, time):
    """Pairs of grains (M, 2) that touch at a time [s]: between which LAMMPS has a force."""
    steps = round(time / (STEP * contact["time_unit"]))
    reach = 50 + (np.abs(state.position).max() + 3 * np.abs(state.velocity).max() * time) / LENGTH
    filled = SCRIPT.format(contact=contact_words(contact), step=time / TIME / steps, steps=steps)
    alike = ([one] * len(state.position) for one in (1, 2.0, 1.0))
    motion = (x.tolist() for x in (state.position, state.velocity, 0 * state.velocity))
    files = {"grains": grains_file(float(reach), *alike, *motion), "in": filled}
    rows = np.loadtxt(left_by([LMP], files, f"contacts.{steps}").splitlines(), skiprows=9, ndmin=2)
    return rows[rows[:, 3] != 0, 1:3].astype(int) - 1


def of_engine(runs):
    """Fraction of the grains in the largest piece of each run of a table."""
    return runs.largest_fraction.tolist()


def of_lammps(runs):
    """As of_engine, from the grains with which those runs began."""
    contact = next(case for case in SUITE["cases"] if case["id"] == "equilibrium")["scenes"]["scene"]["contact"]

    def largest(folder):
        state = open_run(folder).start
        pairs = contacts_at_end(state, contact, MASS_OF["duration"])
        return int(fragment_sizes(fragment_labels(len(state.position), pairs)).max()) / len(state.position)

    with ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(largest, runs.folder))


def main(code, path, folder):
    samples = {}
    for name, (scene, number) in SCENES.items():
        runs = collide(seed=range(FIRST, FIRST + number), folder=Path(folder) / name, **MASS_OF, **scene)
        samples[name] = {"engine": of_engine, "lammps": of_lammps}[code](runs)
    samples["bcca-sticking"] = [float(fraction > STICKS) for fraction in samples["bcca-sticking"]]
    suite = json.loads((ROOM / "ensembles.json").read_text())["version"]
    name, its = ("JKRWadaEngine", analysis.__version__) if code == "engine" else ("LAMMPS", version())
    text = dict(code=name, version=its, suite=suite, samples=samples)
    Path(path).write_text(json.dumps(text) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
