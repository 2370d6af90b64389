"""Outcome of an aggregate's collision with a plate, as laboratories have it: what sticks to the plate, and what
leaves it.

Counted are the grains that belong to the aggregate at the start (fragments.belongs_to_an_aggregate). With f_on the
fraction of their mass that is connected with the plate at the end, and f_off that of the heaviest piece that is not:

    never met      no contact with the plate at any time
    sticking       f_on >= 0.9
    bouncing       f_off >= 0.9, whatever small part it has left on the plate
    fragmentation  everything else: what sticks then is the mass transfer of laboratories, f_on

The coefficient of restitution is 0 for sticking; for bouncing minus the velocity of the centre of mass of the heaviest
piece along the plate's normal over that of the aggregate at the start; restitution_tangential likewise along the plate.

The plate stands as one more grain among the others, of aggregate 1: a sphere so large that it is flat where the
grains are. Pieces that may still meet it, and cuts between it and what lies on it, are then found as those of two
aggregates (decided.py); motion along the plate counts as turning with it, which breaks nothing."""

from itertools import chain

import numpy as np

from .decided import EVER, Pieces
from .fragments import (
    belongs_to_an_aggregate,
    fragment_labels,
    fragment_masses,
    fragment_sizes,
    grain_masses,
    heaviest_fragment,
)
from .motion import means_of_pieces, pieces_that_can_meet
from .outcome import BOUNCING, FRAGMENTATION, NEVER_MET, ROUNDING, STICKING, Outcome, mean_velocity, restitution

# Radius of the sphere that stands for the plate, over the largest distance of a grain from the point of the plate
# below the grains.
SLANTING = 1e-6  # of the velocity: motion along a plate that is more than rounding
FLAT = 1e3
MOST = 0.9  # of the mass, on the plate or in the piece that has bounced


def has_plate(state):
    """Whether a state (a mapping with the names of runs.format.STATE) has a plate."""
    return state.get("plane_contacts") is not None


def with_plate(state):
    """The state (a mapping) with its plate, if it has one, as the last grain, in contact with the grains on it."""
    if not has_plate(state):
        return state
    axis, on_axis = int(state["plane_axis"][0]), float(state["plane_position"][0])
    foot = state["position"].mean(axis=0)
    side = 1.0 if foot[axis] >= on_axis else -1.0
    foot[axis] = on_axis
    size = FLAT * (np.linalg.norm(state["position"] - foot, axis=1) + state["radius"]).max()
    centre = foot.copy()
    centre[axis] -= side * size
    grains, on_plate = len(state["radius"]), state["plane_contacts"][:, 0]
    to_plate = np.stack([on_plate, np.full(len(on_plate), grains)], axis=1)
    at_rest = np.zeros((1, 3))
    of_materials = {}
    if state.get("mass") is not None:  # the plate is of the first material
        heavy = (size / state["radius"].max()) ** 3 * state["mass"].max()
        of_materials = {"mass": np.append(state["mass"], heavy), "material": np.append(state["material"], 0)}
    return {
        **state,
        **of_materials,
        "position": np.concatenate([state["position"], centre[None]]),
        "velocity": np.concatenate([state["velocity"], at_rest]),
        "radius": np.append(state["radius"], size),
        "aggregate": np.append(state["aggregate"], 1),
        "contact_pairs": np.concatenate([state["contact_pairs"], to_plate]),
        "contact_bonded": np.append(state["contact_bonded"], np.zeros(len(on_plate), dtype=bool)),
    }


def classify_on_plate(on, off):
    """Name of the outcome for the mass fractions on the plate and in the heaviest piece off it: the rule at the
    module's head."""
    least = MOST - ROUNDING
    return STICKING if on >= least else BOUNCING if off >= least else FRAGMENTATION


def _counted(start):
    """Mask (N + 1,) of the grains that count; the plate does not."""
    one = np.zeros(len(start["radius"]), dtype=int)
    return np.append(belongs_to_an_aggregate(one, start["contact_pairs"], grain_masses(start)), False)


def plate_outcome(start, end, met):
    """outcome.Outcome from the states (mappings) at the start and at the end; met: whether the aggregate touched
    the plate at any time. mass_fractions, fragments and largest_fragment: what lies on the
    plate is one piece; growth_efficiency: the plate's, the fraction of the mass of all grains that lies on it;
    mass_on_plate: f_on."""
    counted, state = _counted(start), with_plate(end)
    labels = fragment_labels(len(counted), state["contact_pairs"])
    mass = grain_masses(state)
    mass = mass / mass[:-1].max()  # so that equal grains add up without rounding
    fractions = fragment_masses(labels, mass * counted) / mass[counted].sum()
    sizes = fragment_sizes(labels)
    sizes[labels[-1]] -= 1
    of_grains = np.append(mass[:-1], 0.0)
    on = float(fractions[labels[-1]])
    off = np.where(np.arange(len(fractions)) == labels[-1], 0.0, fractions)
    heaviest = int(np.argmax(off))
    kind = classify_on_plate(on, off[heaviest]) if met else NEVER_MET
    ratio, tangential = 0.0 if kind == STICKING else None, None
    if kind == BOUNCING:
        piece, own = (labels == heaviest) & counted, counted[:-1]
        before, after = mean_velocity(start["velocity"], mass[:-1], own), mean_velocity(state["velocity"], mass, piece)
        across = np.arange(3) == int(start["plane_axis"][0])
        ratio = restitution(before * across, after * across)
        along = before * ~across
        if np.linalg.norm(along) > SLANTING * np.linalg.norm(before):
            tangential = float(after @ along / (along @ along))
    f1, f2 = sorted([*map(float, fractions), 0.0], reverse=True)[:2]
    return Outcome(
        kind,
        ratio,
        (f1, f2),
        int(sizes[heaviest_fragment(labels, of_grains)]),
        float(of_grains[labels == labels[-1]].sum() / of_grains.sum()),
        int((sizes > 0).sum()),
        mass_on_plate=on,
        restitution_tangential=tangential,
    )


def why_undecided_on_plate(kind, start, end, constants, touch, recent=()):
    """As decided.why_undecided, of a plate: states are mappings with the names of runs.format.STATE."""
    counted, pieces = _counted(start), Pieces(with_plate(end), constants)
    shares, plate = pieces.shares(counted), pieces.labels[-1]
    near = _that_can_meet_it(plate, *pieces.flight)
    if kind == NEVER_MET:
        return "the aggregate may still meet the plate" if near.any() else None
    if kind == STICKING and (why := pieces.why_rebounding(end["time"] - touch)):
        return why
    others = np.arange(len(shares)) != plate
    left = shares[others & ~near].max(initial=0.0)
    if classify_on_plate(shares[plate] + shares[near].sum(), left) != kind:
        return f"pieces of {shares[near].sum():.0%} of the mass may still meet the plate"
    of_all = (_why_breaking(kind, Pieces(with_plate(state), constants), counted) for state in chain([end], recent))
    return next(filter(None, of_all), None)


def _that_can_meet_it(plate, position, velocity, radius, mass, labels):
    """Which pieces (K,) may touch the piece of the plate: those whose spheres do, unless they leave faster than any
    of their grains moves in the piece, so that none comes back however it turns."""
    centre, motion = means_of_pieces(position, labels, mass), means_of_pieces(velocity, labels, mass)
    within = np.zeros(len(centre))
    np.maximum.at(within, labels, np.linalg.norm(velocity - motion[labels], axis=1))
    away = centre - centre[plate]
    with np.errstate(invalid="ignore"):
        leaving = np.einsum("ij,ij->i", motion, away) / np.linalg.norm(away, axis=1)
    return pieces_that_can_meet(plate, position, velocity, radius, mass, labels, EVER) & ~(leaving > within)


def _why_breaking(kind, pieces, counted):
    """Of what lies on the plate, or of the heaviest piece off it."""
    shares, plate = pieces.shares(counted), pieces.labels[-1]
    on, off = shares[plate], np.where(np.arange(len(shares)) == plate, 0.0, shares)
    outcomes = {
        int(np.argmax(off)): lambda lost: classify_on_plate(on, off.max() - lost),
        int(plate): lambda lost: classify_on_plate(on - lost, max(off.max(), lost)),  # last: it may be the only piece
    }
    return pieces.why_breaking(kind, counted, outcomes)
