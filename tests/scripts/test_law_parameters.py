"""The parameters `limit` and slidingStiffnessFactor of collide.py and compress.py: obeyed by both engines, in run.json."""

import numpy as np
import pytest
from running import collide, messages, read_arrays, read_json

from yade_scripts.experiments import collision, compression
from yade_scripts.materials import pair_constants
from yade_scripts.parameters import ParameterError

SHORT = ("radius=3", "velocity=30", "duration=12e-9", "threads=1", "seed=2", "stepFraction=0.05")


def history(folder, name, *arguments):
    done = collide(folder, *SHORT, *arguments, f"out={name}")
    assert done.returncode == 0 and messages(done) == [], done.stderr
    return read_arrays(folder / name, "history.npz"), read_json(folder / name, "run.json")["parameters"]


def test_engine_and_functors_obey_it_and_held_is_the_default(tmp_path):
    fused, rule = history(tmp_path, "fused", "limit=cut")
    functors, _ = history(tmp_path, "functors", "limit=cut", "engine=functors")
    held, default = history(tmp_path, "held")
    assert (rule["limit"], default["limit"]) == ("cut", "held")
    agree(fused, functors)
    assert fused["rollingDissipation"][-1] < 0.8 * held["rollingDissipation"][-1]


def test_engine_and_functors_obey_the_sliding_stiffness(tmp_path):
    fused, given = history(tmp_path, "fused", "slidingStiffnessFactor=2")
    functors, _ = history(tmp_path, "functors", "slidingStiffnessFactor=2", "engine=functors")
    usual, default = history(tmp_path, "usual")
    assert (given["slidingStiffnessFactor"], default["slidingStiffnessFactor"]) == (2, 1)
    agree(fused, functors)
    assert np.abs(fused["sliding"] - usual["sliding"]).max() > 1e-3 * fused["kinetic"][0]


def agree(fused, functors):
    for name in ("kinetic", "slidingDissipation", "rollingDissipation"):
        assert fused[name] == pytest.approx(functors[name], abs=1e-6 * fused["kinetic"][0]), name


@pytest.mark.parametrize("kind", [collision.KIND, compression.KIND])
def test_another_word_is_refused(kind):
    with pytest.raises(ParameterError, match="limit = slack: must be held or cut"):
        kind.parse({"limit": "slack"})


def test_a_step_for_a_tolerance_was_not_measured_for_compressions_with_cut():
    parameters = compression.KIND.parse({"limit": "cut", "stepFraction": "auto"})
    with pytest.raises(ParameterError, match="stepFraction = auto: not measured with limit = cut in a compression"):
        compression.complete(parameters, pair_constants(parameters), 1)
