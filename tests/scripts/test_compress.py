"""yade_scripts/compress.py as a user runs it: K13's cell, its pressure and ledger, its ends, stretching, wrong
parameters."""

import os
from functools import partial

import numpy as np
import pytest
from running import COMPRESS, completed, forked, messages, read_arrays, read_json, refusal, states
from scipy.integrate import trapezoid

from analysis.runs.format import CHANNELS
from yade_scripts.experiments.compression import KIND, typical_first_filling

SMALL = ("grains=64", "strainRate=1e-4", "stepFraction=0.2", "threads=1")
completed = partial(completed, script=COMPRESS)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("compress")
    return folder / "run", *completed(folder, "grains=128", "strainRate=3e-5", "threads=1")


def volume(history):
    return np.prod([history[f"edge_{axis}"] for axis in "xyz"], axis=0)


def worst_closure(history):
    total = sum(history[name] for name in CHANNELS)
    return np.abs(total - total[0]).max() / np.abs(history["boundaryWork"]).max()


def test_the_cell_follows_k13(run):
    """Eq 7 at every sample, and exactly what YADE's cell does with a constant gradient; eq 12 at the start; eq 22."""
    folder, about, history = run
    rate = 2 * 3e-5 / about["derived"]["timeUnit"]
    edge, step = history["edge_x"], np.diff(history["time"])[0]
    assert edge == pytest.approx(edge[0] * np.exp(-rate * history["time"]), rel=3e-3)
    assert edge == pytest.approx(edge[0] * (1 - rate * step) ** np.arange(len(edge)), rel=1e-9)
    assert np.array_equal(history["edge_y"], edge) and np.array_equal(history["edge_z"], edge)
    start = states(folder)[0]
    assert start["velocity"] == pytest.approx(-rate * start["position"], rel=1e-9, abs=1e-12)
    assert history["filling"] == pytest.approx(128 * 4 / 3 * np.pi * 1e-21 / edge**3, rel=1e-12)
    spread = np.ptp(start["position"], axis=0).max()
    assert edge[0] == pytest.approx(spread + 2.1e-7, rel=1e-9)


def test_it_ends_where_it_should_and_the_ledger_closes(run):
    _, about, history = run
    assert about["status"] == "completed" and about["kind"] == "compression"
    assert 0.5 <= history["filling"][-1] < 0.502 and history["filling"][-2] < 0.5
    assert about["parameters"]["initialFilling"] == pytest.approx(history["filling"][0])
    assert history["coordination"] == pytest.approx(2 * history["contacts"] / 128)
    assert 127 <= history["contacts"][0] <= 130 and history["coordination"][-1] > 4
    assert history["rollingDissipation"][-1] > 0.05 * -history["boundaryWork"][-1]
    assert worst_closure(history) < 3e-5


def test_pressure_is_the_work_per_volume(run):
    """The virial of the samples, integrated over the volume, against what the boundaries did (K13 eq 21 against a
    ledger that knows no virial), over each factor of 1.5 in the filling factor."""
    _, _, history = run
    size, found = volume(history), []
    for low in 0.1 * 1.5 ** np.arange(4):
        part = np.flatnonzero((history["filling"] >= low) & (history["filling"] <= 1.5 * low))
        virial = trapezoid(history["pressure"][part], size[part])
        found.append(virial / (history["boundaryWork"][part[-1]] - history["boundaryWork"][part[0]]))
    assert found == pytest.approx(np.ones(4), abs=0.06)


def test_it_ends_at_a_pressure(tmp_path):
    """By the work over the volume in 1000 t0, not before, and long before the largest filling; a cell that is looser
    than stretching would leave it stays."""
    done = forked(tmp_path, COMPRESS, *SMALL, "finalPressure=2e3", "stretch=x", "stretchFilling=0.4", "out=run")
    about, history = read_json(tmp_path, "run", "run.json"), read_arrays(tmp_path, "run", "history.npz")
    work, size, last = history["boundaryWork"], volume(history), history["filling"][-1]
    window = int(1000 * about["derived"]["timeUnit"] / np.diff(history["time"])[0] * (1 + 1e-9))
    before, reached = ((work[k] - work[k - window]) / (size[k] - size[k - window]) for k in (-2, -1))
    assert before < 2e3 <= reached < 2.1e3 and 0.05 < last < 0.4
    assert f"\nended by finalPressure, at a filling of {last:.3g}" in done.stdout
    assert about["parameters"]["finalFilling"] == pytest.approx(0.65, abs=0.005)
    (message,) = messages(done)
    assert done.returncode == 0 and "the cell is not stretched" in message and about["status"] == "completed"


def test_stretching_along_an_axis(tmp_path):
    """The same cell afterwards: to 0.3 of the largest filling, under tension, with a ledger that closes."""
    _, history = completed(tmp_path, *SMALL, "finalFilling=0.3", "stretch=x")
    turn = int(np.argmax(history["filling"]))
    assert 0.3 <= history["filling"][turn] < 0.31 and 0.085 < history["filling"][-1] <= 0.3 * history["filling"][turn]
    edges = [history[f"edge_{axis}"][-1] / history[f"edge_{axis}"][turn] for axis in "xyz"]
    assert edges[0] > 1.05 and edges[1:] == pytest.approx([1, 1], abs=1e-9)
    assert history["boundaryWork"][-1] < history["boundaryWork"][turn]  # grains pulled the boundaries back
    assert worst_closure(history) < 1e-3


def test_a_piston_between_plates(tmp_path):
    """Its distance follows eq 7; both plates feel the same pressure, which is the piston's work per volume; the ledger
    closes to the tolerance."""
    given = "boundary=walls grains=300 strainRate=1e-4 finalFilling=0.4 threads=1 stepFraction=auto"
    about, history = completed(tmp_path, *given.split())
    derived, height = about["derived"], history["edge_z"]
    relative = np.exp(-2e-4 * history["time"] / derived["timeUnit"])
    assert height == pytest.approx(derived["initialHeight"] * relative, rel=3e-3)
    assert np.ptp(history["edge_x"]) == 0 and history["edge_x"][0] == derived["initialEdge"]
    assert history["filling"] == pytest.approx(300 * 4 / 3 * np.pi * 1e-21 / volume(history), rel=1e-9)
    assert 0.1 < history["filling"][0] < 0.15 and 0.4 <= history["filling"][-1] < 0.401
    late = history["filling"] > 0.25
    assert history["piston_pressure"][late].mean() == pytest.approx(history["pressure"][late].mean(), rel=0.03)
    size, work = volume(history)[late], history["constraintWork"][late]
    assert trapezoid(history["pressure"][late], size) == pytest.approx(work[-1] - work[0], rel=0.06)
    total = sum(history[name] for name in CHANNELS)
    assert np.abs(total - total[0]).max() < 1e-4 * -work[-1]
    last = states(tmp_path / "run")[-1]
    assert last["plane_position"] == pytest.approx([0, height[-1]], rel=1e-9) and len(last["plane_contacts"]) > 10


@pytest.mark.parametrize(
    "arguments, message",
    [
        ("finalFilling=0.7", "finalFilling = 0.7: beyond random close packing; must be at most 0.650"),
        ("initialFilling=0.2", "initialFilling = 0.2: "),  # the cluster would touch its images
        ("boundary=walls material=ice,silicate materialFraction=0.3", "material = ice,silicate: given with boundary"),
        ("stepFraction=0.4", "stepFraction = 0.4: unstable at this final filling and damping"),
    ],
)
def test_wrong_parameters_give_one_line(tmp_path, arguments, message):
    others = [text for text in SMALL if text.split("=")[0] != arguments.split("=")[0]]
    assert refusal(forked(tmp_path, COMPRESS, *others, *arguments.split())).startswith(f"compress.py: {message}")
    assert os.listdir(tmp_path) == []


def test_the_estimate_is_near_what_a_run_takes(run):
    _, about, history = run
    estimate = KIND.estimate(KIND.parse({"grains": 128, "strainRate": 3e-5}))
    assert estimate.grains == 128
    steps = history["time"][-1] / about["derived"]["timeStep"]
    assert estimate.steps == pytest.approx(steps, rel=0.25)
    assert estimate.contacts == pytest.approx(history["contacts"].mean(), rel=0.25)
    assert typical_first_filling(16384) == pytest.approx(5.5e-4, rel=0.2)
