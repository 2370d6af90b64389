"""What studies of collisions have in common: columns of a run's outcome, return phase and energy partition, what follows from them, and a
study of a question of one's own."""

from types import MappingProxyType

import numpy as np

from ..measures.compression import first_compression
from ..measures.coordination import mean_coordination
from ..measures.ledger import closure, fractions_at, initial_kinetic_energy
from ..measures.of_run import met, outcome_of_run
from ..measures.outcome import BOUNCING, FRAGMENTATION, STICKING, UNDECIDED
from ..measures.return_phase import largest_return_speed
from ..runs.arrays import RunFolderError
from ..runs.collect import Scene
from ..runs.format import CHANNELS, HISTORY_FILE, LABELS
from ..runs.table import Column
from .definition import NotMeasured, Quantity, Study
from .runs import together

# Parameters of A24's collisions, but for the packing.
HEAD_ON_ICE = MappingProxyType(
    {
        "impact": 0.0,
        "viscoelasticTime": 0.0,
        "neck": 0.0,
        "planar": 0,
        "limit": "held",
        "material": "ice",
        "removeLooseGrains": 0,
        "initialOverlap": 1.0,
    }
)


def at_maximum(channel):
    """Name of the column of a channel's change from the start to t_max."""
    return f"{channel}_at_maximum"


def at_return(channel):
    """Name of the column of a channel's change from the start to the largest return speed."""
    return f"{channel}_at_return"


def at_end(channel):
    """Name of the column of a channel's change from the start to the end."""
    return f"{channel}_at_end"


# Columns without gaps come last, so that a row that was cut short is noticed.
PARTITION_COLUMNS = (
    *(
        Column(
            at_return(c),
            "K(0)",
            f"{LABELS[c]}, change from the start to return_time (kinetic: what is left)",
            gaps=True,
            absent=np.nan,
        )
        for c in CHANNELS
    ),
    *(
        Column(name(c), "K(0)", f"{LABELS[c]}, change from the start to {when} (kinetic: what is left)", absent=0.0)
        for name, when in ((at_maximum, "t_max"), (at_end, "the end"))
        for c in CHANNELS
    ),
)
OUTCOME_COLUMNS = (
    Column("outcome", "", "as measures.outcome has it", kind="O"),
    Column("restitution", "", "none for fragmentation and for pieces that passed each other", gaps=True),
    Column("bulk", "", "(v/v_col)^2 at the end: the fraction of K(0) in the motion of the halves"),
)
LARGEST_COLUMN = Column("largest_fraction", "", "fraction of the mass in the largest piece")
RETURN_COLUMNS = (
    Column("return_speed", "m/s", "largest speed at which the halves part after t_max", gaps=True, absent=np.nan),
    Column("return_time", "s", "its time", gaps=True, absent=np.nan),
)

# What studies of compact aggregates have in common.
COLLISION_COLUMNS = (
    Column("coordination", "", "mean number of contacts of a grain at the start"),
    Column("closure", "", "largest error of the energy ledger over K(0)"),
    *OUTCOME_COLUMNS,
    *RETURN_COLUMNS,
    *PARTITION_COLUMNS,
)


def collision_values(run, velocity, time):
    """{column: value} of COLLISION_COLUMNS of a RunFolder, at the collision velocity [m/s], with the largest compression at time [s].
    RunFolderError where the states don't make an outcome."""
    history, returned = run.history, return_values(run.history, time)
    return {
        "coordination": mean_coordination(len(run.start.radius), run.start.contact_pairs),
        "closure": closure(history),
        **outcome_values(run, velocity),
        **returned,
        **energy_partition(history, time, returned["return_time"]),
    }


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


def outcome_values(run, velocity):
    """{column: value} of OUTCOME_COLUMNS of a RunFolder, at the collision velocity [m/s]. RunFolderError where the states
    don't make an outcome."""
    outcome, v = outcome_of_run(run), run.history["v"]
    return {
        "outcome": outcome.kind,
        "restitution": outcome.restitution,
        "bulk": float(np.nan_to_num(v[-1] / velocity) ** 2),
    }


def return_values(history, time):
    """{column: value} of RETURN_COLUMNS from a history and the time [s] of the largest compression; NaN where the halves
    never part, or the record ends before their speed falls."""
    speed, when = largest_return_speed(history["time"], history["v"], time)
    return {"return_speed": _or_nan(speed), "return_time": _or_nan(when)}


def energy_partition(history, time, return_time=np.nan):
    """{column: value} of PARTITION_COLUMNS, from a history (measures.ledger), the time [s] of the largest compression and
    that of the largest return speed (NaN: unknown); K(0) must not be 0."""
    middle, end = fractions_at(history, time), fractions_at(history, history["time"][-1])
    known = np.isfinite(return_time)
    back = fractions_at(history, return_time) if known else dict.fromkeys(CHANNELS, float("nan"))
    return {
        **{at_maximum(c): middle[c] for c in CHANNELS},
        **{at_end(c): end[c] for c in CHANNELS},
        **{at_return(c): back[c] for c in CHANNELS},
    }


def _or_nan(value):
    return float("nan") if value is None else value


def outcome_quantities(runs, by):
    """Quantities of a runs.Runs with OUTCOME_COLUMNS, by the columns `by`: fractions of the runs that stick, bounce and break, with undecided
    ones apart, and the mean restitution of those that bounce."""
    undecided = lambda table: table.outcome == UNDECIDED
    for name, kind in (("sticking", STICKING), ("bouncing", BOUNCING), ("breaking", FRAGMENTATION)):
        values = runs.fractions(lambda table, kind=kind: table.outcome == kind, by, undecided)
        yield Quantity(name, f"runs that end in {kind}", values)
    bounced = runs.of(runs.table[runs.table.outcome == BOUNCING])
    yield Quantity(
        "restitution", "coefficient of restitution of runs that bounce", bounced.estimates("restitution", by)
    )
    if LARGEST_COLUMN.name in runs.table:
        yield Quantity("largest", LARGEST_COLUMN.meaning, runs.estimates(LARGEST_COLUMN.name, by))


def return_quantities(runs, by):
    """Quantities of a runs.Runs with RETURN_COLUMNS and velocity [m/s], by the columns `by`: what comes back, and when."""
    share = runs.estimates(lambda table: (table.return_speed / table.velocity) ** 2, by)
    yield Quantity(
        "returned",
        "kinetic energy in the relative motion of the halves at its largest after t_max, of K(0)",
        share,
        "%",
        0.01,
    )
    yield Quantity("return_time", "its time", runs.estimates("return_time", by), "ns", 1e-9)


def channel_quantity(runs, by, at, name, meaning):
    """Quantity of the change of every channel that changes at all, of K(0), by the columns `by` and channel; at: at_maximum, at_return or
    at_end, of PARTITION_COLUMNS."""
    changing = [channel for channel in CHANNELS if channel != "kinetic" and (runs.table[at(channel)] != 0).any()]
    changing = changing or ["normal"]  # of no runs
    values = together({channel: runs.estimates(at(channel), by) for channel in changing}, "channel")
    return Quantity(name, meaning, values, "%", 0.01)


def collision_study(title, question, varied, quantities, **values):
    """definition.Study of a question of one's own about collisions: varied: the parameters that differ from run to run, seed among them;
    quantities: a function of the table of runs, as definition.Study has it; values: parameters that every run has.

    A run's row has the parameters varied, OUTCOME_COLUMNS and LARGEST_COLUMN."""
    columns = (*(Column(name, "", "as the table of runs has it") for name in varied), *OUTCOME_COLUMNS, LARGEST_COLUMN)

    def measure(run):
        numbers = {name: float(run.parameters[name]) for name in varied}
        outcome = outcome_values(run, float(run.parameters["velocity"]))
        return {**numbers, **outcome, LARGEST_COLUMN.name: float(outcome_of_run(run).mass_fractions[0])}

    return Study(title, question, Scene(title, values, tuple(varied)), columns, measure, quantities)
