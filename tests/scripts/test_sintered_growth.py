"""The growth of aggregates by collisions, and one small table of S17's study from growth to report."""

import json
import os

import numpy as np
import pytest
from running import PYTHON, TOP, call, collide

from yade_scripts.packings import load
from yade_scripts.run import table
from yade_scripts.studies import sintered, sintered_growth
from yade_scripts.studies.sintered import Grown


@pytest.fixture
def small_growth(tmp_path, monkeypatch):
    """Aggregates of some 32 grains, grown in a temporary folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sintered_growth, "GRAINS", 32)
    monkeypatch.setattr(sintered_growth, "START", 16)
    os.makedirs(sintered.GROWN)


def test_a_growth_that_does_not_stick_says_so(tmp_path, monkeypatch):
    """Collisions that leave the halves apart, without running any."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sintered_growth, "_collide", lambda aggregate, grown, files, run: os.mkdir(run))
    monkeypatch.setattr(sintered_growth, "largest_piece_of_run", lambda run: load(run + "-0.npz"))
    with pytest.raises(sintered_growth.PackingError, match="512 grains did not stick at 50 m/s in 5 orientations"):
        sintered_growth.grow(Grown(50.0, 1))


def test_a_small_table_from_growth_to_report(small_growth, tmp_path):
    """Aggregates of 32 grains grown at 3 m/s, sintered, collided, and reported with the V_g that they grew at."""
    grown = Grown(3.0, 7)
    assert "contacts a grain" in sintered_growth.grow(grown)
    held = Grown(3.0, 7, limit="held")
    sintered_growth.grow(held)
    assert load(held.file(0)).parameters["limit"] == "held"
    packing = load(grown.file(0))
    assert 29 <= packing.grains <= 32 and np.all(packing.position[:, 2] == 0)
    assert packing.parameters["growthVelocity"] == 3.0 and packing.parameters["generations"] == 1
    cells = {**sintered.Point(0.7, "30", 3.0).row(7, "runs"), "duration": "2e-8", "states": 2}
    small = {**sintered.Point(0, "30").row(7, "runs"), "grains": 16, "duration": "2e-8", "states": 2}
    table.write("tiny.table", [cells, small])
    for line in (2, 3):
        done = collide(tmp_path, f"table=tiny.table:{line}")
        assert done.returncode == 0, done.stderr
    done = call(TOP, PYTHON, "-m", "analysis", "study", "sintered", str(tmp_path / "runs"), "--json")
    assert done.returncode == 0, done.stderr
    points = json.loads(done.stdout)["quantities"]["largest"]["rows"]
    assert [(p["growth_velocity"], p["neck"], p["pairs"]) for p in points] == [(0.0, 0.0, 1), (3.0, 0.7, 1)]
    with open("runs/b0.7-v30-vg3-s7/run.json") as file:
        assert json.load(file)["derived"]["projectilePacking"]["seed"] == 7
