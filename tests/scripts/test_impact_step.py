"""impactStepFraction: a shorter step while the aggregates fly through each other."""

import signal

import numpy as np
import pytest
from running import collide, collided, messages, read_arrays, read_json
from test_checkpoint import OFTEN, arrays, same_bits, stop_midway

from analysis.measures.ledger import closure_history
from analysis.runs.folder import open_run
from analysis.runs.provenance import provenance
from yade_scripts.experiments.collision import KIND, CollisionParameters
from yade_scripts.parameters import ParameterError

RUN = ("radius=8", "velocity=30", "duration=400e-9", "threads=1", "stepFraction=0.2", "states=3")
SHORTER = (*RUN, "impactStepFraction=0.06", "out=run")


@pytest.fixture(scope="module")
def shorter(tmp_path_factory):
    folder = tmp_path_factory.mktemp("shorter")
    assert "step: as given: 0.06 t0 until 1." in collided(folder, *SHORTER).stdout
    return folder / "run"


def test_samples_stay_and_the_ledger_closes_better(shorter, tmp_path):
    collided(tmp_path, *RUN, "out=run")
    about, longer = read_json(shorter, "run.json"), tmp_path / "run"
    one, other = read_arrays(shorter, "history.npz"), read_arrays(longer, "history.npz")
    assert np.allclose(one["time"], other["time"], rtol=1e-12, atol=0)
    assert about["derived"]["steps"] == read_json(longer, "run.json")["derived"]["steps"]
    until = float(about["derived"]["stepChoice"].split()[5])
    assert until == pytest.approx(about["derived"]["firstTouch"] + 4 * 8e-7 / 30, rel=1e-3)
    passed = one["time"] < until
    assert 0.2 < np.mean(passed) < 0.8
    errors = [np.abs(closure_history(history)[passed]).max() for history in (one, other)]
    assert 0 < errors[0] < 0.3 * errors[1]


def test_a_stopped_run_resumes_to_the_same_bits(shorter, tmp_path):
    assert stop_midway(tmp_path, [*SHORTER, OFTEN], signal.SIGTERM).returncode == 143
    collided(tmp_path, *SHORTER, "resume=1")
    assert same_bits(arrays(tmp_path / "run"), arrays(shorter))


def test_together_with_an_early_end(tmp_path):
    run = (
        "packing=bpca",
        "grains=40",
        "velocity=40",
        "threads=1",
        "impact=0.6",
        "duration=6e-7",
        "viscoelasticTime=6e-12",
    )
    collided(tmp_path, *run, "stepFraction=0.2", "impactStepFraction=0.1", "endWhenApart=1", "seed=3", "out=run")
    assert read_json(tmp_path, "run", "run.json")["timeReached"] < 5e-7


@pytest.mark.parametrize(
    "given, words",
    [
        ({"stepFraction": "0.1", "impactStepFraction": "0.1"}, "given with stepFraction = 0.1; must be below it"),
        ({"stepFraction": "0.1", "impactStepFraction": "1e-9"}, "must be below it and at least a hundredth of it"),
        ({"stepFraction": "auto", "impactStepFraction": "0.1"}, "given with stepFraction = auto; must be left out"),
        ({"engine": "functors", "impactStepFraction": "0.01"}, "given with engine = functors; must be left out"),
        ({"impactStepFraction": "0"}, "impactStepFraction = 0: must be > 0 [t0]"),
    ],
)
def test_what_does_not_go_together_is_refused(given, words):
    with pytest.raises(ParameterError, match="impactStepFraction") as refused:
        CollisionParameters.parse(given)
    assert words in str(refused.value)


@pytest.mark.parametrize("times", [0.2, 1])
@pytest.mark.parametrize("packing", [{"radius": "20"}, {"packing": "bpca", "grains": "5000"}])
def test_estimates_count_the_shorter_steps(packing, times):
    """In a run of no more than the time until the touch and four radii, as many as the ratio of the steps."""
    usual = KIND.parse({**packing, "velocity": "30", "stepFraction": "0.2"})
    radius = usual.radius or 2.6 * 5000 ** (1 / 2.97)
    duration = {"duration": f"{times * 4 * radius * 1e-7 / 30}"}
    both = [
        KIND.estimate(KIND.parse({**packing, **duration, "velocity": "30", "stepFraction": "0.2", **more}))
        for more in ({}, {"impactStepFraction": "0.05"})
    ]
    assert both[1].steps == pytest.approx(4 * both[0].steps, rel=1e-6) and both[1].contacts == both[0].contacts


def test_messages_are_one_line(tmp_path):
    refused = collide(tmp_path, *RUN, "impactStepFraction=0.3")
    assert refused.returncode == 2
    assert messages(refused) == [
        "collide.py: impactStepFraction = 0.3: given with stepFraction = 0.2; must be below it and at least a hundredth of it"
    ]


def test_tables_of_runs_tell_both_steps(shorter):
    assert provenance([open_run(shorter)])["stepFractions"] == {"0.2 (impact: 0.06)": 1}
