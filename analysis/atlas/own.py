"""A table of outcomes, in the atlas's format, of runs of one's own: fractions of runs, without a model between."""

import numpy as np
import pandas
from scipy.spatial import cKDTree

from ..measures.outcome import NEVER_MET, UNDECIDED
from ..printable import Refused
from ..report.rows import measure as measure_runs
from .columns import measure
from .outcome_table import COLUMNS, ERRORS, INSIDE, LEFT, PROBABILITIES, TOUCHING, OutcomeTable, axes_of, write_outcomes
from .rules import KINDS, OF_KIND, change
from .variables import variables

# Relative: values of an axis in a row that are closer are of one node. Each aggregate that grew has its own filling.
APART = {"velocity": 0.02, "grains": 0.02, "mass_ratio": 0.02, "filling": 0.5}
ROOM = 0.02  # beyond the least and the greatest of the values, where they are all of one node
HALF = 1.645  # half width of 90 % of a normal distribution, in standard deviations
ABOUT = """Outcomes of collisions of two dust aggregates, of {runs} runs (fractions of runs, no model).
Axes: velocity over v_break = (E_break/m0)^(1/2), grains of the larger aggregate, mass of the smaller over the larger,
filling factor (of a sphere of radius (5/3)^(1/2) R_g; mean by mass of both).
Columns: as of the atlas's tables (analysis/gallery/atlas/outcomes.txt). p_...: (k + 1/5)/(n + 1) of the n decided runs
that met nearest to the node, of which k ended so; error_...: their 90 % half widths; p_touching: of all runs there
(and at nodes nearest to it without a decided run), those that met; the others are means of those runs, 0 where they
have none. inside: 1 where a node has runs of its own; others have the values of the nearest one that has.
runs: their number."""


def outcome_table(runs, file=None, **nodes):
    """OutcomeTable of runs, as outcome(..., file=...), DustPy's adapter and dust_outcomes.f90 read it.

    Parameters
    ----------
    runs : path, pattern, RunFolder, list of these, or DataFrame of table() or collide()
        Collisions of two aggregates of equal grains, best at random offsets (impact=random).
    file : path, optional
        Where the table is written.
    **nodes : array
        Of velocity [over v_break], grains, mass_ratio, filling: the nodes of an axis; by default the values of the
        runs, those within 2 % (fillings: 50 %) of the next being one.

    Raises
    ------
    ValueError
        For an axis that is none, and without a run that met and is decided.
    """
    if unknown := set(nodes) - set(APART):
        raise ValueError(f"{min(unknown)}: no axis; must be {', '.join(APART)}")
    measured, problems = measure_runs(list(runs.folder) if isinstance(runs, pandas.DataFrame) else runs, measure)
    found = pandas.DataFrame([row for _, row in measured])
    known = found[~found.outcome.isin((NEVER_MET, UNDECIDED))] if len(found) else found
    if not len(known):
        raise Refused(problems[0] if problems else "no run that met and is decided; must be one or more")
    points = variables(found)
    of_axes, alone = zip(*(_nodes(name, points[name], nodes.get(name)) for name in APART))
    axes = axes_of(*of_axes)
    shape = [len(axis.nodes) for axis in axes]
    first = lambda place: np.ravel_multi_index(np.where(alone, 0, place).T, shape)  # both nodes alone are alike
    node = first(np.rint([axis.position(points[axis.name]) for axis in axes]).astype(int).T)
    grid = np.indices(shape).reshape(len(axes), -1).T
    there = np.unique(node[found.index.isin(known.index)])
    # Fillings last: of aggregates that grow they scatter, and none is chosen by whether it hits.
    distance = np.where(alone, 0.0, [1.0, 1.0, 1.0, 1e-3])
    nearest = cKDTree(grid[there] * distance).query(grid * distance)[1]
    rows = [_row(own) for _, own in found.groupby(nearest[node])]
    values = pandas.DataFrame(rows).iloc[nearest].reset_index(drop=True)
    values[INSIDE] = np.isin(first(grid), there)
    values = values[list(COLUMNS)].fillna(0.0).to_numpy(dtype=float).reshape(*shape, -1)
    made = OutcomeTable(axes, COLUMNS, values, tuple(ABOUT.format(runs=len(known)).splitlines()))
    if file is not None:
        write_outcomes(file, made)
    return made


def _nodes(name, values, given):
    """(nodes (n,), n >= 2, of an axis; whether values lie between two of them as at one)."""
    if given is not None:
        return np.unique(given), False
    found = np.unique(values)
    groups = np.split(found, 1 + np.flatnonzero(np.diff(found) > APART[name] * found[:-1]))
    if len(groups) == 1:
        return np.array([found[0] * (1 - ROOM), found[-1] * (1 + ROOM)]), True
    return np.array([group.mean() for group in groups]), False


def _row(own):
    """{column: value} of the runs nearest to a node."""
    met = own[own.outcome.ne(NEVER_MET)]
    decided = met[met.outcome.ne(UNDECIDED)]
    number = len(decided)
    row = {TOUCHING: len(met) / len(own), "runs": number}
    for kind, p, error in zip(KINDS, PROBABILITIES, ERRORS):
        row[p] = (decided.outcome.eq(kind).sum() + 1 / len(KINDS)) / (number + 1)
        row[error] = HALF * np.sqrt(row[p] * (1 - row[p]) / (number + 1))
    row |= dict(zip(LEFT, decided[["largest", "second", "fragment_index", "filling_largest"]].mean()))
    gain = change(decided.largest, decided.mass_ratio)
    of_kind = {"mass_transfer": gain, "erosion": -gain / decided.mass_ratio}
    of_kind["fragmentation"] = decided.largest * (1 + decided.mass_ratio)
    return row | {name: of_kind[kind][decided.outcome.eq(kind)].mean() for name, kind in OF_KIND.items()}
