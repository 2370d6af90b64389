"""A checkpoint taken in mid-contact resumes to the same bits, as text and binary.

YADE adds up the forces on a grain in the order of its interaction container, which contacts that break shuffle
differently before and after loading; InteractionLoop(loopOnSortedInteractions=True) makes the order that of the ids,
and with it the bits."""

import pickle

import pytest
from scenes import *

pytestmark = pytest.mark.in_yade


def state():
    return [[list(b.state.pos), list(b.state.vel), list(b.state.angVel), list(b.state.ori)] for b in O.bodies]


@pytest.mark.parametrize("format", [".xml.bz2", ".yade.gz"])
def test_checkpoint_continues_to_the_bit(format):
    new_scene(0.1 * unit)
    O.engines[2].loopOnSortedInteractions = True
    cluster(7, 3, [ice(viscoelasticTime=1e-12), soft()], [1e-7, 1.6e-7], speed=3.0, spin=3e7)
    O.run(300, True)
    assert O.interactions.countReal() > 2
    O.save("checkpoint" + format)
    O.run(400, True)
    straight, sums = state(), energies()
    assert sums["slidingDissipation"] > 0 and sums["disconnection"] > 0
    O.load("checkpoint" + format)
    assert O.iter == 300
    O.run(400, True)
    assert state() == straight and energies() == sums


def test_pickled_material_and_functors_keep_their_attributes():
    m = pickle.loads(pickle.dumps(soft(viscoelasticTime=3e-12)))
    values = [m.young, m.poisson, m.density, m.surfaceEnergy, m.criticalRolling, m.viscoelasticTime]
    assert values == [3e9, 0.33, 1300, 0.05, 1.1e-9, 3e-12]
    law = pickle.loads(pickle.dumps(Law2_ScGeom_JKRWadaPhys_JKRWada(rolling=False)))
    assert (law.rolling, law.twisting) == (False, True)
