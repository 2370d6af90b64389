"""Outcome of a collision with a plate, and when it is decided: a chain that stands on it, in the units of test_decided.py."""

import numpy as np
import pytest
from test_decided import CONSTANTS, LONG, STILL, chain

from analysis.measures.plate import plate_outcome, why_undecided_on_plate


def standing(velocity, on=True, broken=(), bonded=False):
    """A chain whose first grain touches the plate at x = -1, or all but touches it."""
    state = chain(velocity, broken, bonded=bonded)
    contacts = {
        "plane_axis": np.array([0]),
        "plane_position": np.array([-1.0]),
        "plane_contacts": np.zeros((int(on), 2), int),
    }
    return {**state, **contacts, "aggregate": np.zeros(len(velocity), int), "time": 0.0}


def leaving(energy):
    """The chain moves from the plate with this kinetic energy."""
    return STILL + np.sqrt(2 * energy / 20)


HOLDS = 2 ** (4 / 3)  # energy that breaks the contact with the plate, over that of two grains
APART = np.repeat([0.0, 1.0], 10)
START = standing(STILL - 2, on=False)


@pytest.mark.parametrize(
    "kind, state, since_touch, on, restitution, reason",
    [
        ("sticking", standing(STILL), LONG, 1, 0, None),
        ("sticking", standing(STILL), LONG / 3, 1, None, "may still rebound"),
        ("sticking", standing(leaving(0.9)), LONG, 1, 0, None),
        ("sticking", standing(leaving(1.1)), LONG, 1, None, "parts of 95% of the mass"),  # between two grains
        ("sticking", standing(leaving(0.9 * HOLDS), bonded=True), LONG, 1, 0, None),
        ("sticking", standing(leaving(1.1 * HOLDS), bonded=True), LONG, 1, None, "parts of 100% of the mass"),
        ("bouncing", standing(STILL + 1, on=False), LONG, 0, 0.5, None),
        (
            "bouncing",
            standing(STILL - 1, on=False),
            LONG,
            0,
            None,
            "pieces of 100% of the mass may still meet the plate",
        ),
        ("bouncing", standing(STILL + 1, broken=[0]), LONG, 0.05, 0.5, None),  # all but one grain
        ("fragmentation", standing(APART, broken=[9]), LONG, 0.5, None, None),
        ("fragmentation", standing(-APART, broken=[9]), LONG, 0.5, None, "pieces of 50% of the mass may still meet"),
        ("never met", standing(STILL - 1, on=False), LONG, 0, None, "may still meet the plate"),
    ],
)
def test_outcome_and_whether_it_is_decided(kind, state, since_touch, on, restitution, reason):
    seen = plate_outcome(START, state, met=kind != "never met")
    assert (seen.kind, seen.mass_on_plate, seen.growth_efficiency) == (kind, on, on)
    assert max(seen.mass_fractions) == max(on, 1 - on) and seen.fragments == 1 + (0 < on < 1)
    why = why_undecided_on_plate(seen.kind, START, state, CONSTANTS, -since_touch)
    assert why is None if reason is None else reason in why
    assert seen.if_decided(why).restitution == restitution
