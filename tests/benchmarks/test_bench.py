"""The bench works: everything measured once, as little as possible; what is not installed is said and left out."""

import json
import os
import subprocess
import sys
from pathlib import Path

import errors
import measured_scenes
import numpy as np
import peers
import pytest
import speed
from ratios import Speeds, Spread
from settings import FULL, TINY
from targets import Target

HERE = Path(__file__).resolve().parent


def bench(*arguments, **environment):
    return subprocess.run(
        [sys.executable, str(HERE / "bench.py"), *map(str, arguments)],
        capture_output=True,
        text=True,
        env={**os.environ, **environment},
        timeout=120,
    )


@pytest.fixture(scope="module")
def tiny(tmp_path_factory):
    """Folder of a run without the peers, which a machine may lack: the PATH has YADE only."""
    folder = tmp_path_factory.mktemp("bench")
    (folder / "bin").mkdir()
    (folder / "bin/yade").symlink_to("/usr/bin/yade")
    (folder / "bin/git").symlink_to("/usr/bin/git")
    done = bench("--tiny", "--out", folder / "out", PATH=str(folder / "bin"))
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout, folder / "out"


def test_measures_everything_and_says_what_it_goes_without(tiny):
    printed, folder = tiny
    for program in ("lmp", "liggghts"):
        assert f"{program} is not installed (make bench-peers installs it)" in printed
    found = json.loads((folder / "bench.json").read_text())
    measured = {(r["code"], r["kind"], r["threads"]) for r in found["speed"]["results"]}
    assert measured == {(code, "uniform", n) for code in ("engine", "functors", "stock") for n in (1, 2)} | {
        ("engine", kind, n) for kind in ("materials", "radii") for n in (1, 2)
    }
    assert all(result["rate"] > 0 for result in found["speed"]["results"])
    assert {r["instructions_used"] for r in found["speed"]["results"] if r["instructions"] == "portable"} == {
        "portable"
    }
    assert [len(collision["parts"]) for collision in found["collision"]] == [TINY.collision_parts]
    assert all((folder / name).stat().st_size > 10000 for name in ("bench-speed.png", "bench-error.png"))
    table = (folder / "bench.md").read_text()
    for what in (
        "/ LAMMPS, one core | at least 10 | - | not measured |",
        "two materials / like grains",
        "memory, bytes a contact",
        "through a collision",
        "Order of convergence",
    ):
        assert what.lower() in table.lower(), what


def test_half_a_time_unit_is_shown_as_refused(tiny):
    found = json.loads((tiny[1] / "bench.json").read_text())["error"]
    assert "must be > 0 and <= 0.4" in found["collision"]["0.5"][0]["refused"]
    assert found["pair"]["0.5"].startswith("JKRWadaEngine: the small step")
    assert len(found["pair"]["0.4"]) == TINY.gaps


def test_every_code_counts_the_same_contacts(tiny):
    found = json.loads((tiny[1] / "bench.json").read_text())["speed"]["results"]
    expected = measured_scenes.touching(measured_scenes.make("uniform", TINY.reference))
    for code in ("functors", "stock"):
        assert {r["contacts"] for r in found if r["code"] == code} == {expected}


@pytest.mark.parametrize("code", list(peers.PROGRAMS))
def test_peers_run_the_scene(code):
    """Where they are installed: all grains, and the contacts that this repository counts."""
    if reason := peers.missing(code):
        pytest.skip(reason)
    scene = measured_scenes.make("uniform", 5)
    found = peers.measure(code, scene, 20)
    assert (
        found["contacts"] == measured_scenes.touching(scene) and found["grains"] == scene.grains and found["rate"] > 1e5
    )


def test_a_peer_that_fails_is_noted_and_not_tried_again(tmp_path, monkeypatch):
    """A program of that name that only fails, as one does whose libraries are missing."""
    for name in ("lmp", "liggghts"):
        (tmp_path / name).write_text("#!/bin/sh\necho no such library >&2; exit 127\n")
        (tmp_path / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    task, failed = speed.peer(TINY, "liggghts", 1), {}
    scene = measured_scenes.make("uniform", TINY.reference)
    assert speed.take(task, {}, scene, failed) is None and "no such library" in failed["liggghts on 1"]
    (tmp_path / "liggghts").unlink()
    assert speed.take(task, {}, scene, failed) is None
    assert "pair_style granular" in peers.missing("lammps")


def test_two_sizes_start_at_rest():
    """Large and small grains of the rock salt, and large ones, overlap by the equilibrium overlap of their pair."""
    scene = measured_scenes.make("radii", 5)
    sizes = np.unique(scene.radius)
    assert len(sizes) == 2
    distance = np.linalg.norm(scene.position[:, None] - scene.position[None], axis=2)
    for first, second in ((sizes[1], sizes[1]), (sizes[0], sizes[1])):
        overlap = first + second - distance[(scene.radius[:, None] == first) & (scene.radius[None] == second)]
        touching = overlap[(overlap > 0) & (overlap < first)]  # the grain itself left out
        expected = measured_scenes.pair_constants(
            measured_scenes.ICE, first, measured_scenes.ICE, second
        ).equilibrium_overlap
        assert len(touching) > 50
        assert np.sort(touching)[len(touching) // 2] == pytest.approx(expected, rel=1e-6)


def test_ratios_are_taken_within_a_round():
    results = [
        {
            "code": code,
            "threads": 1,
            "radius": 40,
            "kind": "uniform",
            "instructions": "best" if code == "engine" else "",
            "rate": rate,
        }
        for round in ((20, 2), (30, 2), (40, 5))
        for code, rate in zip(("engine", "stock"), round)
    ]
    assert Speeds(results, 40).ratio({"code": "engine"}, {"code": "stock"}) == Spread(10, 8, 15)
    assert Speeds(results, 40).ratio({"code": "engine"}, {"code": "lammps"}) is None


@pytest.mark.parametrize(
    "found, verdict",
    [
        (Spread(28, 27, 29), "| **reached** |"),
        (Spread(28, 26, 29), "| reached by the median, not in every round |"),
        (Spread(26, 25, 28), "| not reached |"),
        (None, "| not measured |"),
    ],
)
def test_a_target_says_whether_it_is_reached(found, verdict):
    assert Target("x", 27, found).line().endswith(verdict)


def test_the_fitted_order():
    steps = np.array(FULL.error_steps[:-1])
    slope, wrong = errors.order(FULL, steps, 3e-3 * steps**2 * np.where(steps > FULL.fit[1], 10, 1))
    assert slope == pytest.approx(2) and wrong < 1e-6


def test_an_unknown_part_is_refused():
    done = bench("--only", "sped")
    assert done.returncode == 2 and "no part sped; must be of speed, collision, error" in done.stderr
