"""The tables of S17's study, the growth of its aggregates, and one small table from growth to report."""

import json
import os
import subprocess

import numpy as np
import pytest
from running import COLLIDE, PYTHON, TOP, environment

from yade_scripts.packings import load
from yade_scripts.run import table
from yade_scripts.runner import rows
from yade_scripts.studies import sintered, sintered_growth
from yade_scripts.studies.sintered import Grown

STUDIES = os.path.join(TOP, "yade_scripts", "studies")


def parameters(size):
    found = rows.read(os.path.join(STUDIES, f"sintered-{size}.table"))
    assert not any(row.error for row in found)
    return {row.name: row.parameters for row in found}


def test_committed_tables_are_what_the_generator_writes(tmp_path):
    sintered.write_tables(tmp_path)
    for size in sintered.TABLES:
        name = f"sintered-{size}.table"
        with open(os.path.join(STUDIES, name)) as file:
            assert file.read() == (tmp_path / name).read_text(), f"{name}: run yade_scripts/studies/sintered.py"


def test_full_holds_the_papers_runs():
    """S17 section 4 and the captions of Figs 8 to 15, ten seeds each."""
    full = parameters("full")
    assert {p.limit for p in full.values()} == {"cut"} and {p.criticalRolling for p in full.values()} == {2e-10, 30e-10}
    bcca = [p for p in full.values() if p.packing == "bcca" and p.planar and not p.viscoelasticTime]
    assert {p.grains for p in bcca} == {1024}
    for velocity in (10.0, 30.0):
        for rolling in (2e-10, 30e-10):
            necks = {p.neck for p in bcca if p.velocity == velocity and p.criticalRolling == rolling}
            assert necks == {0, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}
    points = {name.rpartition("-s")[0] for name in full}
    assert len(full) == 10 * len(points)
    for growth in (1, 2, 3, 4, 5, 7.5, 10, 15, 20):
        assert f"b0.7-v{growth:g}-vg{growth:g}" in points


def test_desk_has_ten_seeds_of_what_the_paper_states():
    desk = parameters("desk")
    for point in (
        "b0-v50",
        "b0.7-v3.2",
        "b0.7-v10",
        "b0.7-v20",
        "b0.4-v30",
        "b0.5-v30",
        "b0.7-v3-vg3",
        "b0.7-v10-space",
    ):
        own = [desk[f"{point}-s{seed}"] for seed in range(1, 11)]
        assert len({(p.seed, p.file) for p in own}) == 10
    assert {(p.velocity > 10, p.duration) for p in desk.values()} == {(False, 24.4e-6), (True, 12.2e-6)}
    assert all(p.endWhenApart and p.slidingStiffnessFactor == 2 for p in desk.values())


def test_beyond_stands_beside_the_desks_runs():
    """Every row of beyond differs from a row of desk with the same seed in one thing alone."""
    beyond, desk = parameters("beyond"), parameters("desk")
    assert len(beyond) == 340 and not set(beyond) & set(desk)
    for name, p in beyond.items():
        changed = {"-space": not p.planar, "-held": p.limit == "held", "-x30": p.criticalRolling == 30e-10}
        (other,) = (ending for ending, is_so in changed.items() if is_so)
        assert name.replace(other, "") in desk
        if p.packing == "file":  # aggregates grow by the law that they collide with
            assert ("space" in p.file, "held" in p.file) == (not p.planar, p.limit == "held")
    core_hours = {size: sintered.core_hours(size) for size in sintered.TABLES}
    assert core_hours == pytest.approx({"desk": 9.9, "full": 38.6, "beyond": 6.7}, rel=0.02)  # those of STUDIES.md


def test_grown_files_are_those_that_the_rows_read():
    for size in sintered.TABLES:
        wanted = {p.file for p in parameters(size).values() if p.file}
        assert wanted == {grown.file(0) for grown in sintered.grown(size)}


def test_a_growth_that_does_not_stick_says_so(tmp_path, monkeypatch):
    """Collisions that leave the halves apart, without running any."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sintered_growth, "_collide", lambda aggregate, grown, files, run: os.mkdir(run))
    monkeypatch.setattr(sintered_growth, "largest_piece_of_run", lambda run: load(run + "-0.npz"))
    with pytest.raises(sintered_growth.PackingError, match="512 grains did not stick at 50 m/s in 5 orientations"):
        sintered_growth.grow(Grown(50.0, 1))


def test_aggregates_grow_in_space_too(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sintered_growth, "GRAINS", 32)
    monkeypatch.setattr(sintered_growth, "START", 16)
    os.makedirs(sintered.GROWN)
    grown = Grown(3.0, 7, planar=0)
    sintered_growth.grow(grown)
    packing = load(grown.file(0))
    assert 29 <= packing.grains <= 32 and np.ptp(packing.position[:, 2]) > 2e-7


def test_a_small_table_from_growth_to_report(tmp_path, monkeypatch):
    """Aggregates of 32 grains grown at 3 m/s, sintered, collided, and reported with the V_g that they grew at."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(sintered_growth, "GRAINS", 32)
    monkeypatch.setattr(sintered_growth, "START", 16)
    os.makedirs(sintered.GROWN)
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
        command = ["yade", "-n", "-x", COLLIDE, f"table=tiny.table:{line}"]
        done = subprocess.run(command, capture_output=True, text=True, env=environment(), timeout=120)
        assert done.returncode == 0, done.stderr
    done = subprocess.run(
        [PYTHON, "-m", "analysis", "study", "sintered", str(tmp_path / "runs"), "--json"],
        capture_output=True,
        text=True,
        cwd=TOP,
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    points = json.loads(done.stdout)["quantities"]["largest"]["rows"]
    assert [(p["growth_velocity"], p["neck"], p["pairs"]) for p in points] == [(0.0, 0.0, 1), (3.0, 0.7, 1)]
    with open("runs/b0.7-v30-vg3-s7/run.json") as file:
        assert json.load(file)["derived"]["projectilePacking"]["seed"] == 7
