"""Collisions of compressed aggregates beside close-packed and extracted (CPE) ones. Compressed cells are made first,
spheres cut out of them, then collided:

    python3 yade_scripts/study.py compressed-cells -j 2
    python3 yade_scripts/studies/compressed.py cut        the spheres, into runs/compressed-packings
    python3 yade_scripts/study.py compressed-desk -j 2

make study-compressed does all of it. The recipe of Oshiro et al. (2025): a BCCA cluster in a periodic cell is
compressed (Kataoka et al. 2013), and spheres are cut out where the filling is that of the CPE aggregates, to TOLERANCE:
places in the cell are drawn until that is so. A pair comes from one cell, in two places and orientations, whose spheres
may share grains.
"""

import argparse
import os
import sys
from dataclasses import replace
from itertools import product

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, TOP)
from analysis.progress import progress
from yade_scripts import packings
from yade_scripts.packings.from_run import CutParameters, cut, read_periodic_state
from yade_scripts.packings.packing import PackingError

CELLS, PACKINGS, COLLISIONS = "runs/compressed-cells", "runs/compressed-packings", "runs/compressed"
PAIRS = [(filling, seed) for seed in range(1, 31) for filling in (0.4, 0.3)]
GRAINS, RATE = 8192, "1e-5"  # of a cell; 1/t0
RADIUS = 20  # r, of the spheres; half the cell's edge is 22 r at 0.4
TOLERANCE, PLACES = 0.01, 200  # of the filling; places tried
EXPONENTS = (5, 0, 10)  # i of 10^(0.1 i) m/s
DURATION = "8e-7"  # s: compressed aggregates turn around later than CPE ones
STEP, CELL_STEP = 0.2, 0.3  # t0

CELL_HEAD = """Cells that are compressed, out of which spheres are cut (Oshiro et al. 2025).
Units: strainRate: 1/t0; stepFraction: t0."""
HEAD = """CPE and compressed aggregates of the same filling and size, head-on.
Units: radius: grain radii; velocity: m/s; duration: s; stepFraction: t0."""


def files_of(filling, seed):
    """Paths of the packings of target and projectile."""
    return [f"{PACKINGS}/f{filling:g}-s{seed}{end}.npz" for end in ("", "-b")]


def cut_pair(filling, seed):
    """Make both spheres of a cell, where they are missing. Raises PackingError."""
    files, cell = files_of(filling, seed), f"{CELLS}/f{filling:g}-s{seed}"
    if all(map(os.path.exists, files)):
        return
    folder = os.path.join(cell, "states")
    if not os.path.isdir(folder):
        raise PackingError(f"{folder}: no states; must be those of a cell: run the table compressed-cells first")
    state, places = read_periodic_state(os.path.join(folder, max(os.listdir(folder)))), iter(range(PLACES))
    for index, file in enumerate(files):
        for place in places:
            found = cut(state, CutParameters(radius=float(RADIUS), seed=1000 * seed + place), index)
            if abs(found.parameters["filling"] / filling - 1) <= TOLERANCE:
                break
        else:
            raise PackingError(f"{cell}: no sphere of that filling in {PLACES} places; must be another cell")
        about = {**found.parameters, "cell": seed, "nominal": filling}
        packings.save(file, replace(found, parameters=about))


def cells():
    """Rows of the cells' table."""
    row = {"!SCRIPT": "yade_scripts/compress.py", "grains": GRAINS, "atRest": 0}
    row |= {"strainRate": RATE, "stepFraction": CELL_STEP}
    found = []
    for filling, seed in PAIRS:
        name = f"f{filling:g}-s{seed}"
        own = {"finalFilling": f"{filling:g}", "states": 2, "seed": seed, "threads": 1, "out": f"{CELLS}/{name}"}
        found.append({"description": name, **row, **own})
    return found


def collisions():
    """Rows of the collisions' table: each pair of both kinds after the other."""
    found = []
    for i, (filling, seed) in product(EXPONENTS, PAIRS):
        cpe = {"packing": "cpe", "filling": filling, "radius": RADIUS, "seed": seed}
        compressed = {"packing": "file", "atRest": 0, **dict(zip(("file", "projectileFile"), files_of(filling, seed)))}
        for kind, given in (("cpe", cpe), ("compressed", compressed)):
            name = f"{kind}-f{filling:g}-i{i}-s{seed}"
            last = {"duration": DURATION, "stepFraction": STEP, "threads": 1, "out": f"{COLLISIONS}/{name}"}
            found.append({"description": name, **given, "velocity": f"10**(0.1*{i})", **last})
    return found


def tables():
    """{size: (rows, head)}."""
    return {"cells": (cells(), CELL_HEAD), "desk": (collisions(), HEAD)}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["cut"])
    parser.parse_args()
    os.chdir(TOP)
    os.makedirs(PACKINGS, exist_ok=True)
    try:
        for pair in progress(PAIRS, "cutting spheres"):
            cut_pair(*pair)
    except PackingError as error:
        sys.exit(f"compressed.py: {error}")


if __name__ == "__main__":
    main()
