"""Outcome of a collision of two aggregates: sticking, bouncing or fragmentation, and the coefficient of
restitution.

Counted are the grains that belong to an aggregate at the start (fragments.belongs_to_an_aggregate).
With f1 >= f2 the shares of their mass in the two heaviest fragments at the end:

    sticking       f1 >= 0.9
    bouncing       f1 + f2 >= 0.9 and f2 >= 0.25
    fragmentation  everything else

The coefficient of restitution is 0 for sticking; otherwise minus the relative velocity of the centres of
mass of the two heaviest fragments, projected on the direction of the aggregates' relative velocity at the
start, over that velocity.
"""

from dataclasses import dataclass

import numpy as np

from .fragments import (
    belongs_to_an_aggregate,
    fragment_labels,
    fragment_masses,
    fragment_sizes,
    growth_efficiency,
)

STICKING, BOUNCING, FRAGMENTATION = "sticking", "bouncing", "fragmentation"


@dataclass(frozen=True)
class Outcome:
    """kind (sticking, bouncing, fragmentation), restitution (None where the aggregates had no relative
    velocity), mass_fractions (f1, f2), largest_fragment [grains, all counted], growth_efficiency (A22 eq 28,
    all grains, the target being the aggregate with more grains), fragments (their number) and excluded_grains
    (not counted in the fractions)."""

    kind: str
    restitution: float
    mass_fractions: tuple
    largest_fragment: int
    growth_efficiency: float
    fragments: int
    excluded_grains: int


def classify(f1, f2):
    """Name of the outcome for the mass fractions f1 >= f2 of the two heaviest fragments: the rule at the
    module's head."""
    if f1 >= 0.9:
        return STICKING
    if f1 + f2 >= 0.9 and f2 >= 0.25:
        return BOUNCING
    return FRAGMENTATION


def restitution(initial_velocity, final_velocity):
    """-(final . n)/|initial| with n the direction of initial; both (3,) [m/s], relative velocities of the
    same two bodies. None where there is no initial velocity."""
    initial_velocity = np.asarray(initial_velocity, dtype=float)
    square = initial_velocity @ initial_velocity
    return float(-(np.asarray(final_velocity) @ initial_velocity) / square) if square > 0 else None


def mean_velocity(velocity, mass, members):
    """Velocity (3,) [m/s] of the centre of mass of the grains in the mask members (N,); velocity (N,3), mass
    (N,)."""
    return np.average(velocity[members], axis=0, weights=mass[members])


def collision_outcome(start, end):
    """Outcome from the states at the start and at the end (run_folder.State). All grains have one density.

    ValueError if the states don't hold the same grains, or one aggregate has none.
    """
    if start.aggregate.shape != end.aggregate.shape or np.any(start.aggregate != end.aggregate):
        raise ValueError("the first and the last state don't hold the same grains")
    numbers = np.bincount(start.aggregate, minlength=2)
    if not numbers.all():
        raise ValueError(f"an outcome needs two aggregates, aggregate {int(np.argmin(numbers))} has no grain")
    # In units of the largest grain, so that equal grains add up without rounding.
    mass = (start.radius / start.radius.max()) ** 3
    counted = belongs_to_an_aggregate(start.aggregate, start.contact_pairs, mass)
    labels = fragment_labels(len(mass), end.contact_pairs)
    fractions = fragment_masses(labels, mass * counted) / mass[counted].sum()
    heaviest = np.argsort(-fractions, kind="stable")[:2]
    f1, f2 = (float(fractions[k]) for k in heaviest) if len(heaviest) == 2 else (float(fractions[0]), 0.0)
    kind = classify(f1, f2)
    largest = int(fragment_sizes(labels).max())
    return Outcome(
        kind,
        0.0 if kind == STICKING else _restitution(start, end, mass, counted, labels, heaviest),
        (f1, f2),
        largest,
        growth_efficiency(largest, int(numbers.max()), int(numbers.min())),
        int(labels.max()) + 1,
        int((~counted).sum()),
    )


def _restitution(start, end, mass, counted, labels, heaviest):
    first, second = ((labels == k) & counted for k in heaviest)
    # The fragment richer in aggregate 1 stands for aggregate 1: otherwise the sign would depend on which is
    # heavier.
    if np.average(start.aggregate[first], weights=mass[first]) > np.average(
        start.aggregate[second], weights=mass[second]
    ):
        first, second = second, first
    before = [mean_velocity(start.velocity, mass, counted & (start.aggregate == k)) for k in (0, 1)]
    after = [mean_velocity(end.velocity, mass, members) for members in (first, second)]
    return restitution(before[1] - before[0], after[1] - after[0])
