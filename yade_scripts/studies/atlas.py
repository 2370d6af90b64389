"""The collisions of the atlas: points of structure, size, mass ratio, velocity, impact parameter and filling.

    python3 yade_scripts/study.py atlas-cells -j 2             cells out of which compressed aggregates are cut; full
                                                               needs atlas-cells-full too
    python3 yade_scripts/studies/atlas.py pilot                runs/atlas-pilot.table and the packings of its rows; also
                                                               desk, full
    python3 yade_scripts/study.py runs/atlas-pilot.table -j 2

make study-atlas SIZE=pilot does all of it. Row i is the same in every size, 500, 2,000 and 14,000 rows.

Rows below 3,000 are a Sobol sequence. Each row to 9,999 is the one of CANDIDATES random points at which a model of the
rows before was least sure (atlas-chosen.txt has the choices, a digit a row). Rows from 10,000 on are random. Of every
ten rows one, drawn at random, is held out: its name ends in -held, it is not chosen, and no model is fitted to it. Of
every ten one is of silicate, at the same velocities over v_break = (E_break/m0)^(1/2), but no compressed one.

Close-packed (CPE) aggregates are without loose grains. Compressed ones are spheres cut out of BCCA clusters that were
compressed in a periodic cell (as in Oshiro et al. 2025), a pair of one cell.
"""

import argparse
import os
import sys
from contextlib import suppress
from dataclasses import replace
from functools import lru_cache
from types import SimpleNamespace

import numpy as np
from scipy.stats import qmc

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, TOP)
from analysis.atlas.variables import CHOSEN
from analysis.measures.periodic_cell import filling_factor
from analysis.progress import progress
from analysis.theory import ICE, SILICATE, breaking_velocity
from yade_scripts import packings, time_step
from yade_scripts.experiments.collision import CollisionParameters, place
from yade_scripts.materials import equilibrium_overlap, pair_constants
from yade_scripts.packings.aggregate import AggregateParameters, make
from yade_scripts.packings.from_run import CutParameters, cut, read_periodic_state
from yade_scripts.packings.packing import PackingError
from yade_scripts.packings.placing import first_touch
from yade_scripts.run import table

SIZES = {"pilot": 500, "desk": 2_000, "full": 14_000}
RUNS, PACKINGS, CELLS = "runs/atlas", "runs/atlas-packings", "runs/atlas-cells"
SEED, DIMENSIONS, CANDIDATES = 20260, 6, 8
BLOCK = 10  # rows of which one is held out and one of silicate
STRUCTURES = ("bcca", "bpca", "cpe", "compressed")
FEWEST, MOST = 64, {SIZES["desk"]: 1_024, SIZES["full"]: 4_096}  # grains of both; the most up to that row
LEAST, MOST_UNEQUAL = 4, 64  # grains of the smaller one; mass ratio
VELOCITIES = (0.3, 100.0)  # m/s, of ice
FILLINGS = {"cpe": (0.25, 0.55), "compressed": (0.1, 0.5)}  # N (r/R)^3; CPE aggregates that are fluffier fall apart
GRAIN_RADIUS = 1e-7  # m
TOLERANCE, LONGEST = 0.01, 0.2  # of the ledger, over K(0), in 95 % of runs; step [t0]
MISSED = "1e-9"  # s: duration of pairs that never touch on straight ways
STATES = 9  # of which two lie in the last quarter, which decides whether an outcome is decided
KEPT, PLACES = 0.8, 200  # of the grains that a compressed aggregate is to have; places or draws tried
SEED_STEP = 10_000  # from one draw of a close-packed aggregate to the next
# {most grains of a pair: (table of its cells, which have twice as many grains, seeds)}
CELLS_OF = {1_024: ("atlas-cells", range(1, 11)), 4_096: ("atlas-cells-full", range(11, 21))}
HEAD = """The collisions of the atlas. Written by yade_scripts/studies/atlas.py.
Units: velocity: m/s; impact: r_c,tar + r_c,pro; grainRadius: m; stepFraction: t0."""
CELL_HEAD = """Cells that are compressed, out of which the atlas's compressed aggregates are cut.
Units: strainRate: 1/t0; stepFraction: t0."""


def scenes(rows):
    """What the first rows are of, a SimpleNamespace each: grains and packing files of target and projectile, velocity
    [m/s], filling of CPE and compressed aggregates, seed, cell of a compressed pair and that cell's table."""
    points = _points(-(-rows // BLOCK) * BLOCK)
    found = []
    for first in range(0, len(points), BLOCK):
        block, draw = range(first, first + BLOCK), np.random.default_rng([SEED, first])
        held = draw.choice(block)
        silicate = draw.choice([i for i in block if _structure(points[i]) != "compressed"])
        found += [_scene(i, points[i], i == silicate, i == held) for i in block]
    return found[:rows]


def _points(rows):
    """Points (rows, DIMENSIONS) in the unit cube: of a Sobol sequence, then those chosen, then drawn."""
    sobol = min(rows, CHOSEN.start)
    # Not scrambled by scipy, whose versions may do it differently, but shifted: the first point would be a corner.
    shift = np.random.default_rng(SEED).uniform(size=DIMENSIONS)
    points = (qmc.Sobol(DIMENSIONS, scramble=False).random_base2(int(np.ceil(np.log2(sobol)))) + shift) % 1.0
    choice, size = dict(zip(CHOSEN, chosen())), (CANDIDATES, DIMENSIONS)
    candidates = lambda i: np.random.default_rng([SEED, i, *size]).uniform(size=size)
    return [*points[:sobol], *(candidates(i)[choice.get(i, 0)] for i in range(sobol, rows))]


def chosen():
    """Which candidate each row of CHOSEN is; those held out are the first, without regard to the model."""
    with open(os.path.join(HERE, "atlas-chosen.txt")) as file:
        return [int(digit) for digit in file.read() if not digit.isspace()]


def _structure(point):
    return STRUCTURES[int(len(STRUCTURES) * point[0])]


def _scene(number, point, silicate, held):
    between = lambda u, low, high: low * (high / low) ** u
    structure = _structure(point)
    most = next(most for rows, most in MOST.items() if number < rows)
    total = between(point[1], FEWEST, most)
    ratio = between(point[2], 1.0, min(MOST_UNEQUAL, total / LEAST - 1))
    projectile = round(total / (1 + ratio))
    scale = breaking_velocity(SILICATE, GRAIN_RADIUS) / breaking_velocity(ICE, GRAIN_RADIUS) if silicate else 1.0
    low, high = FILLINGS.get(structure, (0.0, 0.0))
    cells, cell_seeds = CELLS_OF[most]
    return SimpleNamespace(
        name=f"{number:05d}" + ("-held" if held else ""),
        held=held,
        structure=structure,
        material="silicate" if silicate else "ice",
        grains=(round(total) - projectile, projectile),
        velocity=scale * between(point[3], *VELOCITIES),
        impact=point[4] ** 0.5,
        filling=low + (high - low) * point[5],
        seed=SEED + number,
        cell=cell_seeds[number % len(cell_seeds)],
        cells=cells,
        files=tuple(f"{PACKINGS}/{number:05d}{end}.npz" for end in ("", "-b")),
    )


def row(scene):
    """{column: value} of a scene in the table of runs."""
    if scene.structure in FILLINGS:
        aggregates = {"packing": "file", **dict(zip(("file", "projectileFile"), scene.files))}
    else:
        target, projectile = scene.grains
        aggregates = {"packing": scene.structure, "grains": target, "projectileGrains": projectile, "seed": scene.seed}
    row = {"description": scene.name, **aggregates, "velocity": f"{scene.velocity:.6g}"}
    row |= {"impact": f"{scene.impact:.6g}", "material": scene.material, "grainRadius": GRAIN_RADIUS}
    return {**row, "stepFraction": step(scene), "threads": 1, "states": STATES, "out": f"{RUNS}/{scene.name}"}


def never_touch(cells):
    """Whether the aggregates of a row, whose packings must be there, pass each other on straight ways."""
    parameters = _parsed(CollisionParameters, {name: cells[name] for name in cells if name != "description"})
    _, pair, (target, projectile) = place(parameters, equilibrium_overlap(parameters))
    return first_touch(*pair, projectile - target) is None


def step(scene):
    """Time step [t0] as of equal aggregates; those that are not CPE have the larger error of fluffy ones."""
    packing = {"packing": "cpe", "filling": 0.4} if scene.structure == "cpe" else {"packing": "bcca"}
    given = {**packing, "grains": scene.grains[0], "velocity": scene.velocity, "material": scene.material}
    given |= {"grainRadius": GRAIN_RADIUS, "tolerance": TOLERANCE, "stepFraction": "auto"}
    alike = _parsed(CollisionParameters, given)
    energies = time_step.energies_of(pair_constants(alike), scene.grains, scene.velocity)
    error = time_step.scene_factor(alike) * time_step.ledger_error(*energies)
    return min(LONGEST, float(f"{(TOLERANCE / error) ** 0.5:.2g}"))


def _parsed(kind, cells):
    return kind.parse({name: str(value) for name, value in cells.items()})


def _close_packed(scene, index):
    """The first draw of more than one grain: of few grains most may be loose, or the sphere too small."""
    cells = {"packing": "cpe", "filling": scene.filling, "grains": scene.grains[index], "removeLooseGrains": 1}
    cells |= {"material": scene.material, "grainRadius": GRAIN_RADIUS}
    for number in range(PLACES):
        parameters = _parsed(AggregateParameters, {**cells, "seed": scene.seed + number * SEED_STEP})
        with suppress(PackingError):
            found = make(parameters, equilibrium_overlap(parameters), index)
            if found.grains > 1:
                return found
    raise PackingError(f"row {scene.name}: no {scene.grains[index]} close-packed grains in {PLACES} draws")


def _compressed(scene, index):
    """A sphere out of the state with the nearest filling, where KEPT of the grains hang together."""
    fillings = _fillings(f"{CELLS}/s{scene.cell}/states", scene.cells)
    file = list(fillings)[round(np.interp(scene.filling, list(fillings.values()), range(len(fillings))))]
    state = read_periodic_state(file)
    radius = (scene.grains[index] / fillings[file]) ** (1 / 3)
    for number in range(PLACES):
        with suppress(PackingError):  # an empty place
            found = cut(state, CutParameters(radius=radius, seed=PLACES * scene.seed + number), index)
            if found.grains >= KEPT * scene.grains[index]:
                return replace(found, parameters={**found.parameters, "cell": scene.cell})
    raise PackingError(f"{file}: no {scene.grains[index]} grains hang together in {PLACES} places")


@lru_cache
def _fillings(folder, cells):
    """{file of a cell's state: its filling}, in the order of the compression."""
    try:
        files = [os.path.join(folder, name) for name in sorted(os.listdir(folder))]
    except OSError:
        raise PackingError(f"{folder}: no states: python3 yade_scripts/study.py {cells} must come first") from None
    states = map(read_periodic_state, files)
    return {file: filling_factor(state.radius, state.cell_size) for file, state in zip(files, states)}


def tables():
    """{size: (rows, head)} of the cells."""
    found = {}
    for most, (name, seeds) in CELLS_OF.items():
        row = {"!SCRIPT": "yade_scripts/compress.py", "grains": 2 * most, "atRest": 0}
        row |= {"strainRate": "1e-5", "finalFilling": 0.5, "stepFraction": 0.3, "states": 60, "threads": 1}
        rows = [{"description": f"s{n}", **row, "seed": n, "out": f"{CELLS}/s{n}"} for n in seeds]
        found[name.removeprefix("atlas-")] = rows, CELL_HEAD
    return found


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("size", choices=SIZES)
    parser.add_argument("rows", nargs="*", type=int, metavar="FIRST LAST", help="only these, before LAST")
    options = parser.parse_args()
    size, part = options.size, options.rows
    if part and not (len(part) == 2 and 0 <= part[0] < part[1] <= SIZES[size]):
        parser.error(f"{part}: must be two rising numbers, of {size}'s {SIZES[size]} rows")
    os.chdir(TOP)
    os.makedirs(PACKINGS, exist_ok=True)
    rows = []
    try:
        for scene in progress(scenes(SIZES[size])[slice(*part or [None])], "making packings"):
            if scene.structure in FILLINGS and not all(map(os.path.exists, scene.files)):
                maker = _close_packed if scene.structure == "cpe" else _compressed
                for index, file in enumerate(scene.files):
                    packings.save(file, maker(scene, index))
            cells = row(scene)
            rows.append({**cells, "duration": MISSED} if never_touch(cells) else cells)
    except PackingError as error:
        sys.exit(f"atlas.py: {error}")
    table.write(f"runs/{'-'.join(['atlas', size, *map(str, part)])}.table", rows, HEAD)


if __name__ == "__main__":
    main()
