"""Numbers of one run as a dict, a row a run as a pandas DataFrame (its parameters and what became of it), and both as
readable text."""

import json
import os
import textwrap
import warnings

import numpy as np

from ..measures.fragments import fragment_labels, grain_masses, heaviest_fragment
from ..measures.outcome import NEVER_MET
from ..measures.periodic_cell import AVERAGED, SMOOTHED, pressure_at_end, tensile_strength
from ..measures.structure import mean_coordination
from ..progress import progress
from ..runs.collect import run_folders
from ..runs.files import RunFolderError
from ..runs.folder import WIDTH, RunFolder, open_run, settings
from ..runs.format import BONDS, CHANNEL_TABLE, CHANNELS, COLLISION, COMPRESSION, PARAMETER_UNITS, RUN_KINDS
from ..runs.ledger import closure, fractions_at, initial_kinetic_energy, largest_work, released_before, work_closure
from ..runs.measured import are_equal, maximum_of_run, met, outcome_of_run, time_of_touch, unit_of
from ..runs.pieces import STRUCTURE, structure_of
from ..runs.table import FOLDER, RUN, Column, described, make_table

at_end = "{}_at_end".format
final = "final_{}".format
of_largest = "largest_{}".format

OF_COLLISION = (
    Column("d_max", "m", "largest compression length until the first rebound (A24 eqs 10, 11), of equal aggregates"),
    Column("d_max_error", "m", "its error"),
    Column("t_max", "s", "its time"),
    Column("t_max_error", "s", "its error"),
    Column("maximum_inside", "", "False: d_max is only a bound, at an end of the record", "O"),
    Column("restitution", "1", "coefficient of restitution (measures.outcome), of a plate along its normal"),
    Column("restitution_tangential", "1", "velocity along a plate that was hit at a slant, over that before"),
    Column("outcome", "", "sticking, bouncing, fragmentation, never met, undecided (measures.outcome, .plate)", "O"),
    Column("why_undecided", "", "why an outcome may still become another one", "O"),
    Column("mass_fractions", "1", "of the mass, in the two largest pieces", "O"),
    Column("largest_fragment", "", "number of grains of the largest piece by mass"),
    Column("fragments", "", "number of pieces"),
    Column(
        "growth_efficiency",
        "1",
        "(m_largest - m_target)/m_projectile (A22 eq 28), the target being the heavier; of a plate m_on/m",
    ),
    Column("mass_on_plate", "1", "of the mass, what sticks to the plate"),
    Column("released", "K(0)", "what contacts released before the first touch, as they did not start at rest"),
)
NOTICED = 0.01  # K(0) that is released, beyond which a summary says so
OF_STRETCHING = (
    Column("tensile_strength", "Pa", f"largest tension while stretched, over {SMOOTHED:g} of the way to it"),
    Column("tensile_filling", "1", "filling factor there"),
)
ENERGIES = (
    Column(
        "energy_closure", "1", "max |E(t) - E(0)|/K(0); else over the largest work of boundaries, or largest change"
    ),
    Column("initial_kinetic_energy", "J", "K(0)"),
    *(Column(channel.name, "J", f"{channel.label}, at the end") for channel in CHANNEL_TABLE),
)
PIECE = "fraction of the mass in the {} piece, without grains in no aggregate at the start"
CHANGE = "{}, change from the start to the end (kinetic: what is left); of a compression over its largest work W"
PRESSURE = f"over the last {AVERAGED:g} t0: work over the change of volume, after a stretching mean of the samples"
_SERIES = (*BONDS, *(series for kind in RUN_KINDS.values() for series in kind.series))
# What a row of table() has beside parameters; all may have gaps but kind, ended, time and energies in J.
MEASURED = (
    Column("kind", "", "of run", "O"),
    Column("ended", "", "whether it came to its planned end; another one is measured as far as it went", "b"),
    Column("time", "s", "of the last sample"),
    Column("ended_by", "", "what ended a compression: a parameter, and where", "O"),
    *(column for column in OF_COLLISION if column.name != "mass_fractions"),
    Column("largest_fraction", "1", PIECE.format("largest")),
    Column("second_fraction", "1", PIECE.format("second largest")),
    *OF_STRETCHING,
    *(
        Column(of_largest(c.name), c.unit, f"of the largest piece, by contacts of grains: {c.meaning}")
        for c in STRUCTURE
    ),
    Column("largest_coordination", "1", "of this piece: mean number of contacts of a grain with others"),
    *ENERGIES,
    *(Column(at_end(c.name), "K(0)", CHANGE.format(c.label)) for c in CHANNEL_TABLE),
    *(Column(final(s.name), s.unit, PRESSURE if s.name == "pressure" else f"at the end: {s.meaning}") for s in _SERIES),
)

# Parameters of how a run is stored and carried out, which say nothing of its physics.
_BOOKKEEPING = ("out", "overwrite", "resume", "checkpointInterval", "threads", "states", "unusual")
# {parameter: another one from which it follows as a rule}
_FOLLOWING = {
    **dict.fromkeys(("grainRadius", "young", "poisson", "density", "surfaceEnergy", "criticalRolling"), "material"),
    **dict.fromkeys(("sizeRatio", "sizeFraction", "sizeSpread", "sizeExponent", "smallest", "largest"), "sizes"),
}
VALUES = 5  # that are listed, where runs differ


def summarise(run):
    """Numbers of a RunFolder as a dict, in SI units, None for what it does not have: run (path), ended, time (of the
    last sample), ended_by (what ended a compression), those of OF_COLLISION and OF_STRETCHING, energy_closure,
    initial_kinetic_energy and every channel at the end. RunFolderError if a state is missing or damaged."""
    history, collision, compression = run.history, run.kind is COLLISION, run.kind is COMPRESSION
    numbers = {"run": str(run.path), "ended": run.ended, "time": float(history["time"][-1])}
    numbers["ended_by"] = run.record.get("endedBy")
    numbers.update(dict.fromkeys(column.name for column in (*OF_COLLISION, *OF_STRETCHING)))
    if collision:
        numbers.update(_collision(run))
    if compression:
        strength, filling = tensile_strength(history, AVERAGED * run.derived["timeUnit"])
        if np.isfinite(strength):
            numbers.update(tensile_strength=strength, tensile_filling=filling)
    numbers["energy_closure"] = work_closure(history) if compression else closure(history, unit_of(run)[0])
    numbers["initial_kinetic_energy"] = initial_kinetic_energy(history)
    numbers.update({name: float(history[name][-1]) for name in CHANNELS})
    return numbers


def _collision(run):
    """{name: value} of OF_COLLISION, as far as there are values."""
    outcome, numbers = outcome_of_run(run), {}
    maximum = maximum_of_run(run) if are_equal(run) and met(run) else None
    if maximum is not None:
        numbers.update(d_max=float(maximum.length), t_max=float(maximum.time), maximum_inside=maximum.inside)
        if maximum.inside:
            numbers.update(d_max_error=float(maximum.length_error), t_max_error=float(maximum.time_error))
    numbers.update({c.name: getattr(outcome, c.name) for c in OF_COLLISION if hasattr(outcome, c.name)})
    if outcome.kind == NEVER_MET:  # no collision whose growth a mean could have
        numbers["growth_efficiency"] = None
    numbers["released"] = released_before(run.history, time_of_touch(run) if met(run) else np.inf)
    return {**numbers, "outcome": outcome.kind, "mass_fractions": list(outcome.mass_fractions)}


def table(runs, structure=True):
    """Table of runs.

    Parameters
    ----------
    runs : path, pattern, RunFolder or list of these
        A path is a run folder, or a folder with such up to two levels below; a pattern is like "runs/**".
    structure : bool
        Whether the structure of the largest piece is measured, which takes a moment for 100,000 grains.

    Returns
    -------
    pandas.DataFrame
        A row a run: run (the folder's name), the parameters of run.json that say something of the physics, what
        report.rows.MEASURED lists (outcome, largest piece, energies in J and over K(0), last values of the series), and
        folder (the path). All SI, NaN or None for what a run does not have. Units, meanings and the names of the
        parameters are in .attrs["units"], .attrs["meanings"] and .attrs["parameters"]. RunFolderError if no run can
        be read; one that can't among others is left out with a warning.
    """
    measured, problems = measure(runs, lambda run: row(run, structure))
    if not measured:
        raise RunFolderError(problems[0] if problems else "no runs given")
    for problem in problems:
        warnings.warn(problem, stacklevel=2)
    return frame(measured)


def measure(runs, of):
    """([(path, of(RunFolder))], [what is wrong with the others, one line each]) of runs as in table()."""
    several = [runs] if isinstance(runs, (str, os.PathLike, RunFolder)) else runs
    paths = [run.path if isinstance(run, RunFolder) else run for run in several]
    measured, problems = [], []
    for path, problem in progress(run_folders(paths), "reading runs"):
        try:
            if problem:
                raise RunFolderError(problem)
            measured.append((path, of(open_run(path))))
        except RunFolderError as error:
            problems.append(str(error))
    return measured, problems


def row(run, structure=True):
    """{column: value} of a RunFolder, its parameters and MEASURED; RunFolderError when a state is missing or
    damaged."""
    numbers = summarise(run)
    del numbers[RUN]
    first, second = numbers.pop("mass_fractions") or (None, None)
    numbers.update(kind=run.kind.name, largest_fraction=first, second_fraction=second)
    numbers.update({at_end(name): change for name, change in _changes(run).items()})
    unlike = run.kind is COLLISION and numbers["d_max"] is None  # d and v have no meaning then
    for name in (series.name for series in (*BONDS, *run.kind.series) if series.name in run.history):
        numbers[final(name)] = None if unlike and name in ("d", "v") else run.history[name][-1]
    if run.kind is COMPRESSION:  # the pressure oscillates
        numbers[final("pressure")] = pressure_at_end(run.history, AVERAGED * run.derived["timeUnit"])
    if structure:
        numbers.update(_largest(run.last))
    numeric = {column.name for column in MEASURED if column.kind == "f"}
    gaps = {name: np.nan for name, value in numbers.items() if value is None and name in numeric}
    return {**parameters_of(run), **numbers, **gaps}


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
    """Names of the parameters of a table(): without .attrs (merge, read_csv) the columns between the run and its
    kind."""
    names = list(found)
    if "parameters" in found.attrs or not {RUN, "kind"} <= set(names):
        return found.attrs.get("parameters", ())
    return names[names.index(RUN) + 1 : names.index("kind")]


def parameters_of(run):
    """{name: value} of a run's parameters, as far as they say something of its physics."""
    text = lambda value: json.dumps(value) if isinstance(value, (list, dict)) else value  # which can be compared
    return {name: text(value) for name, value in run.settled.items() if name not in _BOOKKEEPING}


def varied(found):
    """Names of the parameters in which the rows of a table() differ, without those that follow from others.

    These are steps that were chosen by their error, constants of the material and of the distribution of sizes, the
    duration, the filling that a compression starts from, the projectile's grains if both have as many, and the size of
    aggregates that are grown or read, or the grains of those that are cut.
    """
    names = [name for name in parameters(found) if name in found and found[name].nunique(dropna=False) > 1]
    if {"grains", "projectileGrains"} <= set(names) and (found.projectileGrains == found.grains).all():
        names.remove("projectileGrains")
    if "stepFraction" in names and "tolerance" in found and found.tolerance.notna().all():
        names.remove("stepFraction")
    packings = set(found.packing) if "packing" in found else set()
    sizes = (
        ("grains", "projectileGrains") if packings == {"cpe"} else () if "cpe" in packings else ("filling", "radius")
    )
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


def _changes(run):
    """{channel: change from the start to the end} over unit_of(run), or over a compression's largest work; None without
    either."""
    history = run.history
    if run.kind is not COMPRESSION:
        return fractions_at(history, history["time"][-1], unit_of(run)[0]) or dict.fromkeys(CHANNELS)
    work = largest_work(history)
    return {c: (history[c][-1] - history[c][0]) / work if work > 0 else None for c in CHANNELS}


def _largest(state):
    """{column: value} of the structure of a state's largest piece, by mass."""
    labels = fragment_labels(len(state.radius), state.contact_pairs)
    largest = heaviest_fragment(labels, grain_masses(vars(state)))
    own = np.flatnonzero(labels == largest)
    structure = structure_of(state.position, state.radius, [own], state.cell_size)
    contacts = state.contact_pairs[labels[state.contact_pairs[:, 0]] == largest]
    found = {of_largest(name): float(values[0]) for name, values in structure.items()}
    return {**found, "largest_coordination": mean_coordination(len(own), contacts)}


# ---- as text ----

# Columns of the line of a run.
SHORT = (
    *("outcome", "largest_fraction", "fragments", "growth_efficiency", "mass_on_plate", "restitution", "d_max"),
    *("final_filling", "final_pressure", "energy_closure"),
)


def short_text(found):
    """A line a run of a table(): its folder, the parameters in which the runs of a kind differ, and SHORT."""
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
    lines = [text.to_string(index=False, na_rep="-", float_format="{:.4g}".format)]
    for path, released in zip(found[FOLDER], found.get("released", [])):
        lines += [f"{path}: {_release(released)}"] if released > NOTICED else []
    return "\n".join(lines)


def _release(released):
    start = "the aggregates did not start at rest (atRest=1)"
    return f"contacts released {released:.3g} K(0) before the first touch: {start}"


def long_text(run, row):
    """Several lines (str) of a RunFolder and its row of a table(): parameters, what was measured, energies."""
    energies = [name for channel in CHANNEL_TABLE for name in (channel.name, at_end(channel.name))]
    measured = [column for column in MEASURED if column.name not in ("ended", "time", *energies)]
    names = {column.name for column in measured}
    own = (Column(final(series.name), series.unit, f"at the end: {series.meaning}") for series in run.kind.series)
    measured += [column for column in own if column.name not in names]  # of a kind of a script's own
    known = [column for column in measured if row.get(column.name) is not None and row[column.name] == row[column.name]]
    state = "ended" if run.ended else "NOT ENDED: analysed as far as it went"
    lines = [f"run {run.path} ({state}, t = {row['time'] * 1e9:.4g} ns)"]
    told = settings(run.parameters, run.derived)
    lines.append(textwrap.fill(told, WIDTH, initial_indent="  ", subsequent_indent="  "))
    for column in known:
        lines.append(f"  {column.name:<24}{_number(row[column.name], column.unit):<16} {column.meaning}".rstrip())
    if (row.get("released") or 0.0) > NOTICED:
        lines.append(f"  {_release(row['released'])}")
    lines.append(f"\n  {'energy':<28}{'at the end [J]':>14}{'change':>12} (of {unit_of(run)[1]})")
    for channel in CHANNEL_TABLE:
        change = row[at_end(channel.name)]
        lines.append(
            f"  {channel.label:<28}{row[channel.name]:>14.5g}{'-' if change != change else f'{change:.3%}':>12}"
        )
    return "\n".join(line for line in lines if line.strip())


def _number(value, unit):
    return (f"{value:.4g}" if isinstance(value, float) else str(value)) + (f" {unit}" if unit != "1" else "")
