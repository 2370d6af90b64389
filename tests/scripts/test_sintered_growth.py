"""The growth of aggregates by collisions, and one small table of S17's study from growth to report."""

import io
import json
import os

import numpy as np
import pandas
import pytest
from running import PYTHON, TOP, call, collide

from yade_scripts.packings import load
from yade_scripts.run import table
from yade_scripts.studies import sintered
from yade_scripts.studies.sintered import Point


@pytest.fixture
def small_growth(tmp_path, monkeypatch):
    """Aggregates of some 32 grains, grown in a temporary folder."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sintered, "START", 16)
    os.makedirs(sintered.GROWN)


def test_a_small_table_from_growth_to_report(small_growth, tmp_path):
    """Aggregates of 32 grains grown at 3 m/s, sintered, collided, and reported with the V_g that they grew at."""
    point, held = Point(0.7, "30", 3.0), Point(0.7, "30", 3.0, limit="held")
    assert "contacts a grain" in sintered.grow(point, 7)
    sintered.grow(held, 7)
    assert load(held.grown(7, 0)).parameters["limit"] == "held"
    packing = load(point.grown(7, 0))
    assert 29 <= packing.grains <= 32 and np.all(packing.position[:, 2] == 0)
    assert packing.parameters["growthVelocity"] == 3.0 and packing.parameters["generations"] == 1
    cells = {**point.row(7, "runs"), "duration": "2e-8", "states": 2}
    small = {**Point(0, "30").row(7, "runs"), "grains": 16, "duration": "2e-8", "states": 2}
    table.write("tiny.table", [cells, small])
    for line in (2, 3):
        done = collide(tmp_path, f"table=tiny.table:{line}")
        assert done.returncode == 0, done.stderr
    done = call(TOP, PYTHON, "-m", "analysis", "study", "sintered", str(tmp_path / "runs"), "--format", "csv")
    assert done.returncode == 0, done.stderr
    runs = pandas.read_csv(io.StringIO(done.stdout), comment="#").sort_values("neck")
    assert runs.growth_velocity.tolist() == [0, 3] and runs.neck.tolist() == [0, 0.7]
    with open("runs/b0.7-v30-vg3-s7/run.json") as file:
        assert json.load(file)["derived"]["projectilePacking"]["seed"] == 7
