"""A run of JKRWadaEngine is one, whatever carries it out: the same bits on any number of threads, every time and
from a checkpoint on, the same to rounding with any instruction set and any domains."""

from functools import partial

import pytest
import test_blocked as blocked
import test_bonds_in_periodic_cells as bonds_in_cells
import test_bonds_in_the_engine as bonds
import test_grain_order as grain_order
import test_outside_forces as outside
import test_periodic as periodic
import test_planes_in_the_engine as planes
import test_sintering as sintering
from scenes import *

pytestmark = pytest.mark.in_yade


def engine(start, sub_steps=10, **law):
    """How a scene begins: a function of the engine's other options. In cells with prepare(): the engine takes the
    velocity gradient at once."""

    def begin(**options):
        start()
        engine_of_sub_steps(sub_steps, **law, **options)
        if O.periodic:
            O.engines[0].prepare()

    return begin


def sintered(kind, count, speed):
    def begin(**options):
        sintering.start(kind, count, speed)
        engine_of_sub_steps(10, **options)
        for neck in (0.4, 0.6):
            O.run(8, True)
            contact_law.sinter(neck)

    return begin


def spread(kind):
    new_scene(0.2 * unit)
    converging(300, 1, *grain_order.materials_and_radii(kind), speed=12.0)


def pushed(drag, **options):
    new_scene(unit)
    cluster(7, 3, [ice(viscoelasticTime=drag)], [1e-7], 3.0, 3e7)
    outside.push()
    fused_engine(subSteps=10, **options)


def held(**options):
    blocked.piston(0.1, subSteps=7, **options)
    O.dt *= 7


met = lambda c: c["events"] > 1000
contacts = lambda kind, limit, **law: engine(partial(meeting, kind, 400), limit=limit, **law)
bonded = lambda kind: engine(partial(bonds.start, kind, 200, 12.0), neck=bonds.NECK)
cell = lambda kind, homo: engine(partial(periodic.start, kind, 1e-3, homo, 343))
sintered_cell = engine(partial(bonds_in_cells.start, "like", 1e-3, 2, side=4), 5, neck=0.4)
spread_out = engine(partial(spread, "drag"), 50, domains=8)
# How it begins, O.steps until the checkpoint and from there on, its file, what must have happened (counts and
# energies), threads.
RUNS = {
    "drag": (contacts("drag", "held"), 60, 60, ".yade.gz", met, 2),
    "springs damped": (contacts("drag", "held", springDamping=1e-11), 60, 60, ".yade.gz", met, 2),
    "unlike, cut": (contacts("unlike", "cut"), 60, 60, ".yade", met, 2),
    "unlike, bonds": (bonded("unlike"), 6, 40, ".xml.gz", lambda c: sum(broken()) > 50 and c["bonds"] > 20, 2),
    "bonds in a cell": (sintered_cell, 15, 15, ".yade.gz", lambda c: sum(broken()) > 10, 2),
    "drag, a cell": (cell("drag", 0), 25, 25, ".xml.bz2", lambda c: met(c) and c["searches"] > 1, 2),
    "planes": (engine(partial(planes.start, count=343)), 30, 60, ".yade.gz", lambda c: c["planeContacts"] > 20, 2),
    "unlike, sintered": (sintered("unlike", 216, 12.0), 0, 10, ".yade.gz", lambda c: sum(broken()) > 20, 2),
    "drag, in a new order": (spread_out, 30, 90, ".yade.gz", lambda c: met(c) and c["orders"] >= 1, 3),
    "blocked": (held, 40, 60, ".yade.bz2", lambda c: c["constraintWork"] != 0, 2),
    "pushed, drag": (partial(pushed, 1e-12), 20, 20, ".xml", lambda c: c["externalWork"] != 0, 2),
}


@pytest.mark.parametrize("name", RUNS)
def test_same_bits_on_any_threads_every_time_and_after_a_checkpoint(name):
    begin, before, after, file, happened, threads = RUNS[name]

    def state():
        counts = O.engines[0].statistics()
        del counts["threads"], counts["searches"], counts["distanceChecks"]  # the latter of the lists of neighbours
        return motion(), sintering.necks(), counts, dict(O.energy.items())

    def end(threads, save=False):
        begin(threads=threads)
        if before:
            O.run(before, True)
        if save:
            O.save(f"half{file}")
        O.run(after, True)
        return state()

    straight = end(1)
    assert happened({**O.engines[0].statistics(), **straight[-1]}) and ("sintered" not in name or len(straight[1]) == 3)
    assert end(threads) == straight and end(1, save=True) == straight
    O.load(f"half{file}")
    O.engines[0].threads = threads
    O.run(after, True)
    *same, energy = state()
    assert same == [*straight[:-1]] and energy == pytest.approx(straight[-1], rel=1e-12)


# How it begins, O.steps, and the largest difference of a position [1e-7 m].
ROUNDING = {
    "cut": (engine(partial(meeting, "like"), 1, limit="cut"), 200, 1e-11),
    "bonds in a cell": (sintered_cell, 30, 1e-9),
    "a cell": (engine(partial(periodic.start, "drag", 1e-3, 2), 1), 300, 1e-9),
}


@pytest.mark.parametrize("name", ROUNDING)
def test_instruction_sets_and_domains_agree_to_rounding(name):
    begin, steps, most = ROUNDING[name]

    def end(**options):
        begin(**{"instructions": "portable", **options})
        O.run(steps, True)
        return positions(), energies("boundaryWork")["boundaryWork"]

    x, work = end()
    assert O.engines[0].statistics()["events"] > 50
    for options in ({"domains": 1}, {"domains": 3}, {"instructions": "avx2"}, {"instructions": "avx512"}):
        try:
            y, done = end(**options)
        except RuntimeError:  # an instruction set that this machine lacks
            assert "domains" not in options
            continue
        assert np.abs(x - y).max() < most * 1e-7 and done == pytest.approx(work, rel=1e-9), options
