"""A row a run: its parameters and what became of it, as a pandas DataFrame."""

import json
import os
import warnings
from collections.abc import Iterable, Mapping
from inspect import cleandoc

import numpy as np
import pandas

from ..arguments import FLAG, PATH, takes, wrong
from ..measures.fragments import STRUCTURE, fragment_labels, heaviest_fragment, structure_of
from ..measures.ledger import fractions_at, largest_work
from ..measures.periodic_cell import AVERAGED, pressure_at_end
from ..measures.structure import mean_coordination
from ..progress import progress
from ..runs.collect import run_folders
from ..runs.files import RunFolderError
from ..runs.folder import RunFolder, open_run
from ..runs.format import BONDS, CHANNEL_TABLE, CHANNELS, COLLISION, COMPRESSION, PARAMETER_UNITS, RUN_KINDS
from ..runs.table import FOLDER, RUN, Column, columns_text, described, make_table
from .summary import COMPRESSION_KEYS, ENERGY_KEYS, OUTCOME_KEYS, TENSION_KEYS, summarise

at_end = "{}_at_end".format
final = "final_{}".format
of_largest = "largest_{}".format

# How a run is stored and carried out, which says nothing of its physics.
_BOOKKEEPING = ("out", "overwrite", "resume", "checkpointInterval", "threads", "states", "unusual")

RUNS = "a path, a pattern, a RunFolder, or a list of these"

# Parameters that follow from another one as a rule.
_FOLLOWING = dict.fromkeys(
    ("grainRadius", "young", "poisson", "density", "surfaceEnergy", "criticalRolling"), "material"
)
_FOLLOWING |= dict.fromkeys(("sizeRatio", "sizeFraction", "sizeSpread"), "sizes")

OUTCOME = (
    Column("kind", "", "of run", "O"),
    Column("ended", "", "whether it came to its planned end; another one is measured as far as it went", "b"),
    Column("time", "s", "of the last sample"),
    Column("ended_by", "", "what ended a compression: a parameter, and where", "O", gaps=True),
    *(column for column in OUTCOME_KEYS if column.name != "mass_fractions"),
    Column(
        "largest_fraction",
        "1",
        "fraction of the mass in the largest piece; without grains in no aggregate at the start",
        gaps=True,
    ),
    Column("second_fraction", "1", "in the second largest", gaps=True),
    *TENSION_KEYS,
)
LARGEST = (
    *(
        Column(of_largest(c.name), c.unit, f"of the largest piece that grains alone connect: {c.meaning}", gaps=True)
        for c in STRUCTURE
    ),
    Column("largest_coordination", "1", "of this piece: mean number of contacts of a grain with others", gaps=True),
)
ENERGIES = (
    *ENERGY_KEYS,
    *(
        Column(
            at_end(c.name),
            "K(0)",
            f"{c.label}, change from the start to the end (kinetic: what is left); of a compression over the boundaries' largest work, W",
            gaps=True,
        )
        for c in CHANNEL_TABLE
    ),
)
PRESSURE = f"over the last {AVERAGED:g} t0: work on the boundaries over the change of volume, after a stretching mean of the samples"
SERIES = tuple(
    Column(
        final(series.name),
        series.unit,
        PRESSURE if series.name == "pressure" else f"at the end: {series.meaning}",
        gaps=True,
    )
    for series in (*BONDS, *(series for kind in RUN_KINDS.values() for series in kind.series))
)
MEASURED = (*OUTCOME, *LARGEST, *COMPRESSION_KEYS, *ENERGIES, *SERIES)
OF_EQUAL = "d", "v"  # series without a meaning where the aggregates' masses differ
VALUES = 5  # that are listed, where they differ
# What is said of a run in one line.
SHORT = (
    *("outcome", "largest_fraction", "fragments", "growth_efficiency", "mass_on_plate", "restitution", "d_max"),
    *("final_filling", "final_pressure", "energy_closure"),
)


@takes(structure=FLAG)
def table(runs, structure=True):
    """DataFrame with a row a run.

    runs: a path (a run folder, or a folder with such up to two levels below), a pattern ("runs/**"), a RunFolder, or a list of these.
    structure: whether the structure of the largest piece is measured, which takes a moment for 100,000 grains.

    Columns: run (the folder's name), the parameters of run.json by their names (but for those of bookkeeping), MEASURED (outcome,
    largest piece, energies in J and over K(0), last values of the kind's series) and folder (the path). All SI; units and meanings
    are in .attrs["units"] and .attrs["meanings"], names of the parameters in .attrs["parameters"]. Where there is no value stands NaN or None.

    A run that cannot be read is left out with a warning; RunFolderError where none is left.

    >>> list(column.name for column in LARGEST)
    ['largest_filling_factor', 'largest_gyration_radius', 'largest_fractal_dimension', 'largest_coordination']
    """
    measured, problems = measure(runs, lambda run: row(run, structure))
    if not measured:
        raise RunFolderError(problems[0] if problems else "no runs given")
    for problem in problems:
        warnings.warn(problem, stacklevel=2)
    return frame(measured)


table.__doc__ = f"{cleandoc(table.__doc__)}\n\n{columns_text(MEASURED)}"


def frame(measured):
    """DataFrame as of table() from [(path, row())]."""
    made, measures = make_table(measured), {column.name for column in MEASURED}
    parameters = [name for name in made if name not in (RUN, FOLDER, *measures)]
    order = [RUN, *parameters, *(column.name for column in MEASURED if column.name in made), FOLDER]
    units = [Column(name, PARAMETER_UNITS.get(name, ""), "parameter of the run") for name in parameters]
    found = described(made[order], (*units, *MEASURED))
    found.attrs["parameters"] = parameters
    return found


def parameters(found):
    """Names of the parameters of a table(): where pandas has dropped .attrs (merge, read_csv) the columns between the run and its kind."""
    names = list(found)
    if "parameters" in found.attrs or not {RUN, "kind"} <= set(names):
        return found.attrs.get("parameters", ())
    return names[names.index(RUN) + 1 : names.index("kind")]


def short_text(found):
    """A line a run of a table(): its folder, the parameters in which the runs of a kind differ, and SHORT as far as there is any."""
    kinds = [found[found.kind == kind] for kind in found.kind.unique()]
    differing = [name for own in kinds for name in varied(own)] + (["kind"] if len(kinds) > 1 else [])
    first = [FOLDER, *(["velocity"] if "velocity" in found else []), *differing]
    shown = [name for name in SHORT if name in found and found[name].notna().any()]
    names = dict.fromkeys([*first, *([] if found.ended.all() else ["ended"]), *shown])
    units = {name: found.attrs["units"].get(name, "") for name in names}
    heads = {name: name + (f" [{unit}]" if unit not in ("", "1") else "") for name, unit in units.items()}
    text = found[list(names)]
    if "d_max" in names:
        shown = zip(found.d_max, found.maximum_inside)
        text = text.assign(d_max=[f"{'' if inside else '>='}{d:.4g}" if d == d else "-" for d, inside in shown])
    text = text.rename(columns={**heads, FOLDER: RUN})
    return text.to_string(index=False, na_rep="-", float_format="{:.4g}".format)


def measure(runs, of):
    """([(path, of(RunFolder))], [what is wrong with the others, one line each]) of runs as in table()."""
    measured, problems = [], []
    for run, problem in progress(_folders(runs), "reading runs"):
        try:
            if problem:
                raise RunFolderError(problem)
            run = run if isinstance(run, RunFolder) else open_run(run)
            measured.append((run.path, of(run)))
        except RunFolderError as error:
            problems.append(str(error))
    return measured, problems


def row(run, structure=True):
    """{column: value} of a RunFolder, its parameters and MEASURED; RunFolderError when a state is missing or damaged."""
    numbers = summarise(run)
    del numbers[RUN]
    fractions = numbers.pop("mass_fractions") or (None, None)
    changes = _changes(run)
    without = OF_EQUAL if run.kind is COLLISION and numbers["d_max"] is None else ()
    values = {
        "kind": run.kind.name,
        **numbers,
        **dict(zip(("largest_fraction", "second_fraction"), fractions)),
        **{at_end(channel): changes.get(channel) for channel in CHANNELS},
        **{
            final(series.name): None if series.name in without else _at_end(run, series.name)
            for series in (*BONDS, *run.kind.series)
            if series.name in run.history
        },
        **(_largest(run.last) if structure else {}),
    }
    numeric = {column.name for column in MEASURED if column.kind == "f"}
    gaps = {name: np.nan for name, value in values.items() if value is None and name in numeric}
    return {**parameters_of(run), **values, **gaps}


def _changes(run):
    """{channel: change from the start to the end}, over K(0); of a compression, which starts almost at rest, over the boundaries' largest work."""
    if run.kind is not COMPRESSION:
        return fractions_at(run.history, run.history["time"][-1]) or {}
    work = largest_work(run.history)
    return {c: (run.history[c][-1] - run.history[c][0]) / work for c in CHANNELS} if work > 0 else {}


def _at_end(run, name):
    """Last value of a series; a pressure, which oscillates, is a mean."""
    if run.kind is COMPRESSION and name == "pressure":
        return pressure_at_end(run.history, AVERAGED * run.derived["timeUnit"])
    return run.history[name][-1]


def parameters_of(run):
    """{name: value} of a run's parameters, as far as they say something of its physics."""
    text = lambda value: json.dumps(value) if isinstance(value, (list, dict)) else value  # which can be compared
    return {name: text(value) for name, value in run.settled.items() if name not in _BOOKKEEPING}


def varied(found):
    """Names of the parameters in which the rows of a table() differ, without those that follow from others: steps that were chosen by their
    error, constants of the material, of the
    distribution of sizes, the duration, the filling that a compression starts from, the projectile's grains where both have as many, and
    the size of aggregates that are grown or read, or grains of those that are cut."""
    names = [name for name in parameters(found) if name in found and found[name].nunique(dropna=False) > 1]
    if {"grains", "projectileGrains"} <= set(names) and (found.projectileGrains == found.grains).all():
        names.remove("projectileGrains")
    if (
        "stepFraction" in names and "tolerance" in found and found.tolerance.notna().all()
    ):  # chosen, by the velocity too
        names.remove("stepFraction")
    packings = set(found.packing) if "packing" in found else set()
    cut, sizes = ("grains", "projectileGrains"), ("filling", "radius")
    sizes = cut if packings == {"cpe"} else () if "cpe" in packings else sizes
    for name in (*_FOLLOWING, "duration", "initialFilling", *sizes):
        leading = _FOLLOWING.get(name)
        others = [other for other in names if (other == leading if leading else other != name)]
        if name in names and others and found.groupby(others, dropna=False)[name].nunique().max() == 1:
            names.remove(name)
    return names


def differing(found, names, must):
    """The line that says in which parameters the rows of a table() differ, and what must be done."""
    values = [f"{value:g}" if isinstance(value, float) else str(value) for value in found[names[0]].unique()]
    some = ", ".join(values[:VALUES]) + (", ..." if len(values) > VALUES else "")
    return f"the runs differ in {', '.join(names)} too: {must} ({names[0]} is {some})"


def _largest(state):
    """{column: value} of LARGEST of the state's largest piece, by mass."""
    labels = fragment_labels(len(state.radius), state.contact_pairs)
    largest = heaviest_fragment(labels, (state.radius / state.radius.max()) ** 3)
    own = np.flatnonzero(labels == largest)
    structure = structure_of(state.position, state.radius, [own], state.cell_size)
    contacts = state.contact_pairs[labels[state.contact_pairs[:, 0]] == largest]
    return {
        **{of_largest(name): float(values[0]) for name, values in structure.items()},
        "largest_coordination": mean_coordination(len(own), contacts),
    }


def _folders(runs):
    """[(RunFolder or its path, None) or (None, what is wrong)] of what table() is given."""
    several = [runs] if isinstance(runs, (str, os.PathLike, RunFolder)) else runs
    if isinstance(several, (bytes, Mapping, pandas.DataFrame)) or not isinstance(several, Iterable):
        raise wrong("runs", runs, RUNS)
    several = list(several)
    for run in several:
        if not (isinstance(run, RunFolder) or PATH.is_right(run)):
            raise wrong("runs", run, RUNS)
    opened = {run.path.resolve(): run for run in several if isinstance(run, RunFolder)}
    others = run_folders([path for path in several if not isinstance(path, RunFolder)])
    return [(run, None) for run in opened.values()] + [
        (path, problem) for path, problem in others if problem or path.resolve() not in opened
    ]
