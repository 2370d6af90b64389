"""The tables of outcomes, from the model of the table of runs:

    python3 -m analysis.atlas.make [FOLDER]

fits the model to FOLDER/runs.csv (analysis/gallery/atlas) and writes there, for each structure, outcomes.txt, averaged
over impact parameters, and outcomes-impact.txt, for each one (outcomes-close-packed.txt and so on).
"""

import sys
from pathlib import Path

import numpy as np
import pandas
from scipy.spatial import cKDTree

from ..printable import FAILED, complain
from ..runs.files import RunFolderError
from ..theory import GRAIN_RADIUS, ICE
from ..version import version
from .columns import read_runs
from .outcome_table import (
    COLUMNS,
    ERRORS,
    INSIDE,
    INTERVALS,
    PROBABILITIES,
    TOUCHING,
    Axis,
    OutcomeTable,
    axes_of,
    write_outcomes,
)
from .query import FOLDER, RUNS_FILE, outcomes_file
from .rules import KEPT
from .variables import (
    CLOSE_PACKED,
    GROWN,
    MARGIN,
    NEAR,
    ONE_CONTACT,
    STRUCTURES,
    Region,
    breaking_velocity,
    of_structure,
)

SIZES, RATIOS = np.geomspace(64, 4096, 7), np.geomspace(1 / 64, 1.0, 4)  # of the runs
FILLINGS = {GROWN: (0.002, 0.02, 0.1, 0.2, 0.3, 0.4, 0.48), CLOSE_PACKED: (0.25, 0.3, 0.4, 0.5, 0.56)}
VELOCITIES = np.append(np.geomspace(1e-6, 0.08, 11)[:-1], np.geomspace(0.08, 26.0, 20))
# Beyond the runs only what is slow is known: the nodes there are few.
BEYOND_SIZES = np.array([1, 8, *SIZES, *(8.0 ** np.arange(5, 9))])
BEYOND_RATIOS = np.append(64.0 ** np.arange(-4, -1), RATIOS)

ABOUT = """Outcomes of collisions of two dust aggregates: the collision atlas.
Made by the contact-law suite, version {version}, from {runs} runs; licence: GPL-2.0-or-later. To cite: CITATION.cff.
Of {structure}.
Axes: velocity over v_break = (E_break/m0)^(1/2) of the grains (ice of 0.1 um: {ice:.4g} m/s), number of grains of the
larger aggregate, mass of the smaller over the larger, filling factor (of a sphere of radius (5/3)^(1/2) R_g; mean by
mass of both).
Columns: p_...: probabilities of the outcomes, sum 1 (rules: analysis/atlas/rules.py), of collisions in which the
aggregates touch, {impact} and averaged over
orientations; error_...: their 90 % half widths, by the decided runs, and by what undecided ones may become;
p_touching: of pairs with b < 1, those that touch; largest, second: mass of the two largest pieces over the total;
fragment_index: n of dN/dm ~ m^-n of all pieces but the largest; filling_after: of the largest piece; where that is the
outcome, gain_mass_transfer, loss_erosion: mass that the larger aggregate gains, loses (half its own at most) over the
smaller one's, largest_fragmentation: the largest piece over the larger aggregate; _low, _high: ends of the intervals
that hold 90 % of such collisions, for the largest piece of those that leave more than one; inside: 1 within the convex
hull of the runs in ln velocity, ln grains, ln mass_ratio and filling, or {margin:g} of their scatter beyond at most; 0
farther beyond, where values are those of the nearest node within; runs: number of runs within {near:g} of the scatter.
Between nodes: multilinear in the scaled coordinates (pieces better as second (1 + mass_ratio)/mass_ratio and
c = largest (1 + mass_ratio) - 1, where that is above 0 c/mass_ratio); the last axis is the fastest.
Slow collisions: all {sure} fitted runs with a kinetic energy below {energy:.3g} E_break stuck; anything else has a
chance of {most:.2g} there at most (95 %). Slower ones than any run are inside where they would be with that energy;
below {contact:.2g} E_break, what making and breaking one contact dissipates, all runs stuck, and sticking is taken to
hold at any size within the axes (error 0; filling_after is then a guess where runs is 0).
Not in it: spins before the collision, sintering, drag, charges, grains of unlike size."""

OF_STRUCTURE = {
    GROWN: "aggregates that grew grain by grain or cluster by cluster, and compressed ones; close-packed ones have a "
    "table of their own",
    CLOSE_PACKED: "close-packed aggregates (CPE: a dense packing with grains taken out), which bounce several times as "
    "often as compressed ones of\ntheir filling",
}
OF_IMPACT = {
    True: "averaged over impact parameters up to the sum of the radii (5/3)^(1/2) R_g, uniform in b^2,",
    False: "at each impact parameter (impact_square: b^2 in units of the sum of these radii),",
}


def outcome_axes(structure, averaged):
    """Axes of a table of outcomes; at each impact parameter only sizes and mass ratios of the runs."""
    sizes, ratios = (BEYOND_SIZES, BEYOND_RATIOS) if averaged else (SIZES, RATIOS)
    axes = axes_of(VELOCITIES, sizes, ratios, np.array(FILLINGS[structure]))
    return axes if averaged else (*axes, Axis("impact_square", "linear", np.linspace(0.0, 1.0, 5)))


def outcome_grid(model, structure, averaged, version):
    """OutcomeTable of a model.Model of a structure, averaged over impact parameters, or at each one with INTERVALS.

    Outside of the data a node has the values of the nearest one inside.
    """
    axes, columns = outcome_axes(structure, averaged), COLUMNS if averaged else (*COLUMNS, *INTERVALS)
    mesh = np.meshgrid(*(axis.nodes for axis in axes), indexing="ij")  # the last axis is the fastest
    points = pandas.DataFrame({"impact_square": 0.5} | {a.name: values.ravel() for a, values in zip(axes, mesh)})
    region = Region(model.runs)
    inside = region.beyond(points) <= MARGIN
    own = points[inside]
    chances, widths = model.probabilities(own, averaged)
    found = model.remains.means(own, chances, averaged)
    found[[*PROBABILITIES, *ERRORS]] = np.hstack([chances, widths])
    found[TOUCHING] = model.touching(own, averaged)
    if not averaged:
        found = found.join(model.remains.intervals(own)[list(INTERVALS)])
    rows, place = np.cumsum(inside) - 1, np.column_stack([axis.position(points[axis.name]) for axis in axes])
    rows[~inside] = cKDTree(place[inside]).query(place[~inside])[1]  # the nearest in steps of the grid
    grid = found.iloc[rows].reset_index(drop=True)
    # Runs of a smaller mass ratio, which count here too, may lose more over their projectile than an eroded one has.
    grid["loss_erosion"] = np.minimum(grid.loss_erosion, (1 - KEPT) / points.mass_ratio)
    grid[INSIDE], grid["runs"] = inside, region.within(points, averaged)
    values = grid[list(columns)].to_numpy(dtype=float).reshape(*(len(axis.nodes) for axis in axes), -1)
    about = ABOUT.format(
        version=version,
        runs=len(model.runs),
        structure=OF_STRUCTURE[structure],
        ice=breaking_velocity(ICE, GRAIN_RADIUS["ice"]),
        margin=MARGIN,
        near=NEAR,
        sure=model.slow.number,
        energy=model.slow.energy,
        most=model.slow.most,
        contact=ONE_CONTACT,
        impact=OF_IMPACT[averaged],
    )
    return OutcomeTable(axes, columns, values, tuple(about.splitlines()))


def main(folder=FOLDER):
    """Exit status: 0, or 2 with one line on stderr."""
    try:
        from threadpoolctl import threadpool_limits  # comes with scikit-learn

        from .model import Model

        table = read_runs(Path(folder) / RUNS_FILE.name)
        with threadpool_limits(1):  # the matrices are small: threads that wait for each other take far longer
            for structure in STRUCTURES:
                model = Model(of_structure(table, structure))
                for averaged in (True, False):
                    file = Path(folder) / outcomes_file(structure, averaged).name
                    write_outcomes(file, outcome_grid(model, structure, averaged, version()))
                    print(file)
    except (OSError, ModuleNotFoundError, RunFolderError, ValueError) as error:
        complain(error)
        return FAILED
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:2]))
