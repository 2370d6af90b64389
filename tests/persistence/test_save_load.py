"""A checkpoint taken in mid-contact resumes to the same bits, in every format YADE writes.

YADE adds up the forces on a grain in the order of its interaction container, which contacts that break shuffle differently before and after loading;
InteractionLoop(loopOnSortedInteractions=True) makes the order that of the ids, and with it the bits."""

import pytest

CONTINUE = """
from scenes import *
def state():
    return [[list(b.state.pos), list(b.state.vel), list(b.state.angVel), list(b.state.ori)] for b in O.bodies]
unit = constants(ice(), 1e-7)["timeUnit"]
new_scene(0.1 * unit)
O.engines[2].loopOnSortedInteractions = True
cluster(7, 3, [ice(viscoelasticTime=1e-12), soft()], [1e-7, 1.6e-7], speed=3.0, spin=3e7)
O.run(300, True)
assert O.interactions.countReal() > 2
name = "checkpoint" + parameters["format"]
O.save(name)
O.run(400, True)
straight, sums = state(), energies()
O.load(name)
assert O.iter == 300
O.run(400, True)
result["same"] = state() == straight
result["energies"] = [sums, energies()]
"""


@pytest.mark.parametrize("format", [".xml", ".xml.bz2", ".xml.gz", ".yade", ".yade.gz", ".yade.bz2"])
def test_checkpoint_continues_to_the_bit(yade, format):
    found = yade(CONTINUE, {"format": format})
    assert found["same"]
    before, after = found["energies"]
    assert before["slidingDissipation"] > 0 and before["disconnection"] > 0
    assert after == before


def test_pickled_material_and_functors_keep_their_attributes(yade):
    found = yade("""
import pickle
from scenes import *
m = pickle.loads(pickle.dumps(soft(viscoelasticTime=3e-12)))
law = pickle.loads(pickle.dumps(Law2_ScGeom_JKRWadaPhys_JKRWada(rolling=False)))
result.update(values=[m.young, m.poisson, m.density, m.surfaceEnergy, m.criticalRolling, m.viscoelasticTime], rolling=law.rolling, twisting=law.twisting)
""")
    assert found == {"values": [3e9, 0.33, 1300, 0.05, 1.1e-9, 3e-12], "rolling": False, "twisting": True}
