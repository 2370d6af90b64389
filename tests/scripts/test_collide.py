"""collide.py run for real: what a run folder holds, what is refused."""

import os

import numpy as np
import pytest
from running import PYTHON, TINY, TOP, call, collide, completed, messages, read_arrays, read_json, refusal, states

from analysis.runs.format import CHANNELS, COLLISION, FORMAT
from analysis.runs.status import verify_run
from yade_scripts.experiments.collision import CollisionParameters
from yade_scripts.materials import MATERIALS, equilibrium_overlap


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """The folder of a tiny collision, run once."""
    folder = tmp_path_factory.mktemp("collision")
    process = collide(folder, *TINY, "out=run")
    assert process.returncode == 0 and messages(process) == [], process.stdout + process.stderr
    assert process.stdout.rstrip().splitlines()[-1].startswith("run folder: run (completed, ")
    return folder / "run"


def test_run_folder_is_complete(run):
    assert sorted(os.listdir(run)) == ["checkpoint", "ended", "history.npz", "run.json", "states"]  # undecided so early
    assert verify_run(run)[0] == []
    about = read_json(run, "run.json")
    assert (about["format"], about["kind"], about["status"], about["seed"]) == (FORMAT, "collision", "completed", 1)
    assert list(about["parameters"]) == list(CollisionParameters.columns())
    assert set(about["versions"]) == {"yade", "python", "numpy", "contact_law"} and about["wallTime"] > 0
    assert {"timeUnit", "timeStep", "equilibriumOverlap", "aggregateRadius", "firstTouch"} < set(about["derived"])


def test_history_has_every_series(run):
    about, history = read_json(run, "run.json"), read_arrays(run, "history.npz")
    assert list(history) == [q.name for q in COLLISION.history if not q.optional or q.name in history]
    assert len({series.shape for series in history.values()}) == 1
    spacing = np.diff(history["time"])
    assert history["time"][0] == 0 and np.ptp(spacing) < 1e-9 * spacing[0] and len(spacing) >= 300
    end = about["derived"]["steps"] * about["derived"]["timeStep"]
    assert history["time"][-1] == pytest.approx(end, rel=1e-9)
    assert about["parameters"]["duration"] <= end < 1.01 * about["parameters"]["duration"]
    touch = history["time"][np.argmax(history["contacts_between"] > 0)]
    assert history["contacts_between"][0] == 0
    assert 0 <= touch - about["derived"]["firstTouch"] < 1.5 * spacing[0]
    assert np.all(history["contacts"] >= history["contacts_between"])
    formed, broken = history["formed"], history["broken"]  # series that only the fused engine has
    assert min(formed[-1], broken[-1]) > 0
    assert np.array_equal(formed - broken, history["contacts"] - history["contacts"][0])
    total = sum(history[channel] for channel in CHANNELS)
    assert np.abs(total - total[0]).max() < 1e-3 * history["kinetic"][0]
    assert history["connection"][-1] > 0


def test_states_agree_with_the_history(run):
    history = read_arrays(run, "history.npz")
    assert sorted(os.listdir(run / "states")) == [f"{number:06d}.npz" for number in range(22)]
    all_states = states(run)
    assert all_states[0]["time"] == 0 and all_states[-1]["time"] == history["time"][-1]
    for state in all_states:
        (row,) = np.flatnonzero(history["time"] == state["time"])
        for name in ("position", "velocity", "angular_velocity"):
            assert state[name].shape == (52, 3)
        assert np.array_equal(state["aggregate"], np.repeat([0, 1], 26)) and np.all(state["radius"] == 1e-7)
        contacts = len(state["contact_pairs"])
        assert contacts == history["contacts"][row]
        assert contacts == len(state["contact_normal_force"]) == len(state["contact_bonded"])
        sides = state["aggregate"][state["contact_pairs"]]
        assert np.count_nonzero(sides[:, 0] != sides[:, 1]) == history["contacts_between"][row]
        x, v = state["position"][:, 0], state["velocity"][:, 0]
        assert history["d"][row] == pytest.approx(8e-7 - x[x > 0].mean() + x[x <= 0].mean(), rel=1e-12)
        assert history["v"][row] == pytest.approx(v[x <= 0].mean() - v[x > 0].mean(), rel=1e-12)
        assert np.abs(state["velocity"].sum(axis=0)).max() < 1e-12 * np.abs(state["velocity"]).sum()


def test_starts_at_rest_within_each_aggregate(run):
    """Kinetic energy 2 (1/2) M (v/2)^2, no force in any contact, nothing stored or lost but in the normal."""
    about, start = read_json(run, "run.json"), states(run)[0]
    history = read_arrays(run, "history.npz")
    mass = about["derived"]["grainsPerAggregate"] * about["derived"]["grainMass"]
    velocity = about["parameters"]["velocity"]
    assert history["kinetic"][0] == pytest.approx(2 * 0.5 * mass * (velocity / 2) ** 2, rel=1e-12)
    assert np.abs(start["contact_normal_force"]).max() < 1e-9 * about["derived"]["pullOffForce"]
    assert about["derived"]["equilibriumOverlap"] == pytest.approx(equilibrium_overlap(MATERIALS["ice"]), rel=1e-12)
    assert not start["contact_bonded"].any()
    others = [history[channel][0] for channel in CHANNELS if channel not in ("kinetic", "normal")]
    assert np.abs(others).max() < 1e-12 * history["kinetic"][0]
    towards_each_other = np.outer(1 - 2 * start["aggregate"], (velocity / 2, 0, 0))
    assert np.allclose(start["velocity"], towards_each_other, rtol=0, atol=1e-9)
    assert np.all(start["position"][:26, 0] < 0) and np.all(start["position"][26:, 0] > 0)


def test_grown_aggregates_start_at_rest_unless_they_are_meant_as_made(tmp_path):
    """As made, some grains lie nearer to others than two radii, and pull: that drowns a small impact."""
    small = ("packing=bpca", "grains=1000", "projectileGrains=5", "velocity=2", "seed=2", "threads=1")
    small += ("endWhenApart=0", "duration=2e-7")
    about, history = completed(tmp_path / "rests", *small)
    as_made, other = completed(tmp_path / "moves", *small, "atRest=0")
    before = history["time"] < 0.99 * about["derived"]["firstTouch"]
    assert np.ptp(history["kinetic"][before]) < 1e-4 * history["kinetic"][0]
    assert 0 < about["derived"]["largestMotion"] < 0.02 * 1e-7 and "largestMotion" not in as_made["derived"]
    assert np.ptp(other["kinetic"][before]) > 0.05 * other["kinetic"][0]
    summary = call(tmp_path, PYTHON, "-m", "analysis", "summary", "rests/run", "moves/run", PYTHONPATH=TOP).stdout
    assert "moves/run: contacts released" in summary and "rests/run: contacts" not in summary


def test_slow_aggregates_meet_within_the_default_duration(tmp_path):
    """At 3 m/s the approach takes longer than the rest: the duration counts from the first touch. Fluffy aggregates
    move through each other in it, or come to rest before."""
    about, history = completed(tmp_path, "packing=bcca", "grains=64", "velocity=3")
    parameters, derived = about["parameters"], about["derived"]
    after = 12 * parameters["radius"] * 1e-7 / 3
    assert parameters["duration"] == pytest.approx(derived["firstTouch"] + after, rel=1e-12)
    met = history["time"][np.argmax(history["contacts_between"] > 0)]
    assert 0 <= met - derived["firstTouch"] < 1.5 * np.diff(history["time"])[0]
    assert 64.6 * parameters["radius"] * derived["timeUnit"] * 0.98 < history["time"][-1] - met < 1.02 * after
    assert parameters["filling"] == pytest.approx(parameters["grains"] / parameters["radius"] ** 3, rel=0.02)


@pytest.mark.parametrize(
    "arguments, message",
    [
        ("neck=0.2 stepFraction=0.2", "stepFraction = 0.2: unstable at this neck, filling and drag"),
        ("filling=0.1 radius=12", "aggregate 0 is in crumbs"),
        ("table=rows.table:3", "velocity = fast: not a finite number"),
        ("velocity 3", "argument 'velocity': not understood"),
        ("packing=file file=rows.table", "rows.table: not a packing"),
    ],
)
def test_what_yade_or_the_contact_refuses_gives_one_line_and_runs_nothing(tmp_path, arguments, message):
    (tmp_path / "rows.table").write_text("radius velocity\n4 10\n4 fast\n")
    assert refusal(collide(tmp_path, *arguments.split())).startswith(f"collide.py: {message}")
    assert os.listdir(tmp_path) == ["rows.table"]
