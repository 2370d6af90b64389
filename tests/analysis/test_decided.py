"""When the outcome of a collision, with an aggregate or a plate, is decided: chains of grains in units of a grain's
radius, its mass and the energy that breaks a contact."""

import numpy as np
import pytest

from analysis.measures import decided
from analysis.measures.decided import contact_strength, loose_cuts
from analysis.measures.fragments import fragment_labels
from analysis.measures.motion import inner_kinetic_energy, motion_in_pieces, pieces_can_meet, pieces_that_can_meet
from analysis.measures.plate import plate_outcome, why_undecided_on_plate

CONSTANTS = {
    **dict.fromkeys(("grainRadius", "aggregateRadius", "pullOffOverlap", "timeUnit"), 1.0),
    "density": 3 / (4 * np.pi),
    "pullOffForce": 1 / decided.BREAKING,
    "breakingEnergy": 9.0,
}
LONG = 2 * decided.REBOUND_PER_RADIUS


def chain(velocity, broken=(), places=None, bonded=False, small=None):
    """A state of a straight chain of grains of which the first half, or so small a part, is aggregate 0; velocity
    (N,) along it, broken: contacts left out."""
    grains = len(velocity)
    position = np.zeros((grains, 3))
    position[:, 0] = 2 * np.arange(grains) if places is None else places
    pairs = [(i, i + 1) for i in range(grains - 1) if i not in broken]
    return {
        "position": position,
        "velocity": np.column_stack([velocity, np.zeros((grains, 2))]),
        "radius": np.ones(grains),
        "aggregate": (np.arange(grains) >= (small or grains // 2)).astype(int),
        "contact_pairs": np.array(pairs),
        "contact_bonded": np.full(len(pairs), bonded),
    }


def parting(grains, energy, first):
    """Velocities with which the first grains and the others part, with this much kinetic energy."""
    reduced = first * (grains - first) / grains
    speed = np.sqrt(2 * energy / reduced)
    return np.where(np.arange(grains) < first, -speed * (grains - first) / grains, speed * first / grains)


STILL = np.zeros(20)
APART = np.repeat([-1.0, 1.0], 10)


@pytest.mark.parametrize(
    "kind, state, since_touch, reason",
    [
        ("sticking", chain(STILL), LONG, None),
        ("sticking", chain(STILL), LONG / 3, "may still rebound"),
        ("sticking", chain(parting(20, 1.1, 10)), LONG, "parts of 50% of the mass"),
        ("sticking", chain(parting(20, 1.1, 10), bonded=True), LONG, None),
        ("sticking", chain(parting(20, 1.1, 4)), LONG, "parts of 20% of the mass"),  # within an aggregate
        ("bouncing", chain(np.repeat([-1.0, 1.0], [2, 18]), [1], small=2), LONG, None),
        ("bouncing", chain(APART, [9]), LONG, None),
        ("bouncing", chain(-APART, [9]), LONG, "may still meet the largest"),
        ("fragmentation", chain(np.repeat([-1.0, 0, 1], [8, 4, 8]), [7, 11]), LONG, None),
        ("fragmentation", chain(np.repeat([0, 0.0, -1], [16, 2, 2]), [15, 17]), LONG, "pieces of 10% of the mass"),
        ("fragmentation", chain(np.repeat([0, 0.1, 1], [16, 2, 2]), [15, 17], 10 * np.arange(20)), LONG, None),
        ("never met", chain(-APART, [9]), 0.0, "the aggregates may still meet"),
    ],
)
def test_a_collision_is_decided_when_nothing_can_break_or_meet(kind, state, since_touch, reason):
    if kind == "fragmentation" and reason is None:
        state["position"] *= 5  # farther apart than the spheres around them
    state["time"] = since_touch
    why = decided.why_undecided(kind, np.ones(20, dtype=bool), state, CONSTANTS, 0.0)
    assert (why is None) if reason is None else (reason in why)


@pytest.mark.parametrize(
    "state, since_touch, longer, rests",
    [
        (chain(STILL), LONG, 1e9, True),
        (chain(STILL), LONG / 4, 1e9, False),
        (chain(parting(20, 1.1, 2)), LONG, 1e9, False),  # less than a tenth may still break off
        (chain(0.3 * (-1.0) ** np.arange(20)), LONG, 1e9, False),  # shakes
        (chain(-APART, [9], np.r_[:20:2, 100:120:2]), LONG, 30.0, True),  # they meet later
        (chain(-APART, [9], np.r_[:20:2, 100:120:2]), LONG, 50.0, False),
    ],
)
def test_a_collision_has_come_to_rest(state, since_touch, longer, rests):
    state["time"] = since_touch
    assert decided.has_come_to_rest(state, CONSTANTS, 0.0, since_touch + longer) is rests


def test_a_piece_that_oscillates_is_not_judged_by_its_turning_point():
    """At the end it is at rest for a moment, a little before it was not; long before does not count."""
    moving, still = ({**chain(velocity), "time": LONG} for velocity in (parting(20, 1.1, 10), STILL))
    counted = np.ones(20, dtype=bool)
    why = lambda end, *recent, kind="sticking": decided.why_undecided(kind, counted, end, CONSTANTS, 0.0, recent)
    assert why(still) is None and "parts of 50%" in why(still, moving)
    assert why({**chain(APART, [9]), "time": LONG}, moving, kind="bouncing") is None  # it was one piece a little before
    assert decided.is_recent(np.array([0.74, 0.76, 1.0]) * LONG, LONG, 0.0).tolist() == [False, True, True]


def test_strength_grows_with_the_reduced_radius_also_of_grains_that_shrank_as_they_sintered():
    state = chain(np.zeros(4))
    state["radius"] = np.array([1.0, 1.0, 3.0, 1e9])
    assert decided.contact_strength(state, CONSTANTS) == pytest.approx([1, 1.5 ** (4 / 3), 6 ** (4 / 3)], rel=1e-6)
    shrunk = {**CONSTANTS, "shrunkRadius": 0.8}
    assert contact_strength(chain(STILL, bonded=True), shrunk) == pytest.approx(np.full(19, 9.0))
    assert contact_strength(chain(STILL), shrunk) == pytest.approx(np.full(19, 0.8 ** (4 / 3)))


@pytest.mark.parametrize("seed", range(10))
def test_cuts_are_those_contacts_without_which_there_is_a_piece_more(seed):
    random = np.random.default_rng(seed)
    grains = random.integers(2, 60)
    pairs = np.unique(np.sort(random.integers(0, grains, (int(0.65 * grains), 2))), axis=0)
    pairs = pairs[pairs[:, 0] < pairs[:, 1]]
    position, velocity, mass = *random.normal(size=(2, grains, 3)), random.uniform(1, 2, grains)
    labels = fragment_labels(grains, pairs)
    one = np.zeros(grains, dtype=int)  # all of one aggregate: no cut between two
    _, sides = loose_cuts(position, velocity, mass, pairs, labels, one, np.full(len(pairs), -1.0))
    expected = []
    for contact, ends in enumerate(pairs):
        without = fragment_labels(grains, np.delete(pairs, contact, axis=0))
        if without.max() > labels.max():
            expected.append(min(mass[without == without[end]].sum() for end in ends))
    assert np.sort(sides) == pytest.approx(np.sort(expected))


def standing(velocity, on=True, broken=(), **more):
    """A chain whose first grain touches the plate at x = -1, or all but touches it."""
    state = chain(velocity, broken, **more)
    plane = dict(plane_axis=np.array([0]), plane_position=np.array([-1.0]), plane_contacts=np.zeros((int(on), 2), int))
    return {**state, **plane, "aggregate": np.zeros(len(velocity), int), "time": 0.0}


def leaving(energy):
    """The chain moves from the plate with this kinetic energy."""
    return STILL + np.sqrt(2 * energy / 20)


HOLDS = 2 ** (4 / 3)  # energy that breaks the contact with the plate, over that of two grains
FAR = np.r_[2.0 * np.arange(19), 1e5]  # the last grain is far away
UPPER_HALF, START = np.repeat([0.0, 1.0], 10), standing(STILL - 2, on=False)


@pytest.mark.parametrize(
    "kind, state, since_touch, on, restitution, reason",
    [
        ("sticking", standing(STILL), LONG, 1, 0, None),
        ("sticking", standing(leaving(1.1)), LONG, 1, None, "parts of 95% of the mass"),  # between two grains
        ("sticking", standing(leaving(1.2), broken=[18], places=FAR), LONG, 0.95, None, "parts of 90% of the mass"),
        ("sticking", standing(leaving(0.9 * HOLDS), bonded=True), LONG, 1, 0, None),
        ("sticking", standing(leaving(1.1 * HOLDS), bonded=True), LONG, 1, None, "parts of 100% of the mass"),
        ("bouncing", standing(STILL + 1, on=False), LONG, 0, 0.5, None),
        ("bouncing", standing(STILL - 1, on=False), LONG, 0, None, "100% of the mass may still meet the plate"),
        ("fragmentation", standing(UPPER_HALF, broken=[9]), LONG, 0.5, None, None),
        ("fragmentation", standing(-UPPER_HALF, broken=[9]), LONG, 0.5, None, "50% of the mass may still meet"),
    ],
)
def test_outcome_on_a_plate_and_whether_it_is_decided(kind, state, since_touch, on, restitution, reason):
    found = plate_outcome(START, state, met=kind != "never met")
    assert (found.kind, found.mass_on_plate, found.growth_efficiency) == (kind, on, on)
    assert max(found.mass_fractions) == pytest.approx(max(on, 1 - on)) and found.fragments == 1 + (0 < on < 1)
    why = why_undecided_on_plate(found.kind, START, state, CONSTANTS, -since_touch)
    assert why is None if reason is None else reason in why
    assert found.if_decided(why).restitution == restitution


@pytest.mark.parametrize(
    "separation, velocity, offset, time, meets",
    [
        (10, -1.0, 0, 7.9, False),  # touch after 8
        (10, -1.0, 0, 8.1, True),
        (10, -1.0, 1.99, 100, True),
        (10, -1.0, 2.01, 100, False),
        (1.9, 5.0, 0, 1, True),  # the spheres around them overlap now
    ],
)
def test_two_grains_that_meet_in_time(separation, velocity, offset, time, meets):
    position, moving = np.array([[0.0, 0, 0], [separation, offset, 0]]), np.array([[0.0, 0, 0], [velocity, 0, 0]])
    grains = position, moving, np.ones(2), np.ones(2), np.array([0, 1])
    assert pieces_can_meet(*grains, time) is meets
    assert [pieces_that_can_meet(piece, *grains, time).tolist() for piece in (0, 1)] == [[False, meets], [meets, False]]


def test_rigid_motion_is_no_inner_motion_of_one_and_two_grains_either():
    random = np.random.default_rng(1)
    position, mass, labels = random.normal(size=(30, 3)), random.uniform(0.5, 2, 30), np.zeros(30, dtype=int)
    velocity = np.array([1.0, 2, 3]) + np.cross([0.3, -0.2, 0.5], position)
    assert np.abs(motion_in_pieces(position, velocity, mass, labels)).max() < 1e-12
    assert inner_kinetic_energy(position, velocity, mass, labels)[0] < 1e-24
    position = np.array([[0.0, 0, 0], [5, 0, 0], [7, 0, 0]])
    velocity = np.array([[1.0, 1, 1], [0, 1, 0], [0, -1, 0]])
    labels, mass = np.array([1, 0, 0]), np.ones(3)
    assert np.abs(motion_in_pieces(position, velocity, mass, labels)).max() < 1e-12
    stretched = velocity + np.array([[0, 0, 0], [-1, 0, 0], [1, 0, 0]])
    assert inner_kinetic_energy(position, stretched, mass, labels) == pytest.approx([1.0, 0.0])
