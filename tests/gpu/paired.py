"""The same collisions by YADE's engine and by the ensemble: do the same outcomes come, and the same growth?

    python3 tests/gpu/paired.py FOLDER [DEVICE]     processor (usual) or gpu; what is done in FOLDER is not done again

200 collisions of 2 x 60 to 2 x 128 grains of ice, fluffy and compact, from slow ones to well above the velocity at
which they break. Motions part by rounding after some hundred steps, so that single outcomes near a limit may differ;
the mean growth may not.
"""

import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy as np

TOP = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(TOP))
from analysis.runs.folder import open_run
from analysis.runs.measured import outcome_of_run
from yade_scripts.run import table

COUNT = 200
SHAPES = (
    {"packing": "bpca", "grains": 64},
    {"packing": "cpe", "filling": 0.5, "radius": 5},
    {"packing": "bpca", "grains": 128},
    {"packing": "bcca", "grains": 64},
)


def rows():
    """[{column: value}]: shapes in turn, velocities from 3 to 100 m/s, offsets as collisions have them."""
    for number, velocity in enumerate(np.geomspace(3, 100, COUNT)):
        shape = SHAPES[number % len(SHAPES)]
        yield dict(
            description=f"n{number}", **shape, velocity=f"{velocity:.4g}", impact="random", seed=number, states=2
        )


def main(folder, device="processor"):
    found = []
    for name, options in (("engine", ()), (device, ("--device", device))):
        place = Path(folder, name)
        place.mkdir(parents=True, exist_ok=True)
        table.write(place / "paired.table", list(rows()))
        command = ["nice", sys.executable, TOP / "yade_scripts" / "study.py", "paired.table", *options]
        subprocess.run(command, cwd=place, check=True)
        found.append([outcome_of_run(open_run(place / "runs" / row["description"])) for row in rows()])
    kinds = [tuple(one.kind for one in both) for both in zip(*found)]
    growth = np.array([[one.growth_efficiency for one in outcomes] for outcomes in found])
    apart = growth[1] - growth[0]
    error = apart.std(ddof=1) / np.sqrt(len(apart))
    print(f"{sum(a == b for a, b in kinds)} of {len(kinds)} outcomes agree")
    print(f"growth by the engine {growth[0].mean():.4f}, by {device} less it {apart.mean():+.4f} +- {error:.4f}")
    for (one, other), count in sorted(Counter(kinds).items()):
        print(f"{one:20s} {other:20s} {count}")


if __name__ == "__main__":
    main(*sys.argv[1:])
