"""The parameters `limit` and slidingStiffnessFactor of collide.py and compress.py: obeyed by both engines, in run.json."""

import numpy as np
import pytest
from running import completed

from yade_scripts.experiments import compression
from yade_scripts.parameters import ParameterError

SHORT = ("radius=3", "velocity=30", "duration=12e-9", "threads=1", "seed=2", "stepFraction=0.05")


@pytest.mark.parametrize("name, given, default", [("limit", "cut", "held"), ("slidingStiffnessFactor", 2, 1)])
def test_engine_and_functors_obey_it(tmp_path, name, given, default):
    runs = {}
    for how in ("fused", "functors", "usual"):
        (tmp_path / how).mkdir()
        law = [] if how == "usual" else [f"{name}={given}", f"engine={how}"]
        about, runs[how] = completed(tmp_path / how, *SHORT, *law)
        assert about["parameters"][name] == (default if how == "usual" else given)
    fused, functors, usual = runs.values()
    for channel in ("kinetic", "slidingDissipation", "rollingDissipation"):
        assert fused[channel] == pytest.approx(functors[channel], abs=1e-6 * fused["kinetic"][0]), channel
    if name == "limit":
        assert fused["rollingDissipation"][-1] < 0.8 * usual["rollingDissipation"][-1]
    else:
        assert np.abs(fused["sliding"] - usual["sliding"]).max() > 1e-3 * fused["kinetic"][0]


def test_compressions_know_the_rules_by_the_same_names():
    with pytest.raises(ParameterError, match="limit = slack: must be held or cut"):
        compression.KIND.parse({"limit": "slack"})
