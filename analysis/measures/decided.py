"""Whether the outcome of a collision is decided: whether neither pieces that may still meet nor contacts that may
still break could make it another one.

Pieces may meet when the spheres around them do, on straight lines. A piece may break where its two sides move against
each other with more energy than the contacts between them hold (loose_cuts), and as long as it has not had the time
to rebound as a whole.

Of 104 collisions followed ten times as long as by default none became another outcome after it was decided.
"""

from functools import cached_property, partial
from itertools import chain

import numpy as np

from .fragments import fragment_labels, fragment_masses
from .motion import inner_kinetic_energy, motion_in_pieces, pieces_can_meet, pieces_that_can_meet
from .network import contact_network, depths, spanning_forest
from .outcome import BOUNCING, NEVER_MET, STICKING, classify, target_fraction

BREAKING = 4 / 45 + 0.8 * 6 ** (1 / 3)  # E_break over F_c delta_c (A22 eq 12)
# A24 follows aggregates of 80 grain radii for 1000 ns, in which they are compressed and part: 12.5 ns a grain radius,
# in units of ice's t0.
REBOUND_PER_RADIUS = 64.6
QUIET = 0.02  # of E_break: kinetic energy a grain, of the motion within a piece, that breaks no contact
EVER = np.inf
RECENT = 1 / 4  # of the time since the first touch
CONSTANTS = ("density", "grainRadius", "aggregateRadius", "timeUnit", "pullOffForce", "pullOffOverlap")  # of run.json


def rebound_time(radius, time_unit):
    """Time [s] from the first touch in which two aggregates of this radius [grain radii] are compressed and part
    again (A24 section 3); time_unit: t0 [s]."""
    return REBOUND_PER_RADIUS * radius * time_unit


def contact_strength(state, constants):
    """Energy [J] (M,) that breaks each contact from rest; arguments as why_undecided.

    Of JKR contacts E_break, which grows as the reduced radius to the power 4/3 and depends on the two materials, of
    sintered bonds what breaks them by stretching (S17 eq 6).
    """
    first, second = state["radius"][state["contact_pairs"]].T
    reduced = 2 * first * second / (first + second) / constants["grainRadius"]
    # grains that sintered are smaller spheres
    reduced *= constants.get("shrunkRadius", constants["grainRadius"]) / constants["grainRadius"]
    of_pair = constants["pullOffForce"] * constants["pullOffOverlap"]
    if state.get("material") is not None:
        of_pair = np.asarray(constants["pullOffEnergies"])[tuple(state["material"][state["contact_pairs"]].T)]
    found = BREAKING * of_pair * reduced ** (4 / 3)
    return np.where(state["contact_bonded"], constants.get("breakingEnergy", 0.0), found)


def is_recent(time, end, touch):
    """Whether a time [s] lies in the last quarter between the first touch and the end, within which the energy of an
    oscillating piece shows at some state."""
    return time >= end - RECENT * max(0.0, end - touch)


def why_undecided(kind, counted, end, constants, touch, recent=()):
    """Why an outcome may still become another one, in a few words; None if it is decided.

    kind: of outcome.collision_outcome at the state `end`, counted (N,) bool as there. end, and those states before it
    that are recent: mappings with time, position, velocity (N,3), radius, aggregate (N,), contact_pairs (M,2),
    contact_bonded (M,), SI. constants: a mapping with the derived CONSTANTS of run.json. touch: time [s] of the first
    touch.
    """
    pieces = Pieces(end, constants)
    if kind == NEVER_MET:
        return "the aggregates may still meet" if pieces_can_meet(*pieces.flight, EVER) else None
    why = pieces.why_rebounding(end["time"] - touch) if kind == STICKING else _why_meeting(kind, pieces, counted)
    if why or kind not in (STICKING, BOUNCING):
        return why
    of_all = (_why_breaking(kind, Pieces(state, constants), counted) for state in chain([end], recent))
    return next(filter(None, of_all), None)


def has_come_to_rest(state, constants, touch, duration):
    """Whether no fragment of a state seems to change any more until the time `duration` [s]; arguments as
    why_undecided.

    No two pieces can meet, none is in motion within that breaks contacts (QUIET), no cut is loose, and the aggregates
    have had the time to rebound. To be sure of it, it must have been so at all recent times.
    """
    pieces = Pieces(state, constants)
    return not (
        pieces.why_rebounding(state["time"] - touch)
        or pieces.are_moving_within()
        or pieces.loose_cuts()[0].size
        or pieces_can_meet(*pieces.flight, duration - state["time"])
    )


class Pieces:
    """Of a state: labels (N,), mass (N,) [kg], and what may become of them."""

    def __init__(self, state, constants):
        self.state, self.constants = state, constants
        several = state.get("mass") is not None
        self.mass = state["mass"] if several else 4 / 3 * np.pi * constants["density"] * state["radius"] ** 3
        self._motion = state["position"], state["velocity"], self.mass

    @cached_property  # not needed as long as the aggregates may rebound
    def labels(self):
        return fragment_labels(len(self.mass), self.state["contact_pairs"])

    @property
    def flight(self):
        """Arguments of motion.pieces_can_meet."""
        return self.state["position"], self.state["velocity"], self.state["radius"], self.mass, self.labels

    def why_rebounding(self, since_touch):
        radius = self.constants["aggregateRadius"] / self.constants["grainRadius"]
        needed = rebound_time(radius, self.constants["timeUnit"])
        if since_touch < needed * (1 - 1e-3):
            return f"{since_touch:.3g} s after the first touch the aggregates may still rebound, until {needed:.3g} s"

    def are_moving_within(self):
        weakest = self.constants.get(
            "pullOffEnergies", self.constants["pullOffForce"] * self.constants["pullOffOverlap"]
        )
        breaking = BREAKING * np.min(weakest)
        inner = inner_kinetic_energy(*self._motion, self.labels)
        return bool(np.any(inner > QUIET * breaking * np.bincount(self.labels)))

    def loose_cuts(self):
        pairs, strength = self.state["contact_pairs"], contact_strength(self.state, self.constants)
        return loose_cuts(*self._motion, pairs, self.labels, self.state["aggregate"], strength)

    def why_breaking(self, kind, counted, outcomes):
        """Of an outcome that is another one without a loose side of one of some pieces; None if it is none yet.

        outcomes: {number of a piece: function from the fraction of the counted mass that it loses to the outcome}."""
        cut, side = self.loose_cuts()
        for piece, outcome in outcomes.items():
            lost = side[cut == piece].max(initial=0.0) / self.mass[counted].sum()
            if outcome(0.0) == kind != outcome(lost):
                return f"parts of {lost:.0%} of the mass still move with more energy than the contacts to them hold"

    def shares(self, counted):
        """Shares (K,) of the counted mass."""
        return fragment_masses(self.labels, self.mass * counted) / self.mass[counted].sum()

    def target(self, counted):
        """Fraction of the counted mass in the target."""
        return target_fraction(self.state["aggregate"], self.mass * counted)


def _why_breaking(kind, pieces, counted):
    """Of the largest piece, or of both that have bounced."""
    shares, target = pieces.shares(counted), pieces.target(counted)
    largest = np.argsort(-shares, kind="stable")[: 2 if kind == BOUNCING else 1]

    def outcome(piece, lost):
        masses = sorted(shares[largest] - lost * (largest == piece), reverse=True)
        return classify(*(masses + [0.0])[:2], target=target)

    return pieces.why_breaking(kind, counted, {piece: partial(outcome, piece) for piece in largest})


def _why_meeting(kind, pieces, counted):
    """Of an outcome that is another one with the pieces that may still meet the largest or the second."""
    shares = pieces.shares(counted)
    largest, second = (*np.argsort(-shares, kind="stable")[:2], None)[:2]
    near, other = pieces_that_can_meet(largest, *pieces.flight, EVER), 0.0
    whole = shares[largest] + shares[near].sum()
    if second is not None and not near[second]:
        other = shares[second] + shares[pieces_that_can_meet(second, *pieces.flight, EVER) & ~near].sum()
    now, target = (shares[largest], 0.0 if second is None else shares[second]), pieces.target(counted)
    # otherwise pieces of such masses, but not those of the two aggregates
    have_parted = classify(*now, target=target) == kind
    if classify(*sorted((whole, other), reverse=True), have_parted, target) != kind:
        return f"pieces of {whole - shares[largest]:.0%} of the mass may still meet the largest"


def loose_cuts(position, velocity, mass, pairs, labels, aggregate, strength):
    """(pieces (K,), masses (K,) of the smaller sides) of the cuts whose sides move against each other with more
    kinetic energy than the contacts of the cut hold, the motion of the piece as a rigid body left out.

    Cuts go through every contact that alone connects two parts of a piece, and between a piece's grains of either
    aggregate. position, velocity (N,3) [m, m/s], mass (N,) [kg], pairs (M,2) with strength (M,) [J], the energy that
    breaks each contact; labels (N,) as fragments.fragment_labels has them, aggregate (N,) 0 or 1. Beside a plate, the
    last grain (plate.py), the others' masses are lost in rounding: sides are summed without it.
    """
    momentum = mass[:, None] * motion_in_pieces(position, velocity, mass, labels)
    whole = np.bincount(labels, weights=mass)
    piece, side, pushed, held = (
        np.concatenate(parts)
        for parts in zip(
            _between_aggregates(mass, momentum, pairs, labels, aggregate, strength),
            _through_one_contact(mass, momentum, pairs, labels, strength),
        )
    )
    rest = whole[piece] - side
    with np.errstate(divide="ignore", invalid="ignore"):
        energy = 0.5 * np.einsum("ij,ij->i", pushed, pushed) * (1 / side + 1 / rest)
    loose = (side > 0) & (rest > 0) & (energy > held)
    return piece[loose], np.minimum(side, rest)[loose]


def _between_aggregates(mass, momentum, pairs, labels, aggregate, strength):
    """(piece, mass, momentum (K,3), energy that holds) of the side of aggregate 0 in every piece."""
    number, first = labels.max() + 1, aggregate == 0
    across = aggregate[pairs[:, 0]] != aggregate[pairs[:, 1]]
    held = np.bincount(labels[pairs[across, 0]], weights=strength[across], minlength=number)
    pushed = [np.bincount(labels[first], weights=p, minlength=number) for p in momentum[first].T]
    return (
        np.arange(number),
        np.bincount(labels[first], weights=mass[first], minlength=number),
        np.stack(pushed, 1),
        held,
    )


def _through_one_contact(mass, momentum, pairs, labels, strength):
    """The same of the part of a piece that one contact connects with the rest.

    Such contacts are found on a spanning tree: each of the other contacts closes a loop, and marks both of its ends
    with a random number. Where the marks beyond a contact of the tree cancel out (exclusive or), no loop leads around
    it.
    """
    order, parent = spanning_forest(contact_network(len(mass), pairs))
    contact = np.full(len(mass), -1)  # of the tree, with the parent
    marks = np.random.default_rng(0).integers(1, 2**63, len(pairs), dtype=np.uint64)
    for one, other in (pairs.T, pairs.T[::-1]):
        in_tree = parent[one] == other
        contact[one[in_tree]] = np.flatnonzero(in_tree)
        marks[in_tree] = 0
    mark, beyond = np.zeros(len(mass), dtype=np.uint64), np.column_stack([mass, momentum])
    for end in pairs.T:
        np.bitwise_xor.at(mark, end, marks)
    farther = np.flatnonzero(np.diff(depths(order, parent)[order])) + 1
    for level in np.split(order, farther)[:0:-1]:  # without the roots
        np.add.at(beyond, parent[level], beyond[level])
        np.bitwise_xor.at(mark, parent[level], mark[level])
    single = np.flatnonzero((contact >= 0) & (mark == 0))
    return labels[single], beyond[single, 0], beyond[single, 1:], strength[contact[single]]
