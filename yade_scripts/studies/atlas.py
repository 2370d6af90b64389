"""The collisions of the atlas: a Sobol sequence over structure, size, mass ratio, velocity, impact parameter and filling.

    python3 yade_scripts/study.py atlas-cells -j 2     the cells that compressed aggregates are cut out of (full: atlas-cells-full too)
    python3 yade_scripts/studies/atlas.py pilot [FIRST LAST]      runs/atlas-pilot.table, and the packings of its rows; also desk, full;
                                                                  FIRST LAST: runs/atlas-pilot-FIRST-LAST.table, of rows FIRST to
                                                                  before LAST alone
    python3 yade_scripts/study.py runs/atlas-pilot.table -j 2
    python3 yade_scripts/studies/atlas.py longer RUNS.csv         runs/atlas-longer.table: the runs that are undecided in an analysis, LONGER times as long;
                                                                  analysed alone, their runs.csv goes before RUNS.csv: of two the first counts

make study-atlas SIZE=pilot does all of it. Row i is the same in every size, which are 500, 2,000 and 14,000 rows long: a larger size goes on
from a smaller one. Aggregates hold 64 to 1,024 grains together in the first 2,000 rows, and up to 4,096 in the others.
Rows 3,000 to 9,999 are the one of CANDIDATES, drawn at random, whose outcome was the least sure by a model of the rows before: the choices
stand in atlas-chosen.txt, a digit a row. Rows from 10,000 on are drawn at random, as those held out are: a sample of the whole space.

Of every ten rows one, drawn at random, is held out (its name ends in -held): no model may be fitted to it, and it is not chosen. Of every ten one is of silicate,
at velocities that are the same over v_break = (E_break/m0)^(1/2); compressed aggregates are of ice alone, whose cells they are cut out of.

Ballistic aggregates, BCCA and BPCA, have the filling that they have. Close-packed (CPE) ones are without loose grains; compressed ones are
spheres cut out of BCCA clusters that were compressed in a periodic cell (as in Oshiro et al. 2025), a pair of one cell, in two places
and orientations. Every row has packings of its own; rows with one cell share its grains.

Pairs that would never touch, by their straight ways, have a duration of MISSED; others end when nothing can happen any more (endWhenApart).
The time step is the longest for a ledger that closes to TOLERANCE of K(0) in 95 % of runs (yade_scripts/step_choice.py), at most LONGEST.
"""

import os
import sys
from contextlib import suppress
from dataclasses import dataclass

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
TOP = os.path.dirname(os.path.dirname(HERE))
sys.path.insert(0, TOP)
from scipy.stats import qmc

from analysis.atlas.columns import read_runs
from analysis.atlas.variables import CHOSEN, breaking_velocity
from analysis.measures.outcome import UNDECIDED
from analysis.measures.periodic_cell import filling_factor
from analysis.progress import progress
from analysis.runs.table import TableError
from analysis.theory import ICE, SILICATE
from yade_scripts import packings, step_choice
from yade_scripts.experiments.collision import CollisionParameters, place
from yade_scripts.materials import equilibrium_overlap
from yade_scripts.materials import pair_constants as contact_constants
from yade_scripts.packings.aggregate import AggregateParameters, make
from yade_scripts.packings.from_run import CutParameters, cut, read_periodic_state
from yade_scripts.packings.packing import Packing, PackingError
from yade_scripts.packings.placing import first_touch
from yade_scripts.run import table

SIZES = {"pilot": 500, "desk": 2_000, "full": 14_000}
RUNS, PACKINGS, CELLS = "runs/atlas", "runs/atlas-packings", "runs/atlas-cells"
SEED, DIMENSIONS = 20260, 6
STRUCTURES = ("bcca", "bpca", "cpe", "compressed")
FEWEST, MOST = 64, {SIZES["desk"]: 1_024, SIZES["full"]: 4_096}  # grains of both; the most up to that row
LEAST, MOST_UNEQUAL = 4, 64  # grains of the smaller one; mass ratio
VELOCITIES = (0.3, 100.0)  # m/s, of ice
FILLINGS = {"cpe": (0.25, 0.55), "compressed": (0.1, 0.5)}  # N (r/R)^3; CPE aggregates that are fluffier fall apart
GRAIN_RADIUS = 1e-7  # m
TOLERANCE, LONGEST = 0.01, 0.2  # of K(0); t0
MISSED = "1e-9"  # s
LONGER = 5  # times the duration, of runs that are undecided
STATES = 9  # of which two lie in the last quarter, which decides whether an outcome is decided
KEPT, PLACES = 0.8, 200  # of the grains that a compressed aggregate is to have; places tried
CANDIDATES = 8  # of which one was chosen
SEED_STEP = 10_000  # from one draw of a close-packed aggregate to the next
BLOCK = 10  # rows of which one is held out and one of silicate
CELL_SEEDS = {
    1_024: range(1, 11),
    4_096: range(11, 21),
}  # of cells for pairs of up to so many grains, which have twice as many
CELL_TABLES = dict(zip(CELL_SEEDS, ("atlas-cells", "atlas-cells-full")))
CELL_STATES, RATE, CELL_STEP = 60, "1e-5", 0.3  # number; 1/t0; t0


@dataclass(frozen=True)
class Scene:
    """A row: number, structure, material, grains of target and projectile, velocity [m/s], impact parameter, filling that a CPE or
    compressed aggregate is to have, largest number of grains of its part of the table, held (out)."""

    number: int
    structure: str
    material: str
    grains: tuple
    velocity: float
    impact: float
    filling: float
    most: int
    held: bool

    @property
    def name(self):
        return f"{self.number:05d}" + ("-held" if self.held else "")

    @property
    def seed(self):
        """Of the row's packings, and of no other row's."""
        return SEED + self.number

    @property
    def cell(self):
        """Seed of the cell that a compressed pair is cut out of."""
        seeds = CELL_SEEDS[self.most]
        return seeds[self.number % len(seeds)]

    @property
    def from_file(self):
        return self.structure in FILLINGS


def scenes(rows):
    """[Scene] of the first rows."""
    blocks = -(-rows // BLOCK)
    points = _points(blocks * BLOCK)
    found = []
    for first in range(0, len(points), BLOCK):
        block = range(first, first + BLOCK)
        held, draw = _held_out(first)
        silicate = draw.choice([i for i in block if _structure(points[i]) != "compressed"])
        found += [_scene(i, points[i], i == silicate, i == held) for i in block]
    return found[:rows]


def _points(rows):
    """Points (rows, DIMENSIONS) in the unit cube: of a Sobol sequence, then those chosen, then drawn."""
    sobol = min(rows, CHOSEN.start)
    # Not scrambled by scipy, whose versions may do it differently, but shifted: the first point would be a corner.
    shift = np.random.default_rng(SEED).uniform(size=DIMENSIONS)
    points = (qmc.Sobol(DIMENSIONS, scramble=False).random_base2(int(np.ceil(np.log2(sobol)))) + shift) % 1.0
    choice = dict(zip(CHOSEN, chosen()))
    return [*points[:sobol], *(_candidates(i)[choice.get(i, 0)] for i in range(sobol, rows))]


def chosen():
    """Which candidate (rows,) each row of CHOSEN is; those held out are the first, without regard to the model."""
    with open(os.path.join(HERE, "atlas-chosen.txt")) as file:
        return [int(digit) for digit in file.read() if not digit.isspace()]


def _candidates(number):
    """Points (CANDIDATES, DIMENSIONS) of which a row from CHOSEN on is one."""
    size = (CANDIDATES, DIMENSIONS)
    return np.random.default_rng([SEED, number, *size]).uniform(size=size)


def _held_out(first):
    """(row of the block from first on that is held out, generator of what else is drawn in it)."""
    draw = np.random.default_rng([SEED, first])
    return draw.choice(range(first, first + BLOCK)), draw


def _structure(point):
    return STRUCTURES[int(len(STRUCTURES) * point[0])]


def _scene(number, point, silicate=False, held=False):
    between = lambda u, low, high: low * (high / low) ** u
    structure = _structure(point)
    most = next(most for rows, most in MOST.items() if number < rows)
    total = between(point[1], FEWEST, most)
    ratio = between(point[2], 1.0, min(MOST_UNEQUAL, total / LEAST - 1))
    projectile = round(total / (1 + ratio))
    scale = 1.0
    if silicate:
        scale = breaking_velocity(SILICATE, GRAIN_RADIUS) / breaking_velocity(ICE, GRAIN_RADIUS)
    low, high = FILLINGS.get(structure, (0.0, 0.0))
    return Scene(
        number,
        structure,
        "silicate" if silicate else "ice",
        (round(total) - projectile, projectile),
        scale * between(point[3], *VELOCITIES),
        point[4] ** 0.5,
        low + (high - low) * point[5],
        most,
        held,
    )


def row(scene):
    """{column: value} of a Scene in the table of runs."""
    grown = {"packing": scene.structure, "grains": scene.grains[0], "projectileGrains": scene.grains[1]}
    files = {"packing": "file", "file": packing_file(scene, 0), "projectileFile": packing_file(scene, 1)}
    return {
        "description": scene.name,
        **(files if scene.from_file else grown),
        "velocity": f"{scene.velocity:.6g}",
        "impact": f"{scene.impact:.6g}",
        "material": scene.material,
        "grainRadius": GRAIN_RADIUS,
        **({} if scene.from_file else {"seed": scene.seed}),
        "stepFraction": step(scene),
        "threads": 1,
        "states": STATES,
        "out": f"{RUNS}/{scene.name}",
    }


def with_duration(cells):
    """A row's cells; with a short duration if its aggregates, whose packings must be there, never touch."""
    parameters = CollisionParameters.parse({name: str(value) for name, value in cells.items() if name != "description"})
    _, pair, (target, projectile) = place(parameters, equilibrium_overlap(parameters))
    missed = first_touch(*pair, projectile - target) is None
    return {**cells, "duration": MISSED} if missed else cells


def step(scene):
    """Time step [t0], as if aggregates were of fluffy ones' larger error where they are not CPE."""
    alike = _alike(scene)
    energies = step_choice.energies_of(contact_constants(alike), scene.grains, scene.velocity)
    error = step_choice.scene_factor(alike) * sum(step_choice.ledger_errors(*energies))
    return min(LONGEST, float(f"{(TOLERANCE / error) ** 0.5:.2g}"))


def _alike(scene):
    """Parameters of a collision of equal aggregates, whose errors and time unit are those of the scene."""
    of = {"packing": "cpe", "filling": 0.4} if scene.structure == "cpe" else {"packing": "bcca"}
    given = {**of, "grains": scene.grains[0], "velocity": scene.velocity, "material": scene.material}
    texts = {**given, "grainRadius": GRAIN_RADIUS, "tolerance": TOLERANCE, "stepFraction": "auto"}
    return CollisionParameters.parse({name: str(value) for name, value in texts.items()})


def packing_file(scene, index):
    """Path of the packing of target (0) or projectile (1)."""
    return f"{PACKINGS}/{scene.number:05d}{('', '-b')[index]}.npz"


def make_packings(scene):
    """Make both aggregates of a Scene that come from files, where they are missing. Raises PackingError."""
    files = [packing_file(scene, index) for index in (0, 1)]
    if all(map(os.path.exists, files)):
        return
    maker = _cpe if scene.structure == "cpe" else _compressed
    for index, file in enumerate(files):
        packings.save(file, maker(scene, index))


def _cpe(scene, index):
    """The first that is more than one grain: of few grains most may be loose, or their sphere may hold too few places of the lattice."""
    texts = {"packing": "cpe", "filling": scene.filling, "grains": scene.grains[index], "removeLooseGrains": 1}
    texts |= {"material": scene.material, "grainRadius": GRAIN_RADIUS}
    for number in range(PLACES):
        own = {**texts, "seed": scene.seed + number * SEED_STEP}
        parameters = AggregateParameters.parse({name: str(value) for name, value in own.items()})
        with suppress(PackingError):
            found = make(parameters, equilibrium_overlap(parameters), index)
            if found.grains > 1:
                return found
    raise PackingError(
        f"row {scene.number}: no {scene.grains[index]} close-packed grains hang together in {PLACES} draws"
    )


def _compressed(scene, index):
    """A sphere of the state of the cell whose filling is nearest: the first of the places in which KEPT of the grains hang together."""
    folder = os.path.join(f"{CELLS}/s{scene.cell}", "states")
    try:
        states = sorted(os.listdir(folder))
    except OSError:
        raise PackingError(
            f"{folder}: no states; must be those of a cell: python3 yade_scripts/study.py {CELL_TABLES[scene.most]} first"
        ) from None
    wanted = np.interp(scene.filling, *_fillings(folder, states))
    state = read_periodic_state(os.path.join(folder, states[round(wanted)]))
    radius = (scene.grains[index] / filling_factor(state.radius, state.cell_size)) ** (1 / 3)
    for number in range(PLACES):
        with suppress(PackingError):  # an empty place
            found = cut(state, CutParameters(radius=radius, seed=PLACES * scene.seed + number), index)
            if found.grains >= KEPT * scene.grains[index]:
                return Packing(found.position, found.radius, found.seed, {**found.parameters, "cell": scene.cell})
    raise PackingError(
        f"{folder}: no {scene.grains[index]} grains hang together in {PLACES} places; must be another cell"
    )


_known = {}


def _fillings(folder, states):
    """(fillings of a cell's states, their numbers)."""
    if folder not in _known:
        read = [read_periodic_state(os.path.join(folder, name)) for name in states]
        _known[folder] = [filling_factor(state.radius, state.cell_size) for state in read], range(len(states))
    return _known[folder]


def cell_rows(most):
    """Rows of the table of cells for pairs of up to so many grains."""
    row = {"!SCRIPT": "yade_scripts/compress.py", "grains": 2 * most, "strainRate": RATE, "finalFilling": 0.5}
    row |= {"stepFraction": CELL_STEP, "states": CELL_STATES, "threads": 1}
    return [{"description": f"s{n}", **row, "seed": n, "out": f"{CELLS}/s{n}"} for n in CELL_SEEDS[most]]


def tables():
    """{size: (rows, head)} of the cells."""
    head = "Cells that are compressed, out of which the atlas's compressed aggregates are cut.\n"
    head += "Units: strainRate: 1/t0; stepFraction: t0."
    return {name.removeprefix("atlas-"): (cell_rows(most), head) for most, name in CELL_TABLES.items()}


def write_size(size, *part):
    """Write runs/atlas-SIZE.table, or runs/atlas-SIZE-FIRST-LAST.table with the rows of part (first, last), the last one left out, and make their
    packings. Raises PackingError."""
    first, last = part or (0, SIZES[size])
    chosen = scenes(min(last, SIZES[size]))[first:]
    os.makedirs(PACKINGS, exist_ok=True)
    found = []
    for scene in progress(chosen, "making packings"):
        if scene.from_file:
            make_packings(scene)
        found.append(with_duration(row(scene)))
    head = "The collisions of the atlas.\nUnits: velocity: m/s; impact: r_c,tar + r_c,pro; grainRadius: m; stepFraction: t0. "
    name = "-".join(["atlas", size, *map(str, part)])
    table.write(f"runs/{name}.table", found, head + "Written by yade_scripts/studies/atlas.py.")


def write_longer(file):
    """Write runs/atlas-longer.table for a table of runs, the cheapest first, and make its packings. Raises TableError and PackingError."""
    runs, known = read_runs(file), scenes(SIZES["full"])
    undecided = runs[runs.outcome == UNDECIDED].sort_values("seconds")
    found = []
    for run in progress(list(undecided.itertuples()), "making packings"):
        scene = known[run.number]
        if scene.from_file:
            make_packings(scene)
        cells = row(scene)
        duration = LONGER * run.steps * cells["stepFraction"] * contact_constants(_alike(scene))["timeUnit"]
        own = {"out": f"{RUNS}-longer/{scene.name}", "duration": f"{duration:.3g}", "endWhenApart": 1}
        found.append({**cells, **own})
    table.write(
        f"{RUNS}-longer.table",
        found,
        "Runs of the atlas that were undecided. Written by yade_scripts/studies/atlas.py.",
    )


def main(arguments):
    size = arguments[0] if arguments else ""
    if size == "longer" and len(arguments) == 2:
        file = os.path.abspath(arguments[1])
        os.chdir(TOP)
        try:
            write_longer(file)
        except (TableError, PackingError) as error:
            sys.exit(f"atlas.py: {error}")
    elif "--help" in arguments:
        print(__doc__)
    elif size in SIZES and len(arguments) in (1, 3) and all(part.isdecimal() for part in arguments[1:]):
        os.chdir(TOP)
        part = tuple(map(int, arguments[1:]))
        if part and not part[0] < min(part[1], SIZES[size]):
            sys.exit(f"atlas.py: rows {part[0]} to {part[1]}: must be rising, and some of {size}'s {SIZES[size]}")
        try:
            write_size(size, *part)
        except PackingError as error:
            sys.exit(f"atlas.py: {error}")
    else:
        print(f"atlas.py: must be called with longer, {', '.join(SIZES)}; --help says more", file=sys.stderr)
        sys.exit(2)


if __name__ == "__main__":
    main(sys.argv[1:])
