"""What studies of collisions have in common: columns of a run's energy partition and outcome, and their statistics over
the seeds of one parameter set."""

from dataclasses import dataclass

import numpy as np

from ..measures.ledger import fractions_at
from ..measures.of_run import outcome_of_run
from ..measures.outcome import STICKING, UNDECIDED, still_parting
from ..runs.format import CHANNELS, LABELS
from ..runs.table import Column
from ..statistics import mean_and_error, mean_interval, wilson


def at_maximum(channel):
    """Name of the column of a channel's change from the start to t_max."""
    return f"{channel}_at_maximum"


def at_end(channel):
    """Name of the column of a channel's change from the start to the end."""
    return f"{channel}_at_end"


PARTITION_COLUMNS = tuple(
    Column(name(c), "K(0)", f"{LABELS[c]}, change from the start to {when} (kinetic: what is left)", absent=0.0)
    for name, when in ((at_maximum, "t_max"), (at_end, "the end"))
    for c in CHANNELS
)
OUTCOME_COLUMNS = (
    Column("outcome", "", f"as measures.outcome has it, or {UNDECIDED}: in one piece, but still parting", kind="O"),
    Column("restitution", "", "none for fragmentation and for pieces that passed each other", gaps=True),
    Column("bulk", "", "(v/v_col)^2 at the end: the fraction of K(0) in the motion of the halves"),
)


def outcome_values(run, velocity):
    """{column: value} of OUTCOME_COLUMNS of a RunFolder, at the collision velocity [m/s]. RunFolderError where the states
    don't make an outcome."""
    outcome, v = outcome_of_run(run), run.history["v"]
    return {
        "outcome": UNDECIDED if outcome.kind == STICKING and still_parting(v) else outcome.kind,
        "restitution": outcome.restitution,
        "bulk": float(np.nan_to_num(v[-1] / velocity) ** 2),
    }


def energy_partition(history, time):
    """{column: value} of PARTITION_COLUMNS, from a history (measures.ledger) and the time [s] of the largest
    compression; K(0) must not be 0."""
    middle, end = fractions_at(history, time), fractions_at(history, history["time"][-1])
    return {**{at_maximum(c): middle[c] for c in CHANNELS}, **{at_end(c): end[c] for c in CHANNELS}}


@dataclass(frozen=True)
class CollisionPoint:
    """Runs of one parameter set: parameters ({name: value}), seeds (their number); compression and parting: by channel
    (mean, error) of its change in fractions of K(0), from the start to t_max and from there to the end; bulk (mean,
    error): fraction of K(0) left in the motion of the halves; restitution (mean, low, high; 0 for sticking) and
    sticking (fraction, low, high), of the runs that are decided, with 95 % intervals; that of sticking counts the
    undecided both ways, since they are not a fair choice; outcomes ({kind: number}). None where one seed allows no
    interval, or none is decided. Runs without a coefficient of restitution (fragmentation) don't count in its mean."""

    parameters: dict
    seeds: int
    compression: dict
    parting: dict
    bulk: tuple
    restitution: tuple
    sticking: tuple
    outcomes: dict

    def __getattr__(self, name):
        # The parameters as attributes.
        if name != "parameters" and name in self.parameters:
            return self.parameters[name]
        raise AttributeError(name)


def collision_point(parameters, runs):
    """CollisionPoint of the runs of one parameter set: a table (DataFrame) with PARTITION_COLUMNS and
    OUTCOME_COLUMNS."""
    total, decided = len(runs), runs[runs.outcome != UNDECIDED]
    stuck = int((decided.outcome == STICKING).sum())
    return CollisionPoint(
        parameters=parameters,
        seeds=total,
        compression={c: mean_and_error(runs[at_maximum(c)] - (c == "kinetic")) for c in CHANNELS},
        parting={c: mean_and_error(runs[at_end(c)] - runs[at_maximum(c)]) for c in CHANNELS},
        bulk=mean_and_error(runs.bulk),
        restitution=mean_interval(decided.restitution.dropna(), lowest=0.0),
        sticking=(
            stuck / len(decided) if len(decided) else None,
            wilson(stuck, total)[0],
            wilson(stuck + total - len(decided), total)[1],
        ),
        outcomes={kind: int(number) for kind, number in runs.outcome.value_counts().sort_index().items()},
    )
