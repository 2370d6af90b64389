"""Grains so unequal that large ones stretch their contacts by more than the radius of the smallest."""

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade


@pytest.mark.parametrize("mover", ["fused", "functors"])
def test_large_grains_that_touch_are_bonded(mover):
    """Sintering shrinks them by more than the small one measures."""
    new_scene(1e-3 * unit, mover, neck=0.7)
    d = 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]
    for x, radius in (((0, 0, 0), 1e-7), ((d, 0, 0), 1e-7), ((0, 5e-7, 0), 1e-8)):
        grain(x, radius, ice())
    steps(2)
    assert contact_law.snapshot()["contact_neck"].tolist() == [0.7]


def test_a_stretched_contact_stays_one():
    """Stretched beyond the radius of the smallest grain, and pressed again: the contact of before."""
    new_scene(1e-3 * unit, "fused")
    d = 2e-7 - constants(ice(), 1e-7)["equilibriumOverlap"]
    for x, radius in (((0, 0, 0), 1e-7), ((d, 0, 0), 1e-7), ((0, 1e-6, 0), 5e-10)):
        grain(x, radius, ice(), blocked="xyzXYZ")
    O.step()
    for way in (1, -1):
        O.bodies[1].state.vel = Vector3(way * 50, 0, 0)
        while way * (O.bodies[1].state.pos[0] - (2e-7 + (0.6e-9 if way > 0 else -2e-9))) < 0:
            O.step()
    counted = O.engines[0].statistics()
    assert (counted["contacts"], counted["formed"], counted["broken"]) == (1, 0, 0)
