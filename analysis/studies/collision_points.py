"""What studies of collisions have in common: columns of a run's energy partition, return phase and outcome, and their
statistics over the seeds of one parameter set."""

from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from ..measures.compression import first_compression
from ..measures.ledger import fractions_at, initial_kinetic_energy
from ..measures.of_run import met, outcome_of_run
from ..measures.outcome import STICKING, UNDECIDED, still_parting
from ..measures.return_phase import largest_return_speed
from ..runs.arrays import RunFolderError
from ..runs.format import CHANNELS, HISTORY_FILE, LABELS
from ..runs.table import Column
from ..statistics import mean_and_error, student_interval, wilson
from .definition import NotMeasured

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
    Column("outcome", "", f"as measures.outcome has it, or {UNDECIDED}: in one piece, but still parting", kind="O"),
    Column("restitution", "", "none for fragmentation and for pieces that passed each other", gaps=True),
    Column("bulk", "", "(v/v_col)^2 at the end: the fraction of K(0) in the motion of the halves"),
)
RETURN_COLUMNS = (
    Column("return_speed", "m/s", "largest speed at which the halves part after t_max", gaps=True, absent=np.nan),
    Column("return_time", "s", "its time", gaps=True, absent=np.nan),
)


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
        "outcome": UNDECIDED if outcome.kind == STICKING and still_parting(v) else outcome.kind,
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


@dataclass(frozen=True)
class Phases:
    """Change of the channels in the runs of one parameter set and outcome: outcome, seeds (their number);
    compression (start to t_max), parting (t_max to the end), and where the largest return speed was measured (seeds in
    `timed`) parting's two parts, release (t_max to it) and stretching (from it to the end): by channel (mean, error) in
    fractions of K(0); bulk and returned (mean, error): (v/v_col)^2 at the end and at the largest return speed; when (mean,
    error): its time [s]. Nones where no run was timed."""

    outcome: str
    seeds: int
    timed: int
    compression: dict
    parting: dict
    release: dict
    stretching: dict
    bulk: tuple
    returned: tuple
    when: tuple


@dataclass(frozen=True)
class CollisionPoint:
    """Runs of one parameter set: parameters ({name: value}), seeds (their number), outcomes ({kind: number}), phases
    (Phases of each outcome); returned and bulk (mean, error) of all runs.

    restitution, sticking: (low, high, lowest, highest): the mean with every undecided run counted as sticking or as
    bouncing (sticking: the other way round), and the outer ends of their 95 % intervals, Student's for the restitution
    and Wilson's for the sticking probability. A run that is undecided, if it bounces, does so with no more than the
    speed at which its halves part at the end, which tension still slows. Runs without a coefficient of restitution
    (fragmentation) don't count in its mean. None where it can't be told: no such run, or, for the interval of the
    restitution, no scatter."""

    parameters: dict
    seeds: int
    outcomes: dict
    phases: tuple
    bulk: tuple
    returned: tuple
    restitution: tuple
    sticking: tuple

    def __getattr__(self, name):
        # The parameters as attributes.
        if name != "parameters" and name in self.parameters:
            return self.parameters[name]
        raise AttributeError(name)

    @property
    def undecided(self):
        """Fraction of the runs that are undecided."""
        return self.outcomes.get(UNDECIDED, 0) / self.seeds


def collision_point(parameters, runs):
    """CollisionPoint of the runs of one parameter set: a table (DataFrame) with PARTITION_COLUMNS, OUTCOME_COLUMNS,
    RETURN_COLUMNS and `velocity` [m/s]."""
    outcomes = {kind: int(number) for kind, number in runs.outcome.value_counts().sort_index().items()}
    return CollisionPoint(
        parameters=parameters,
        seeds=len(runs),
        outcomes=outcomes,
        phases=tuple(_phases(kind, runs[runs.outcome == kind]) for kind in outcomes),
        bulk=mean_and_error(runs.bulk),
        returned=_returned(runs),
        restitution=_restitution(runs),
        sticking=_sticking(outcomes.get(STICKING, 0), outcomes.get(UNDECIDED, 0), len(runs)),
    )


def _phases(kind, runs):
    timed = runs[runs.return_time.notna()]
    end = {c: runs[at_end(c)] - runs[at_maximum(c)] for c in CHANNELS}
    return Phases(
        outcome=kind,
        seeds=len(runs),
        timed=len(timed),
        compression={c: mean_and_error(runs[at_maximum(c)] - (c == "kinetic")) for c in CHANNELS},
        parting={c: mean_and_error(change) for c, change in end.items()},
        release=_changes(timed, at_maximum, at_return),
        stretching=_changes(timed, at_return, at_end),
        bulk=mean_and_error(runs.bulk),
        returned=_returned(runs),
        when=mean_and_error(timed.return_time) if len(timed) else None,
    )


def _changes(runs, since, until):
    return {c: mean_and_error(runs[until(c)] - runs[since(c)]) for c in CHANNELS} if len(runs) else None


def _returned(runs):
    timed = runs[runs.return_speed.notna()]
    return mean_and_error((timed.return_speed / timed.velocity) ** 2) if len(timed) else None


def _restitution(runs):
    undecided = runs.outcome == UNDECIDED
    least = runs.restitution.where(~undecided, 0.0)
    most = runs.restitution.where(~undecided, np.sqrt(runs.bulk))
    known = least.notna()
    if not known.any():
        return None, None, None, None
    ends = [student_interval(values[known]) for values in (least, most)]
    lowest, highest = ends[0][0], ends[1][1]
    return (
        float(least[known].mean()),
        float(most[known].mean()),
        None if lowest is None else max(lowest, 0.0),
        None if highest is None else min(highest, 1.0),
    )


def _sticking(stuck, undecided, total):
    return (
        stuck / total,
        (stuck + undecided) / total,
        wilson(stuck, total)[0],
        wilson(stuck + undecided, total)[1],
    )
