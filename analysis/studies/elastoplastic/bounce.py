"""What becomes of a collision's energy before and after the largest compression, and how it ends: restitution and
sticking probability with confidence intervals (what A24 section 5.3 asks for)."""

from dataclasses import dataclass

from ...measures.outcome import STICKING, UNDECIDED
from ...runs.format import CHANNELS
from ...statistics import mean_and_error, mean_interval, wilson
from .measure import at_end, at_maximum
from .points import parameter_sets


@dataclass(frozen=True)
class Bounce:
    """One parameter set: filling, radius [grain radii], velocity [m/s], seeds; compression and parting: by channel (mean,
    error) of its change in fractions of K(0), from the start to t_max and from there to the end; bulk (mean, error):
    fraction of K(0) left in the motion of the halves; restitution (mean, low, high; 0 for sticking) and sticking
    (fraction, low, high), of the runs that are decided, with 95 % intervals; that of sticking counts the undecided both
    ways, since they are not a fair choice; outcomes ({kind: number}). None where one seed allows no interval, or none is
    decided. Runs without a coefficient of restitution (fragmentation) don't count in its mean."""

    filling: float
    radius: float
    velocity: float
    seeds: int
    compression: dict
    parting: dict
    bulk: tuple
    restitution: tuple
    sticking: tuple
    outcomes: dict


def bounces(table):
    """Bounce of every parameter set of a table of runs (measure.COLUMNS), sorted by filling, radius, velocity."""
    return [_bounce(runs) for _, runs in parameter_sets(table)]


def _bounce(runs):
    first, total = runs.iloc[0], len(runs)
    decided = runs[runs.outcome != UNDECIDED]
    stuck = int((decided.outcome == STICKING).sum())
    return Bounce(
        filling=float(first.filling),
        radius=float(first.radius / first.grain_radius),
        velocity=float(first.velocity),
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
