"""Collisions that are oblique, with drag, ended early, of single grains or spinning; impactStepFraction."""

import numpy as np
import pytest
from running import completed
from scipy.stats import kstest

from analysis.runs.folder import open_run
from analysis.runs.ledger import closure_history
from analysis.runs.measured import outcome_of_run
from analysis.theory import ICE, collide_pair, pair_constants
from yade_scripts.experiments.collision import KIND, CollisionParameters

TINY = ("packing=bpca", "grains=40", "velocity=40", "stepFraction=0.2", "threads=1")


def test_a_collision_with_drag_ends_early_with_the_fragments_of_the_whole_time(tmp_path):
    arguments = (*TINY, "viscoelasticTime=6e-12", "impact=0.6", "duration=6e-7", "states=7", "seed=3")
    whole, history = completed(tmp_path / "whole", *arguments)
    early, shorter = completed(tmp_path / "early", *arguments, "endWhenApart=1")
    assert whole["timeReached"] == pytest.approx(6e-7, rel=1e-2)
    assert early["status"] == "completed" and early["timeReached"] < 0.8 * whole["timeReached"]
    run, other = (open_run(tmp_path / name / "run") for name in ("early", "whole"))
    assert run.ended and shorter["time"][-1] == early["timeReached"] == run.last.time and len(other.states) == 7
    assert run.last.fragments().grains.tolist() == other.last.fragments().grains.tolist()
    # until then the two are the same run
    assert np.array_equal(shorter["rollingDissipation"], history["rollingDissipation"][: len(shorter["time"])])
    assert shorter["drag"][-1] > 0 and early["derived"]["targetCharacteristicRadius"] > 0


def test_aggregates_that_pass_each_other(tmp_path):
    """A seed that misses at B_off = 1 makes a run, whose outcome is decided however short it is."""
    run, history = completed(tmp_path, *TINY, "impact=1", "seed=1")
    assert run["timeReached"] < 3e-7 and "firstTouch" not in run["derived"]
    assert open_run(tmp_path / "run").last.fragments().grains.tolist() == [40, 40]
    assert np.all(history["contacts_between"] == 0)
    completed(tmp_path / "short", *TINY, "impact=1", "seed=1", "duration=1e-9")
    ending = KIND.ending(tmp_path / "short" / "run")
    assert ending.outcome == "never met" and "growth" not in ending.words


RUN = ("radius=8", "velocity=30", "duration=400e-9", "threads=1", "stepFraction=0.2", "states=3")


def test_samples_stay_and_the_ledger_closes_better(tmp_path):
    about, one = completed(tmp_path / "shorter", *RUN, "impactStepFraction=0.06")
    longer, other = completed(tmp_path / "longer", *RUN)
    assert np.allclose(one["time"], other["time"], rtol=1e-12, atol=0)
    assert about["derived"]["steps"] == longer["derived"]["steps"]
    assert about["derived"]["stepChoice"].startswith("as given: 0.06 t0 until ")
    until = float(about["derived"]["stepChoice"].split()[5])
    assert until == pytest.approx(about["derived"]["firstTouch"] + 4 * 8e-7 / 30, rel=1e-3)
    passed = one["time"] < until
    assert 0.2 < np.mean(passed) < 0.8
    errors = [np.abs(closure_history(history)[passed]).max() for history in (one, other)]
    assert 0 < errors[0] < 0.3 * errors[1]


def test_a_sphere_on_a_slanting_way_leaves_a_plate_as_the_closed_form_says(tmp_path):
    """Its normal motion is that of the theory at v cos(angle); its motion along a smooth plate stays."""
    given = "packing=bpca grains=1 target=wall impactAngle=60 velocity=40 sliding=0 rolling=0 twisting=0"
    completed(tmp_path, *given.split())
    found = outcome_of_run(open_run(tmp_path / "run"))
    theory = collide_pair(20.0, pair_constants(ICE, 1e-7, ICE, np.inf))
    assert found.kind == "bouncing" and found.restitution == pytest.approx(theory.restitution, rel=2e-3)
    assert found.restitution_tangential == pytest.approx(1.0, rel=1e-12)


def test_spins_are_in_the_energy_and_angular_momentum_is_kept(tmp_path):
    spins = ("spin=3e7", "spinAxis=x", "projectileSpin=-2e7", "projectileSpinAxis=y")
    hit = ("packing=bcca", "grains=40", "velocity=6", "impact=0.5", "threads=1", "duration=1.2e-7", "states=3")
    _, history = completed(tmp_path, *hit, *spins)
    run = open_run(tmp_path / "run")
    first, last = run.start, run.last
    mass, inertia = 4 / 3 * np.pi * 1e3 * first.radius**3, 8 / 15 * np.pi * 1e3 * first.radius**5

    def angular_momentum(state):
        orbital = mass[:, None] * np.cross(state.position, state.velocity)
        return (orbital + inertia[:, None] * state.angular_velocity).sum(axis=0)

    scale = np.linalg.norm(mass[:, None] * np.cross(first.position, first.velocity), axis=1).sum()
    assert angular_momentum(last) == pytest.approx(angular_momentum(first), abs=1e-10 * scale)
    wanted = 0.5 * (mass.sum() / 4) * 6**2
    for number, (axis, rate) in enumerate(((0, 3e7), (1, -2e7))):
        own = first.aggregate == number
        place = np.delete(first.position[own] - first.position[own].mean(axis=0), axis, axis=1)
        wanted += 0.5 * rate**2 * (mass[own] @ (place**2).sum(axis=1) + inertia[own].sum())
        assert np.all(first.angular_velocity[own][:, axis] == rate)
    assert history["kinetic"][0] == pytest.approx(wanted, rel=1e-9) and closure_history(history)[-1] < 1e-3


def test_a_single_grain_hits_an_aggregate(tmp_path):
    about, history = completed(tmp_path, "packing=bpca", "grains=60", "projectileGrains=1", "velocity=1", "threads=1")
    assert about["derived"]["projectileGrains"] == 1 and about["outcome"] == "sticking"
    assert about["derived"]["projectileCharacteristicRadius"] == 1e-7 and history["contacts_between"][-1] >= 1


def test_random_offsets_are_those_of_the_seed_and_as_often_as_collisions_have_them():
    drawn = [CollisionParameters.parse({"impact": "random", "seed": seed}).impact for seed in range(400)]
    assert drawn[7] == CollisionParameters.parse({"impact": "random", "seed": 7}).impact
    planar = CollisionParameters.parse({"impact": "random", "seed": 7, "planar": 1, "packing": "bcca"}).impact
    assert planar == pytest.approx(drawn[7] ** 2)  # uniform in a plane
    assert kstest(np.square(drawn), "uniform").pvalue > 0.01
