# SPDX-License-Identifier: GPL-2.0-or-later
"""Makes the values of ensembles.json anew: the samples of this repository's fused engine.

    /usr/bin/python3 generator/ensembles.py RUNS    RUNS: folder of runs that are not in the galleries; what is missing is run

Compressions of CPE aggregates are those of analysis/gallery/elastoplastic/runs.csv.
"""

import json
import sys
from math import log10, pi
from pathlib import Path

import numpy as np
import pandas as pd

FILE = Path(__file__).resolve().parents[1] / "ensembles.json"
TOP = Path(__file__).resolve().parents[3]
sys.path.insert(0, str(TOP))
from analysis import open_run
from yade_scripts import collide, compress

GRAIN, CPE_RADIUS, STICKS = 1e-7, 40, 0.75  # m, r, fraction of the mass
MASS_OF = {"duration": 6e-7, "impact": 0.5, "stepFraction": 0.2, "endWhenApart": 0}
SCENES = {  # that are counted so: (aggregates, number of runs)
    "bpca-largest-50": ({"packing": "bpca", "grains": 250, "velocity": 50}, 24),
    "bpca-largest-100": ({"packing": "bpca", "grains": 250, "velocity": 100}, 24),
    "bcca-sticking": ({"packing": "bcca", "grains": 128, "velocity": 30}, 60),
}
CLUSTER = {"grains": 1024, "strainRate": 1e-5, "linearDamping": 0.01, "finalFilling": 0.3, "stepFraction": 0.3}
FILLINGS = ((0.05, 0.1), (0.1, 0.3))


def of_cpe(filling):
    """d_max over r of the gallery's pairs."""
    runs = pd.read_csv(TOP / "analysis/gallery/elastoplastic/runs.csv", comment="#")
    wanted = {"filling": filling, "radius": CPE_RADIUS * GRAIN, "velocity": 10**0.5}
    wanted |= {"removeLooseGrains": 0, "initialOverlap": 1, "viscoelasticTime": 0}
    chosen = np.all([np.isclose(runs[name], value, atol=0) for name, value in wanted.items()], axis=0)
    return runs[chosen].d_max / GRAIN


def pressures(folder):
    """log10 of the mean pressure [Pa] between FILLINGS: the boundaries' work over the change of volume."""
    history, found = open_run(folder).history, []
    volume = CLUSTER["grains"] * 4 / 3 * pi * GRAIN**3
    for fillings in FILLINGS:
        first, last = np.interp(fillings, history["filling"], -history["boundaryWork"])
        found.append(log10((last - first) / (volume / fillings[0] - volume / fillings[1])))
    return found


def samples(runs):
    """{distribution: value of each run}"""
    found = {f"cpe-{filling}": of_cpe(filling) for filling in (0.4, 0.3)}
    cells = compress(seed=range(1, 13), folder=runs / "comp", **CLUSTER)
    pressed = np.array([pressures(folder) for folder in cells.folder]).T
    found |= {f"bcca-pressure-{fillings[1]}": values for fillings, values in zip(FILLINGS, pressed)}
    for name, (scene, number) in SCENES.items():
        found[name] = collide(seed=range(1, 1 + number), folder=runs / name, **MASS_OF, **scene).largest_fraction
    return {**found, "bcca-sticking": found["bcca-sticking"] > STICKS}


def main(runs):
    suite, found = json.loads(FILE.read_text()), samples(Path(runs))
    for distribution in suite["distributions"]:
        distribution["values"] = [float(f"{value:.6g}") for value in found[distribution["id"]]]
    FILE.write_text(json.dumps(suite, indent=1) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
