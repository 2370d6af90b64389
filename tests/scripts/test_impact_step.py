"""impactStepFraction: a shorter step while the aggregates fly through each other."""

import numpy as np
import pytest
from running import completed, read_arrays, read_json

from analysis.measures.ledger import closure_history
from analysis.runs.folder import open_run
from analysis.runs.provenance import provenance
from yade_scripts.experiments.collision import KIND

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


def test_together_with_an_early_end(tmp_path):
    run = "packing=bpca grains=40 velocity=40 threads=1 impact=0.6 duration=6e-7 viscoelasticTime=6e-12 seed=3"
    about, _ = completed(tmp_path, *run.split(), "stepFraction=0.2", "impactStepFraction=0.1", "endWhenApart=1")
    assert about["timeReached"] < 5e-7


@pytest.mark.parametrize("times", [0.2, 1])
@pytest.mark.parametrize("packing", [{"radius": "20"}, {"packing": "bpca", "grains": "5000"}])
def test_estimates_count_the_shorter_steps(packing, times):
    """In a run of no more than the time until the touch and four radii, as many as the ratio of the steps."""
    usual = {**packing, "velocity": "30", "stepFraction": "0.2"}
    radius = KIND.parse(usual).radius or 2.6 * 5000 ** (1 / 2.97)
    usual["duration"] = f"{times * 4 * radius * 1e-7 / 30}"
    longer, shorter = (KIND.estimate(KIND.parse({**usual, **more})) for more in ({}, {"impactStepFraction": "0.05"}))
    assert shorter.steps == pytest.approx(4 * longer.steps, rel=1e-6) and shorter.contacts == longer.contacts


def test_tables_of_runs_tell_both_steps(shorter):
    assert provenance([open_run(shorter)])["stepFractions"] == {"0.2 (impact: 0.06)": 1}
