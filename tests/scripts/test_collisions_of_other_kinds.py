"""Collisions of BPCA aggregates (oblique, with drag, their early end), and impactStepFraction."""

import numpy as np
import pytest
from running import completed, read_arrays, read_json

from analysis.runs.folder import open_run
from analysis.runs.ledger import closure_history
from analysis.runs.measured import outcome_of_run

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
    assert outcome_of_run(open_run(tmp_path / "short" / "run")).kind == "never met"


RUN = ("radius=8", "velocity=30", "duration=400e-9", "threads=1", "stepFraction=0.2", "states=3")


@pytest.fixture(scope="module")
def shorter(tmp_path_factory):
    folder = tmp_path_factory.mktemp("shorter")
    completed(folder, *RUN, "impactStepFraction=0.06")
    return folder / "run"


def test_samples_stay_and_the_ledger_closes_better(shorter, tmp_path):
    about, one = read_json(shorter, "run.json"), read_arrays(shorter, "history.npz")
    longer, other = completed(tmp_path, *RUN)
    assert np.allclose(one["time"], other["time"], rtol=1e-12, atol=0)
    assert about["derived"]["steps"] == longer["derived"]["steps"]
    assert about["derived"]["stepChoice"].startswith("as given: 0.06 t0 until ")
    until = float(about["derived"]["stepChoice"].split()[5])
    assert until == pytest.approx(about["derived"]["firstTouch"] + 4 * 8e-7 / 30, rel=1e-3)
    passed = one["time"] < until
    assert 0.2 < np.mean(passed) < 0.8
    errors = [np.abs(closure_history(history)[passed]).max() for history in (one, other)]
    assert 0 < errors[0] < 0.3 * errors[1]
