"""The energy channels: the plugin's list is that of run folders, and what O.energy holds is what the list says."""

import pytest
from scenes import *

from analysis.runs.format import CHANNEL_TABLE

pytestmark = pytest.mark.in_yade


def test_plugin_and_run_folders_have_the_same_channels_and_modes_of_bonds():
    """Names, kinds and order of contact_law/kernel/energy_channels.hpp and analysis/runs/format.py."""
    assert list(contact_law.channels) == [(c.name, c.kind) for c in CHANNEL_TABLE]
    new_scene(0.1 * unit, "fused")
    grain((0, 0, 0), 1e-7, ice())
    O.step()
    modes = [name for name in O.engines[0].statistics() if name.startswith("brokenBy") and name.endswith("ing")]
    assert modes == list(BROKEN_BONDS)


@pytest.mark.parametrize("mover", ["fused", "functors"])
def test_o_energy_has_all_channels_whoever_moves_the_grains(mover):
    new_scene(0.1 * unit, mover)
    grain((0, 0, 0), 1e-7, ice())
    grain((0, 1.99e-7, 0), 1e-7, ice(), velocity=(0, -1, 0))
    O.run(3, True)
    assert channels_found() == {c.name for c in CHANNEL_TABLE}
    assert not any(O.energy[c.name] for c in CHANNEL_TABLE if c.kind == "work")


def channels_found():
    return {name for name, _ in O.energy.items()} - {"gravWork"}  # NewtonIntegrator's own


@pytest.mark.parametrize("away", ["O.reset()", "O.switchScene()"])
def test_a_law_that_is_used_again_books_in_the_new_scene(away):
    """O.energy is another one there, at the iteration of the scene before."""
    new_scene(0.1 * unit)
    loop, normal = O.engines[2], []
    for scene in range(2):
        if scene:
            exec(away)
            O.dt, O.trackEnergy = 0.1 * unit, True
            dispatchers = loop.geomDispatcher, loop.physDispatcher, loop.lawDispatcher
            O.engines = functor_engines()
            O.engines[2] = InteractionLoop(*(dispatcher.functors for dispatcher in dispatchers))
        for x in (0, 1.985e-7):
            grain((x, 0, 0), 1e-7, ice())
        O.step()
        normal.append(O.energy["normal"])
    assert channels_found() == {c.name for c in CHANNEL_TABLE}
    assert normal[0] == normal[1] < 0
