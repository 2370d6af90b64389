"""The energy channels: the plugin's list is that of run folders, and what O.energy holds is what the list says."""

from analysis.runs.format import CHANNEL_TABLE


def test_plugin_and_run_folders_have_the_same_channels(yade):
    """Names, kinds and order of contact_law/kernel/energy_channels.hpp and analysis/runs/format.py."""
    found = yade("result['channels'] = contact_law.channels")
    assert [tuple(row) for row in found["channels"]] == [(c.name, c.kind) for c in CHANNEL_TABLE]


SCENE = """
from scenes import *
def channels_of(fused, periodic, blocked, pushed):
    new_scene(0.1 * constants(ice(), 1e-7)["timeUnit"])
    if periodic:
        O.periodic = True
        O.cell.setBox(1e-6, 1e-6, 1e-6)
    grain((5e-7, 5e-7, 5e-7), 1e-7, ice(), velocity=(0, 2, 0), blocked="xyzXYZ" if blocked else "")
    grain((5e-7, 6.99e-7, 5e-7), 1e-7, ice(), velocity=(0, 1, 0))
    if pushed: O.forces.setPermF(1, Vector3(1e-12, 0, 0))
    if fused: fused_engine()
    O.run(3, True)
    return sorted(name for name, _ in O.energy.items() if name != "gravWork")  # NewtonIntegrator's own
"""


def test_o_energy_has_the_channels_of_the_scene_and_no_others(yade):
    """All channels of the law in every scene; the works only where the scene has what they are done on. Either way of moving."""
    found = yade(
        SCENE
        + """
for fused in (0, 1):
    scenes = ((0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1))
    result[fused] = [channels_of(fused, *scene) for scene in scenes]
"""
    )
    plain = sorted(c.name for c in CHANNEL_TABLE if c.kind != "work")
    periodic, blocked = sorted([*plain, "boundaryWork"]), sorted([*plain, "constraintWork"])
    assert found["1"] == [plain, periodic, blocked, sorted([*plain, "externalWork"])]
    assert found["0"] == [plain, periodic, plain, plain]  # the functors leave constraintWork and externalWork out
