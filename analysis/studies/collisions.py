"""What studies of collisions have in common: columns of a run's outcome, return and energy, what follows from them, and a study of a
question of one's own."""

import numpy as np

from ..measures.compression import first_compression, largest_return_speed
from ..measures.ledger import fractions_at, initial_kinetic_energy
from ..measures.of_run import met, outcome_of_run
from ..measures.outcome import BOUNCING, FRAGMENTATION, NEVER_MET, STICKING, UNDECIDED
from ..measures.structure import mean_coordination
from ..runs.arrays import RunFolderError
from ..runs.collect import Scene
from ..runs.format import CHANNELS, HISTORY_FILE, LABELS, LOST_CHANNELS, PARAMETER_WORDS
from ..runs.table import Column
from .columns import CLOSURE, VELOCITY, group, parameter
from .definition import NotMeasured, Quantity, Study

AT_MAXIMUM = "{}_at_maximum"  # the column of a channel's change from the start to t_max
# Parameters of the collisions of Arakawa et al. (2024), but for the packing.
HEAD_ON_ICE = {"impact": 0.0, "viscoelasticTime": 0.0, "neck": 0.0, "planar": 0, "limit": "held", "material": "ice"}
HEAD_ON_ICE |= {"removeLooseGrains": 0, "initialOverlap": 1.0}


def largest_compression(run):
    """(measures.compression.Maximum, whether d exceeds it later) of a RunFolder's first compression. NotMeasured where the
    aggregates never met or never turned around, RunFolderError where they had no kinetic energy."""
    history = run.history
    maximum, exceeded = first_compression(history["time"], history["d"], history["v"])
    if maximum is None or not maximum.inside or not met(run):
        raise NotMeasured(f"{run.path}: the aggregates have not met, or not turned around")
    if not initial_kinetic_energy(history) > 0:
        raise RunFolderError(f"{run.path / HISTORY_FILE}: no kinetic energy at the start")
    return maximum, exceeded


def _outcome(run, row):
    """RunFolderError where the states don't make an outcome."""
    outcome, v = outcome_of_run(run), run.history["v"]
    return outcome.kind, outcome.restitution, float(np.nan_to_num(v[-1] / row["velocity"]) ** 2)


def returned(history, time):
    """(largest speed [m/s] at which the halves part, its time [s]) after a time [s]; NaN where they never part, or the record ends before
    their speed falls."""
    return tuple(
        np.nan if value is None else value for value in largest_return_speed(history["time"], history["v"], time)
    )


def _changes(run, row):
    """Changes of all channels until the largest speed of return (NaN: unknown), until the largest compression, and until the end, over K(0)."""
    times = row["return_time"], largest_compression(run)[0].time, run.history["time"][-1]
    parts = [fractions_at(run.history, time) if np.isfinite(time) else {} for time in times]
    return [part.get(channel, np.nan) for part in parts for channel in CHANNELS]


OUTCOME = group(
    _outcome,
    Column("outcome", "", "as measures.outcome has it", kind="O"),
    Column("restitution", "", "none for fragmentation and for pieces that passed each other", gaps=True),
    Column("bulk", "", "(v/v_col)^2 at the end: the fraction of K(0) in the motion of the halves"),
)
LARGEST = group(
    lambda run, row: (float(outcome_of_run(run).mass_fractions[0]),),
    Column("largest_fraction", "", "fraction of the mass in the largest piece"),
)
_COORDINATION = group(
    lambda run, row: (mean_coordination(len(run.start.radius), run.start.contact_pairs),),
    Column("coordination", "", "mean number of contacts of a grain at the start"),
)
_RETURN = group(
    lambda run, row: returned(run.history, largest_compression(run)[0].time),
    Column("return_speed", "m/s", "largest speed at which the halves part after t_max", gaps=True, absent=np.nan),
    Column("return_time", "s", "its time", gaps=True, absent=np.nan),
)
# Columns without gaps come last, so that a row that was cut short is noticed.
_WHEN = {"{}_at_return": ("return_time", {"gaps": True, "absent": np.nan}), AT_MAXIMUM: ("t_max", {"absent": 0.0})}
_WHEN["{}_at_end"] = "the end", {"absent": 0.0}
_CHANGE = "{}, change from the start to {} (kinetic: what is left)"
_PARTITION = group(
    _changes,
    *(
        Column(name.format(c), "K(0)", _CHANGE.format(LABELS[c], when), **more)
        for name, (when, more) in _WHEN.items()
        for c in CHANNELS
    ),
)
# What studies of compact aggregates have in common.
COMPACT = (_COORDINATION, CLOSURE, OUTCOME, _RETURN, _PARTITION)


def outcome_quantities(runs, by):
    """Quantities of a runs.Runs with the columns of OUTCOME, by the columns `by`: fractions of the runs that stick, bounce and break, of those
    that met, with undecided ones apart, and the mean restitution of those that bounce."""
    undecided = lambda table: table.outcome == UNDECIDED
    met = runs.where(lambda table: table.outcome != NEVER_MET)
    for name, kind in (("sticking", STICKING), ("bouncing", BOUNCING), ("breaking", FRAGMENTATION)):
        values = met.fractions(lambda table, kind=kind: table.outcome == kind, by, undecided)
        yield Quantity(name, f"runs that end in {kind}", values)
    restitution = runs.where(outcome=BOUNCING).estimates("restitution", by)
    yield Quantity("restitution", "coefficient of restitution of runs that bounce", restitution)
    (largest,) = LARGEST.columns
    if largest.name in runs.table:
        yield Quantity("largest", largest.meaning, runs.estimates(largest.name, by))


def energy_quantities(runs, by, lost, changes):
    """Quantities, named lost and changes, of a runs.Runs with the columns of COMPACT, by the columns `by`: what is dissipated until t_max, and
    the change of every channel that changes at all (by `channel` too)."""
    values = runs.estimates(lambda table: table[[AT_MAXIMUM.format(c) for c in LOST_CHANNELS]].sum(axis=1), by)
    yield Quantity(lost, "dissipated until t_max, of K(0)", values, "%")
    columns = {c: AT_MAXIMUM.format(c) for c in CHANNELS if c != "kinetic"}
    changing = {c: name for c, name in columns.items() if (runs.table[name] != 0).any()} or columns  # all: of no runs
    values = runs.parts(changing, by, "channel")
    yield Quantity(changes, "change of each channel until t_max, of K(0)", values, "%")


def collision_study(title, question, varied, quantities, **values):
    """definition.Study of a question of one's own about collisions: varied: the parameters that differ from run to run, seed among them;
    quantities: a function of the table of runs, as definition.Study has it; values: parameters that every run has. Run folders that
    differ in another parameter are refused together.

    A run's row has the parameters varied, and the columns of OUTCOME and LARGEST."""
    kinds = {name: "O" if name in PARAMETER_WORDS else "f" for name in varied}
    parameters = [parameter(name, "", "as the table of runs has it", kind) for name, kind in kinds.items()]
    measured = (*parameters, *(() if "velocity" in varied else (VELOCITY,)), OUTCOME, LARGEST)
    of_numbers, of_words = (tuple(name for name in varied if kinds[name] == kind) for kind in "fO")
    scene = Scene(title, values, of_numbers, measured=of_words)
    return Study(title, question, scene, measured, quantities, alike=True)
