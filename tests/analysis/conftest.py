"""Run folders for the tests of the analysis: two grains from theory, and two small clusters."""

import pytest
from written_runs import pair_run, two_clusters


@pytest.fixture(scope="session")
def pair_folder(tmp_path_factory):
    """(path, impact velocity, PairCollision) of two grains that bounce."""
    path = tmp_path_factory.mktemp("pair") / "run"
    velocity, collision = pair_run(path)
    return path, velocity, collision


@pytest.fixture(scope="session")
def cluster_folder(tmp_path_factory):
    """Path of a run folder of two clusters of some fifty grains that stick."""
    return two_clusters(tmp_path_factory.mktemp("clusters") / "run")
