# SPDX-License-Identifier: GPL-2.0-or-later
"""Makes ensembles.json: the samples of this repository's fused engine.

    /usr/bin/python3 generator/ensembles.py RUNS    RUNS: folder of runs that are not in the galleries; what is missing is run

Compressions of CPE aggregates are those of analysis/gallery/elastoplastic/runs.csv.
"""

import json
import sys
from math import log10, pi
from pathlib import Path

import numpy as np
import pandas as pd

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

ICE = "Ice of cases.json, r = 0.1 um, t0 = 0.19365 ns, no drag unless said; neighbours start at the equilibrium overlap, springs unstrained."
COLLISION = "Two aggregates of one kind, independent, randomly turned, without spin, start just before they touch with opposite velocities along x; "
BALLISTIC = COLLISION + "their centres are 0.5 (r_c1 + r_c2) apart across x, r_c = (5/3)^(1/2) R_g. "
CENSUS = f"0.6 us after the start, pieces of grains in contact are counted. Step {MASS_OF['stepFraction']} t0."
CPE = "CPE (Arakawa et al. 2024, section 3): a face-centred cubic lattice cut by a sphere of radius 40 r whose centre is random in the lattice's cell, grains taken out at random until N = filling 40^3; "
D_MAX = "d_max / r: largest d = 80 r - (mean x of grains with x > 0, less mean x of those with x < 0) until the aggregates part or rest, first maximum; x from the centre of mass (eqs 10 to 13). Step 0.2 t0."
BPCA = "BPCA: 250 grains come one by one on straight lines, uniform over directions and over the cross-section of the sphere around the cluster, and stay where they first touch. "
BCCA = "two clusters of equal size, randomly turned, meet on a straight line that is uniform over the cross-section in which they can, and stay; from grains upwards. "


def of_cpe(filling):
    """d_max over r of the gallery's pairs."""
    runs = pd.read_csv(TOP / "analysis/gallery/elastoplastic/runs.csv", comment="#")
    wanted = {"filling": filling, "radius": CPE_RADIUS * GRAIN, "velocity": 10**0.5}
    wanted |= {"removeLooseGrains": 0, "initialOverlap": 1, "viscoelasticTime": 0}
    chosen = np.all([np.isclose(runs[name], value, atol=0) for name, value in wanted.items()], axis=0)
    return (runs[chosen].d_max / GRAIN).tolist()


def pressures(folder):
    """log10 of the mean pressure [Pa] between FILLINGS: the boundaries' work over the change of volume."""
    history, found = open_run(folder).history, []
    volume = CLUSTER["grains"] * 4 / 3 * pi * GRAIN**3
    for fillings in FILLINGS:
        first, last = np.interp(fillings, history["filling"], -history["boundaryWork"])
        found.append(log10((last - first) / (volume / fillings[0] - volume / fillings[1])))
    return found


def distributions(runs):
    largest = {
        name: collide(seed=range(1, 1 + number), folder=runs / name, **MASS_OF, **scene).largest_fraction
        for name, (scene, number) in SCENES.items()
    }
    cells = compress(seed=range(1, 13), folder=runs / "comp", **CLUSTER)
    pressed = np.array([pressures(folder) for folder in cells.folder]).T
    for filling in (0.4, 0.3):
        yield f"cpe-{filling}", COLLISION + f"head on at 10^(1/2) m/s. {CPE}filling {filling}.", D_MAX, of_cpe(filling)
    for fillings, values in zip(FILLINGS, pressed):
        scene = f"One BCCA of 1,024 grains ({BCCA[:-2]}) in a periodic cube as large as its extent, which shrinks as L = L0 exp(-2 C_v t/t0), C_v = 1e-5, affinely at the start (Kataoka et al. 2013, eqs 7 and 12); k_n = 0.01. "
        measure = f"log10 of the mean pressure [Pa] between fillings {fillings[0]} and {fillings[1]}: work of the boundaries over the change of volume. Step 0.3 t0."
        yield f"bcca-pressure-{fillings[1]}", scene, measure, values.tolist()
    for velocity in (50, 100):
        name, scene = f"bpca-largest-{velocity}", f"{BALLISTIC}{velocity} m/s. {BPCA}"
        yield name, scene, "Fraction of the mass in the largest piece: " + CENSUS, largest[name].tolist()
    scene = f"{BALLISTIC}30 m/s. BCCA of 128 grains each: {BCCA}"
    measure = f"1 if the largest piece has more than {STICKS} of the mass, else 0: " + CENSUS
    yield "bcca-sticking", scene, measure, (largest["bcca-sticking"] > STICKS).astype(float).tolist()


def main(runs):
    found = [dict(id=name, scene=scene, measure=measure, values=[float(f"{value:.6g}") for value in values]) for name, scene, measure, values in distributions(Path(runs))]  # fmt: skip
    suite = dict(suite="JKR-Wada conformance: ensembles", version="1.1.0", licence="CC0-1.0", common=ICE, level=0.01)
    path = Path(__file__).resolve().parents[1] / "ensembles.json"
    path.write_text(json.dumps({**suite, "distributions": found}, indent=1) + "\n")


if __name__ == "__main__":
    main(*sys.argv[1:])
