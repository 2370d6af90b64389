"""Outcome of a collision of two aggregates, and the coefficient of restitution.

Counted are the grains that belong to an aggregate at the start (fragments.belongs_to_an_aggregate). The target is the
heavier aggregate, m_t and m_p are the fractions of their mass in target and projectile; with f1 >= f2 those in the
two heaviest fragments at the end, and the gain (f1 - m_t)/m_p:

    never met      no contact between the aggregates at any time
    sticking       gain >= STAYS: four fifths of the projectile or more stay on the target
    bouncing       the two part again: the target changes by no more than the rest, |gain| <= 1 - STAYS, no more than
                   that lies in other pieces, f1 + f2 >= 1 - (1 - STAYS) m_p, and of each of the two pieces at least
                   OWN is mass of one aggregate, of one each
    fragmentation  everything else: also mass transfer and erosion, and a merged body that broke in two
    undecided      at the end it is one of these, and may still become another one (decided.py)

Of equal aggregates sticking is f1 >= 0.9, and bouncing f1 + f2 >= 0.9 of pieces that are one aggregate's each.

The coefficient of restitution is 0 for sticking. For bouncing it is minus the relative velocity of the centres of mass
of the two heaviest fragments, projected on the direction of the aggregates' relative velocity at the start, over that
velocity. There is none (None) for fragmentation, for aggregates that never met, where that ratio is negative (the two
pieces have passed each other), and where the aggregates had no relative velocity."""

from dataclasses import dataclass, replace

import numpy as np

from .fragments import belongs_to_an_aggregate, fragment_labels, fragment_masses, growth_efficiency, heaviest_fragment

NEVER_MET, STICKING, BOUNCING, FRAGMENTATION = "never met", "sticking", "bouncing", "fragmentation"
UNDECIDED = "undecided"

# Of the projectile's mass, so much at least stays where it sticks.
STAYS = 0.8
# Of the mass of a piece that bounced, so much at least is of one aggregate. Aggregates that part where they had touched
# exchange what stuck to the other side: up to a tenth of a piece, as sticking leaves out up to a tenth of equal ones.
OWN = 0.9
ROUNDING = 1e-9  # four grains of five are STAYS


@dataclass(frozen=True)
class Outcome:
    """What became of two aggregates; the module's head has the rules."""

    kind: str
    restitution: float | None
    mass_fractions: tuple  # (f1, f2)
    largest_fragment: int  # grains of the heaviest piece, all counted
    growth_efficiency: float  # A22 eq 28 by mass, all grains, the target being the heavier aggregate
    fragments: int  # their number
    why_undecided: str | None = None  # in a few words
    mass_on_plate: float | None = None  # the fraction that sticks to a plate (plate.py)
    restitution_tangential: float | None = None  # along a plate that was hit at a slant

    def if_decided(self, why):
        """The same; undecided where there is a reason for it."""
        if why is None:
            return self
        return replace(self, kind=UNDECIDED, restitution=None, restitution_tangential=None, why_undecided=why)


def sticks(largest, target):
    """Whether aggregates stick whose largest piece and target have these fractions of their mass; arrays too."""
    return largest - target >= (STAYS - ROUNDING) * (1.0 - target)


def classify(f1, f2, parted=True, target=0.5):
    """Name of the outcome for the mass fractions f1 >= f2 of the two heaviest fragments, parted: whether these are
    the two aggregates again (have_parted), and that of the target. The rule at the module's head."""
    if sticks(f1, target):
        return STICKING
    rest = (1.0 - STAYS + ROUNDING) * (1.0 - target)
    if parted and abs(f1 - target) <= rest and 1.0 - f1 - f2 <= rest:
        return BOUNCING
    return FRAGMENTATION


def target_fraction(aggregate, mass):
    """m_t, of grains (N,): aggregate 0 or 1, mass in any unit, 0 of those that don't count."""
    return float(np.bincount(aggregate, mass).max() / mass.sum())


def have_parted(shares):
    """Whether two pieces are the two aggregates again: shares (2,) of aggregate 1 in the mass of either piece."""
    return 1.0 - min(shares) >= OWN and max(shares) >= OWN


def restitution(initial_velocity, final_velocity):
    """-(final . n)/|initial| with n the direction of initial; both (3,) [m/s], relative velocities of the same two
    bodies. None without an initial velocity, and where it would be negative: the bodies have passed each other."""
    initial_velocity = np.asarray(initial_velocity, dtype=float)
    square = initial_velocity @ initial_velocity
    if not square > 0:
        return None
    ratio = float(-(np.asarray(final_velocity) @ initial_velocity) / square)
    return ratio if ratio >= 0 else None


def mean_velocity(velocity, mass, members):
    """Velocity (3,) [m/s] of the centre of mass of the grains in the mask members (N,); velocity (N,3) [m/s], mass
    (N,) in any unit."""
    return np.average(velocity[members], axis=0, weights=mass[members])


def collision_outcome(mass, aggregate, start_velocity, start_pairs, end_velocity, end_pairs, met=True):
    """Outcome from grains: mass (N,) in any unit, aggregate (N,) 0 or 1, velocities (N,3) [m/s] and contact pairs (M,2)
    (rows of the grains) at the start and at the end; met: whether the aggregates touched at any time.

    ValueError if one aggregate has no grain."""
    mass, aggregate = np.asarray(mass, dtype=float), np.asarray(aggregate)
    numbers = np.bincount(aggregate, minlength=2)
    if not numbers.all():
        raise ValueError(f"an outcome needs two aggregates, aggregate {int(np.argmin(numbers))} has no grain")
    mass = mass / mass.max()  # so that equal grains add up without rounding
    counted = belongs_to_an_aggregate(aggregate, start_pairs, mass)
    labels = fragment_labels(len(mass), end_pairs)
    fractions = fragment_masses(labels, mass * counted) / mass[counted].sum()
    heaviest = np.argsort(-fractions, kind="stable")[:2]
    f1, f2 = (float(fractions[k]) for k in heaviest) if len(heaviest) == 2 else (float(fractions[0]), 0.0)
    pieces = [(labels == k) & counted for k in heaviest]
    shares = [np.average(aggregate[piece], weights=mass[piece]) if piece.any() else 0.0 for piece in pieces]
    target = target_fraction(aggregate, mass * counted)
    kind = classify(f1, f2, have_parted(shares), target) if met else NEVER_MET
    ratio = 0.0 if kind == STICKING else None
    if kind == BOUNCING:
        by_aggregate = [pieces[k] for k in np.argsort(shares)]
        ratio = restitution_of_pieces(aggregate, mass, counted, by_aggregate, start_velocity, end_velocity)
    largest = labels == heaviest_fragment(labels, mass)
    light, heavy = sorted(np.bincount(aggregate, mass))
    return Outcome(
        kind,
        ratio,
        (f1, f2),
        int(largest.sum()),
        growth_efficiency(mass[largest].sum(), heavy, light),
        int(labels.max()) + 1,
    )


def restitution_of_pieces(aggregate, mass, counted, pieces, start_velocity, end_velocity):
    """restitution() of two pieces, masks (N,) of that of aggregate 0 and that of aggregate 1, as collision_outcome()
    has the rest; counted: mask (N,) of the grains that belong to an aggregate at the start."""
    before = [mean_velocity(start_velocity, mass, counted & (aggregate == k)) for k in (0, 1)]
    after = [mean_velocity(end_velocity, mass, piece) for piece in pieces]
    return restitution(before[1] - before[0], after[1] - after[0])
