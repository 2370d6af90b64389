"""A script moves a grain away and puts another engine in place, adds a grain, or has the contacts written, before the next step: what it has torn apart is let go as where
it is moved alone (test_changes_obeyed.py)."""

import pytest
from changes import *

pytestmark = pytest.mark.in_yade
LAST = 3  # the grain that is moved


CHANGES = {
    "engine": "O.engines = [same()]",
    "grain": "grain((0, 3e-6, 0), 1e-7, O.bodies[0].material)",
    "written": "engine().exportInteractions = True; engine().prepare(); O.engines = [same()]",
    "functors": "O.engines = functor_engines(neck=engine().neck)",
    "written for functors": "engine().exportInteractions = True; engine().prepare(); O.engines = functor_engines(neck=engine().neck)",
    "after functors": "O.engines = [JKRWadaEngine(neck=neck)]",
}


def moved(change, neck, by):
    """Channels that a chain has lost some steps after its last grain was moved by `by` and a change made, and the pairs then."""
    chain(neck=neck)
    steps(20)
    if change == "after functors":
        run(CHANGES["functors"])
        steps(20)
    before = energies()
    O.bodies[LAST].state.pos += Vector3(*by)
    run(CHANGES.get(change, ""), neck=neck)
    steps(20)
    assert max(b.state.vel.norm() for b in O.bodies) < 1
    lost = {name: energies()[name] - before[name] for name in ("disconnection", "bondBreaking")}
    return lost, contact_law.snapshot()["contact_pairs"]


@pytest.mark.parametrize("change", CHANGES)
@pytest.mark.parametrize("neck, axis", [(0, 0), (0, 1), (0.3, 0), (0.3, 1)])
def test_what_is_torn_apart_is_let_go(change, neck, axis):
    """Whatever rounding makes of the places: a run from there breaks the contact or bond without a kick, and books what it held."""
    c = constants(ice(), 1e-7)
    bond = Ip2_JKRMat_JKRMat_JKRWadaPhys(neck=0.3).bondConstants(ice(), 1e-7, ice(), 1e-7)
    of_contact = 4 * c["pullOffForce"] * c["pullOffOverlap"]
    channel, most = ("bondBreaking", bond["breakingEnergy"]) if neck else ("disconnection", of_contact)
    most *= 2.1 if "written" in change else 1  # what it held is not known then: at most this by each mode
    for distance in 3e-8 * (1 + 0.01 * np.arange(5)):
        by = distance * np.eye(3)[axis]
        (lost, pairs), (alone, _) = moved(change, neck, by), moved("", neck, by)
        assert sorted(sorted(pair) for pair in pairs.tolist()) == [[0, 1], [1, 2]]
        assert 0 < lost[channel] < most
        if change in ("engine", "grain"):
            assert lost[channel] == pytest.approx(alone[channel], rel=0.1)


@pytest.mark.parametrize("change", ["engine", "written", "functors", "written for functors"])
def test_a_grain_moved_off_a_wall_is_let_go(change):
    c = Ip2_JKRMat_JKRMat_JKRWadaPhys().pairConstants(ice(), 1e-7, ice(), float("inf"))
    for distance in 3e-8 * (1 + 0.01 * np.arange(5)):
        new_scene(0.1 * unit, "fused")
        wall = O.bodies.append(utils.wall(0, axis=2, material=ice()))
        grain((0, 0, 1e-7 - c["equilibriumOverlap"]), 1e-7, O.bodies[wall].material, (0.01, 0, 0))
        steps(20)
        before = energies()["disconnection"]
        O.bodies[1].state.pos += Vector3(0, 0, distance)
        run(CHANGES[change])
        steps(20)
        assert 0 < energies()["disconnection"] - before < 4 * c["pullOffForce"] * c["pullOffOverlap"]
        assert O.bodies[1].state.vel.norm() < 0.2
