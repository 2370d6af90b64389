"""The ensemble's code, as processors run it, makes the engine's collisions: the same motion, events and energies."""

import ctypes

import numpy as np
import pytest
from scenes import *

from analysis import theory
from yade_scripts import packings
from yade_scripts.run.ensemble import MATERIAL, MECHANISMS, WHOLE_PROCESSOR, Collision, Grains, Library

RADIUS = 1e-7
OPENMP = ctypes.CDLL("libgomp.so.1")
SPRINGS = sum(MECHANISMS.values()) - MECHANISMS["drag"]
ICE = dict(young=7e9, poisson=0.25, density=1000.0, surfaceEnergy=0.1, criticalRolling=8e-10, viscoelasticTime=0.0)
SOFT = dict(ICE, young=3e9, surfaceEnergy=0.05)
TIME_UNIT = theory.pair_constants(theory.ICE, RADIUS).time_unit
OVERLAP = theory.pair_constants(theory.ICE, RADIUS).equilibrium_overlap
# What each scene has beside two clusters of ice: materials, radii over RADIUS in turn, options of the collision.
SCENES = {
    "like": ([ICE], [1], {}),
    "drag": ([dict(ICE, viscoelasticTime=6e-12)], [1], {"mechanisms": SPRINGS + MECHANISMS["drag"]}),
    "cut": ([ICE], [1], {"limit": "cut"}),
    "bonds": ([ICE], [1], {"neck": 0.3}),
    "unlike": ([ICE, SOFT], [1, 0.98], {}),
}


def two_clusters(kind, grains=30, speed=20.0):
    """Grains of a BPCA and a BCCA cluster that are about to touch, with spins."""
    materials, sizes, _ = SCENES[kind]
    one = packings.bpca(grains, RADIUS, OVERLAP, 1).position
    other = packings.bcca(grains, RADIUS, OVERLAP, 2).position
    first, last = one[one[:, 0].argmax()], other[other[:, 0].argmin()]
    position = np.vstack([one, other + first - last + [2.05 * RADIUS, 0, 0]])
    aggregate = np.repeat([0, 1], grains)
    velocity = np.zeros_like(position)
    velocity[:, 0] = np.where(aggregate, -speed / 2, speed / 2)
    spin = np.random.default_rng(3).normal(scale=1e6, size=position.shape)
    turn = np.arange(2 * grains)
    return Grains(
        position,
        velocity,
        RADIUS * np.array(sizes)[turn % len(sizes)],
        np.array([[material[name] for name in MATERIAL] for material in materials]),
        turn % len(materials),
        aggregate,
        spin,
    )


def collision(kind, steps, time_step=0.05, interval=50, library=Library(), **changed):
    options = {"mechanisms": SPRINGS, **SCENES[kind][2], **changed}
    return Collision(library, two_clusters(kind), steps, time_step * TIME_UNIT, interval, **options)


def ran(kind, steps, **options):
    one = collision(kind, steps, **options)
    one.library.run([one], steps)
    return one.read()


CHANGE = (500, 0.1 * TIME_UNIT, 25)  # after so many steps to these, of so many between samples


@pytest.mark.in_yade
@pytest.mark.parametrize(
    "kind, change", [*((kind, None) for kind in SCENES), *((kind, CHANGE) for kind in ("drag", "bonds"))]
)
def test_the_ensemble_moves_grains_as_the_engine_does(kind, change):
    grains, steps = two_clusters(kind), 1000
    options = {name: value for name, value in SCENES[kind][2].items() if name != "mechanisms"}
    new_scene(0.05 * TIME_UNIT, "fused", subSteps=50, **options)
    materials = [ice(**dict(zip(MATERIAL, row))) for row in grains.materials.tolist()]
    for x, v, w, r, k in zip(grains.position, grains.velocity, grains.spin, grains.radius, grains.kind):
        grain(x, r, materials[k], v, w)
    O.run(10, True)
    O.engines[0].subSteps = CHANGE[2] if change else 50
    O.run((steps - 500) // O.engines[0].subSteps, True)
    there, counts = contact_law.snapshot(), O.engines[0].statistics()

    ours = ran(kind, steps, change=change)
    position, velocity, spin = ours.motion()
    samples = ours.samples()
    pairs, force, bonded = ours.contacts()
    speed = np.abs(there["velocity"]).max()
    assert samples["time"][-1] == pytest.approx(there["time"], rel=1e-12)
    assert ours.failure is None and samples["formed"][-1] >= 2
    assert np.abs(position - there["position"]).max() < 1e-11 * RADIUS
    assert np.abs(velocity - there["velocity"]).max() < 1e-9 * speed
    assert np.abs(spin - there["angular_velocity"]).max() < 1e-9 * speed / RADIUS
    theirs = np.sort(there["contact_pairs"], axis=1)
    order = np.lexsort(theirs.T[::-1])
    assert np.array_equal(pairs, theirs[order]) and np.array_equal(bonded, there["contact_bonded"][order])
    assert force == pytest.approx(there["contact_normal_force"][order], abs=1e-9 * np.abs(force).max())
    assert {name: samples[name][-1] for name in ("formed", "broken", *BROKEN_BONDS)} == {
        name: counts[name] for name in ("formed", "broken", *BROKEN_BONDS)
    }
    booked = dict(O.energy.items())
    for name in ours.library.channels:
        assert samples[name][-1] == pytest.approx(booked.get(name, 0.0), abs=1e-11 * samples["kinetic"][0])


@pytest.mark.parametrize("kind", SCENES)
def test_the_ledger_closes_to_second_order(kind):
    """Half the step, a quarter of the error: over the first contacts, before motions part."""
    time = 20.0  # t0: the first contacts form
    error = []
    for step in (0.04, 0.02, 0.01):
        samples = ran(kind, round(time / step), time_step=step).samples()
        total = sum(samples[name] for name in Library().channels)
        error.append(np.abs(total - total[0]).max() / samples["kinetic"][0])
    order = np.polyfit(np.log([4, 2, 1]), np.log(error), 1)[0]
    assert 1.6 < order < 2.6 and error[-1] < 1e-5


@pytest.mark.parametrize("kind", SCENES)
def test_many_threads_move_one_collision_as_one_does(kind):
    """With several groups of threads, and one of them not full."""
    OPENMP.omp_set_num_threads(5)
    alone, together = (ran(kind, 1000, library=library) for library in (Library(), Library(WHOLE_PROCESSOR)))
    assert np.array_equal(together.motion(), alone.motion())
    assert all(np.array_equal(*both) for both in zip(together.contacts(), alone.contacts()))
    one, other = alone.samples(), together.samples()
    assert one["formed"][-1] >= 2
    for name, values in one.items():
        assert other[name] == pytest.approx(values, rel=1e-9, abs=1e-12 * one["kinetic"][0])


def test_a_collision_resumes_to_the_same_bits():
    whole, part = ran("unlike", 600), collision("unlike", 600)
    part.library.run([part], 250)
    again = part.resumed(part.read().save())
    again.library.run([again], 600)
    again.read()
    assert again.step == 600 and np.array_equal(again.motion(), whole.motion())
    assert all(np.array_equal(values, again.samples()[name]) for name, values in whole.samples().items())


def test_collisions_of_unlike_length_run_side_by_side():
    many = [collision("like", steps) for steps in (100, 300, 200)]
    many[0].library.run(many, [300, 250, 50])
    assert [each.read().step for each in many] == [100, 250, 50]
    many[0].library.run(many, 300)
    assert [each.read().step for each in many] == [100, 300, 200]
    assert np.array_equal(many[1].motion(), ran("like", 300).motion())


def test_a_grain_that_is_too_fast_fails_alone():
    slow, fast = collision("like", 100), Collision(Library(), two_clusters("like", speed=2e4), 100, 0.1 * TIME_UNIT, 50)
    slow.library.run([slow, fast], 100)
    assert "too long" in fast.read().failure and slow.read().failure is None
