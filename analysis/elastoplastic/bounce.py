"""What becomes of a collision's energy before and after the largest compression, and how it ends: restitution
and sticking probability with confidence intervals (what A24 section 5.3 asks for)."""

from dataclasses import dataclass

import numpy as np

from ..channels import CHANNELS
from ..collision_outcome import STICKING
from .measure import UNDECIDED

CONFIDENCE = 0.95
_Z = 1.959963984540054  # of a normal distribution, two-sided
_RESAMPLES, _RANDOM_SEED = 2000, 20240513


@dataclass(frozen=True)
class Bounce:
    """One parameter set: filling, radius [grain radii], velocity [m/s], seeds; compression and parting: by
    channel (mean, error) of its change in shares of K(0), from the start to t_max and from there to the end;
    bulk (mean, error): share of K(0) left in the motion of the halves; restitution (mean, low, high; 0 for
    sticking) and sticking (share, low, high), of the runs that are decided, with 95 % intervals; that of sticking
    counts the undecided both ways, since they are not a fair choice. None where one seed allows no interval, or
    none is decided."""

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


def bounces(rows):
    """Bounce of every parameter set of the rows (measure.Row), sorted by filling, radius, velocity."""
    sets = {}
    for row in rows:
        key = (round(row.filling, 6), round(row.radius / row.grain_radius, 3), round(row.velocity, 6))
        sets.setdefault(key, []).append(row)
    return [_bounce(sets[key]) for key in sorted(sets)]


def _bounce(rows):
    first = rows[0]
    compression = {c: _mean([r.shares_at_maximum[c] - (c == "kinetic") for r in rows]) for c in CHANNELS}
    parting = {c: _mean([r.shares_at_end[c] - r.shares_at_maximum[c] for r in rows]) for c in CHANNELS}
    decided = [row for row in rows if row.outcome != UNDECIDED]
    stuck = sum(row.outcome == STICKING for row in decided)
    kinds = [row.outcome for row in rows]
    return Bounce(
        filling=first.filling,
        radius=first.radius / first.grain_radius,
        velocity=first.velocity,
        seeds=len(rows),
        compression=compression,
        parting=parting,
        bulk=_mean([row.bulk for row in rows]),
        restitution=restitution_interval([row.restitution for row in decided]),
        sticking=(
            stuck / len(decided) if decided else None,
            wilson(stuck, len(rows))[0],
            wilson(stuck + len(rows) - len(decided), len(rows))[1],
        ),
        outcomes={kind: kinds.count(kind) for kind in sorted(set(kinds))},
    )


def _mean(values):
    values = np.asarray(values, dtype=float)
    return float(values.mean()), float(values.std(ddof=1) / np.sqrt(len(values))) if len(values) > 1 else None


def wilson(successes, trials, z=_Z):
    """(low, high): Wilson's score interval of a probability, 95 % unless z says otherwise."""
    share, square = successes / trials, z * z / trials
    centre = (share + 0.5 * square) / (1.0 + square)
    half = z * np.sqrt(share * (1.0 - share) / trials + 0.25 * square / trials) / (1.0 + square)
    # Without rounding at the ends, where the formula gives 0 and 1.
    low, high = float(centre - half), float(centre + half)
    return (0.0 if successes == 0 else low), (1.0 if successes == trials else high)


def restitution_interval(values):
    """(mean, low, high) of the coefficient of restitution: percentile bootstrap over the seeds, the
    deviations stretched by [n/(n-1)]^(1/2) for few seeds, not below 0; (mean, None, None) for one seed, None
    for none."""
    values = np.asarray(values, dtype=float)
    n = len(values)
    if n < 2:
        return (float(values[0]) if n else None), None, None
    mean = values.mean()
    draws = np.random.default_rng(_RANDOM_SEED).integers(0, n, size=(_RESAMPLES, n))
    means = mean + (values[draws].mean(axis=1) - mean) * np.sqrt(n / (n - 1.0))
    low, high = np.percentile(means, [50.0 * (1.0 - CONFIDENCE), 50.0 * (1.0 + CONFIDENCE)])
    return float(mean), max(0.0, float(low)), float(high)
