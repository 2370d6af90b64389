"""yade_scripts/compress.py as a user runs it: K13's cell, its pressure and ledger, its ends, stretching, wrong parameters."""

import os
import signal
import subprocess
import time

import numpy as np
import pytest
from running import TOP, environment, messages, read_arrays, read_json

from analysis.runs.format import CHANNELS
from yade_scripts.experiments.compression import KIND, typical_first_filling

COMPRESS = os.path.join(TOP, "yade_scripts", "compress.py")
SMALL = ("grains=64", "strainRate=1e-4", "stepFraction=0.2", "threads=1")


def compress(folder, *arguments):
    return subprocess.run(
        ["yade", "-n", "-x", COMPRESS, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        env=environment(),
        timeout=120,
    )


def completed(folder, *arguments):
    """(run.json, history) of a run that came to its end."""
    done = compress(folder, *arguments, "out=run")
    assert done.returncode == 0 and messages(done) == [], done.stderr
    return read_json(folder, "run", "run.json"), read_arrays(folder, "run", "history.npz")


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("compress")
    return folder / "run", *completed(folder, "grains=128", "strainRate=3e-5", "threads=1")


def volume(history):
    return np.prod([history[f"edge_{axis}"] for axis in "xyz"], axis=0)


def test_the_cell_follows_k13(run):
    """Eq 7 at every sample, and exactly what YADE's cell does with a constant gradient; eq 12 at the start; eq 22."""
    folder, about, history = run
    rate = 2 * 3e-5 / about["derived"]["timeUnit"]
    edge, step = history["edge_x"], np.diff(history["time"])[0]
    assert edge == pytest.approx(edge[0] * np.exp(-rate * history["time"]), rel=3e-3)
    assert edge == pytest.approx(edge[0] * (1 - rate * step) ** np.arange(len(edge)), rel=1e-9)
    assert np.array_equal(history["edge_y"], edge) and np.array_equal(history["edge_z"], edge)
    start = read_arrays(folder, "states", "000000.npz")
    assert start["velocity"] == pytest.approx(-rate * start["position"], rel=1e-9, abs=1e-12)
    assert history["filling"] == pytest.approx(128 * 4 / 3 * np.pi * 1e-21 / edge**3, rel=1e-12)
    spread = np.ptp(start["position"], axis=0).max()
    assert edge[0] == pytest.approx(spread + 2.1e-7, rel=1e-9)


def test_it_ends_where_it_should(run):
    _, about, history = run
    assert about["outcome"] == "completed" and about["kind"] == "compression"
    assert 0.5 <= history["filling"][-1] < 0.502 and history["filling"][-2] < 0.5
    assert about["parameters"]["initialFilling"] == pytest.approx(history["filling"][0])
    assert history["coordination"] == pytest.approx(2 * history["contacts"] / 128)
    assert 127 <= history["contacts"][0] <= 130 and history["coordination"][-1] > 4


def test_the_ledger_closes_with_the_work_of_the_boundaries(run):
    _, _, history = run
    total = sum(history[name] for name in CHANNELS)
    work = -history["boundaryWork"][-1]
    assert history["rollingDissipation"][-1] > 0.05 * work
    assert np.abs(total - total[0]).max() < 3e-5 * work


def test_pressure_is_the_work_per_volume(run):
    """The virial of the samples, integrated over the volume, against what the boundaries did (K13 eq 21 against a ledger that
    knows no virial), over each factor of 1.5 in the filling factor."""
    _, _, history = run
    size, found = volume(history), []
    for low in 0.1 * 1.5 ** np.arange(4):
        part = np.flatnonzero((history["filling"] >= low) & (history["filling"] <= 1.5 * low))
        virial = np.trapz(history["pressure"][part], size[part])
        found.append(virial / (history["boundaryWork"][part[-1]] - history["boundaryWork"][part[0]]))
    assert found == pytest.approx(np.ones(4), abs=0.06)


def test_states_have_the_cell(run):
    folder, about, history = run
    names = sorted(os.listdir(folder / "states"))
    assert 59 <= len(names) <= 61
    last = read_arrays(folder, "states", names[-1])
    assert last["time"] == history["time"][-1]
    assert last["cell_size"] == pytest.approx(3 * [history["edge_x"][-1]], rel=1e-12)
    assert len(last["contact_pairs"]) == history["contacts"][-1]


def test_it_ends_at_a_pressure(tmp_path):
    """Averaged over 1000 t0, and long before the largest filling."""
    about, history = completed(tmp_path, *SMALL, "finalPressure=2e3")
    recent = history["time"] >= history["time"][-1] - 1000 * about["derived"]["timeUnit"]
    assert history["pressure"][recent].mean() >= 2e3
    assert 0.05 < history["filling"][-1] < 0.4
    assert about["parameters"]["finalFilling"] == pytest.approx(0.65, abs=0.005)


def test_a_cell_that_is_looser_than_stretching_would_leave_it(tmp_path):
    done = compress(tmp_path, *SMALL, "finalPressure=2e3", "stretch=x", "stretchFilling=0.4", "out=run")
    last = read_arrays(tmp_path, "run", "history.npz")["filling"][-1]
    said = f"compress.py: stretchFilling = 0.4: the pressure was reached at a filling of {last:.3g}; the cell is not stretched"
    assert done.returncode == 0 and messages(done) == [said]
    assert last < 0.4 and read_json(tmp_path, "run", "run.json")["outcome"] == "completed"


@pytest.mark.parametrize("axes, grows", [("x", (True, False, False)), ("xyz", (True, True, True))])
def test_stretching(tmp_path, axes, grows):
    """The same cell afterwards: to 0.3 of the largest filling, under tension, with a ledger that closes."""
    _, history = completed(tmp_path, *SMALL, "finalFilling=0.3", f"stretch={axes}")
    turn = int(np.argmax(history["filling"]))
    assert 0.3 <= history["filling"][turn] < 0.31 and 0.085 < history["filling"][-1] <= 0.3 * history["filling"][turn]
    edges = [history[f"edge_{axis}"][-1] / history[f"edge_{axis}"][turn] for axis in "xyz"]
    assert [edge > 1.05 for edge in edges] == list(grows)
    assert all(abs(edge - 1) < 1e-9 for edge, grown in zip(edges, grows) if not grown)
    size = volume(history)
    work, size = history["boundaryWork"][turn:], size[turn:]
    assert work[-1] < work[0]  # grains pulled the boundaries back
    total = sum(history[name] for name in CHANNELS)
    assert np.abs(total - total[0]).max() < 1e-3 * -history["boundaryWork"].min()


def test_a_killed_run_resumes_to_the_same_bits(tmp_path):
    """Killed while it is compressed or stretched, with an end that follows from the history."""
    command = [
        "yade",
        "-n",
        "-x",
        COMPRESS,
        "grains=64",
        "strainRate=2e-5",
        "threads=1",
        "finalFilling=0.2",
        "stretch=x",
    ]
    options = dict(cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment())
    killed = subprocess.Popen([*command, "checkpointInterval=0.01", "out=killed"], **options)
    saved, deadline = tmp_path / "killed" / "checkpoint" / "recorder.npz", time.monotonic() + 60
    while not saved.exists() and killed.poll() is None and time.monotonic() < deadline:
        time.sleep(0.002)
    time.sleep(0.5)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    assert saved.exists() and not (tmp_path / "killed" / "ended").exists()
    assert subprocess.run([*command, "out=killed", "resume=1"], **options).returncode == 0
    assert subprocess.run([*command, "out=straight"], **options).returncode == 0
    one, other = (read_arrays(tmp_path, name, "history.npz") for name in ("killed", "straight"))
    assert all(one[name].tobytes() == other[name].tobytes() for name in other)
    states = [sorted(os.listdir(tmp_path / name / "states")) for name in ("killed", "straight")]
    assert states[0] == states[1]


def test_functors_give_the_same_pressure(tmp_path):
    """YADE's own loop on the same cell: the same curve while the first contacts form."""
    about, fused = completed(tmp_path, *SMALL, "finalFilling=0.05")
    (tmp_path / "other").mkdir()
    _, functors = completed(tmp_path / "other", *SMALL, "finalFilling=0.05", "engine=functors")
    n = min(len(fused["time"]), len(functors["time"])) // 4
    assert functors["edge_x"][:n] == pytest.approx(fused["edge_x"][:n], rel=5e-3)
    assert functors["filling"][-1] == pytest.approx(fused["filling"][-1], rel=0.05)
    assert functors["contacts"][0] == fused["contacts"][0] == 63


@pytest.mark.parametrize(
    "argument, message",
    [
        ("finalFilling=0.7", "finalFilling = 0.7: beyond random close packing; must be at most 0.650 for these grains"),
        (
            "finalFilling=1.37",
            "finalFilling = 1.37: beyond random close packing; must be at most 0.650 for these grains",
        ),
        ("finalFilling=1e-5", "finalFilling = 1e-05: must be above the 0.008166 of the start"),
        (
            "grains=20",
            "grains = 20: the cell would be too small at a filling of 0.5; must be at least 22, or finalFilling at most 0.452",
        ),
        ("stretchFilling=0.1", "stretchFilling = 0.1: given with stretch = no; must be left out"),
        (
            "stepFraction=0.4",
            "stepFraction = 0.4: unstable at this final filling and damping; must be at most 0.368 [t0]",
        ),
        (
            "stepFraction=auto finalPressure=1e4",
            "stepFraction = auto: not measured with finalPressure, which may end a run at any filling",
        ),
        ("strainRate=0", "strainRate = 0: must be > 0 and <= 0.001 [1/t0]"),
        ("packing=cpe", "packing = cpe: must be bcca"),
        ("velocity=3", "velocity: unknown parameter; must be one of grains"),
    ],
)
def test_wrong_parameters_give_one_line(tmp_path, argument, message):
    refused = compress(
        tmp_path, *(text for text in SMALL if text.split("=")[0] != argument.split("=")[0]), *argument.split()
    )
    assert refused.returncode == 2 and len(messages(refused)) == 1
    assert messages(refused)[0].startswith(f"compress.py: {message}")
    assert os.listdir(tmp_path) == []


def test_a_cluster_may_not_touch_its_images(tmp_path):
    refused = compress(tmp_path, *SMALL, "initialFilling=0.2")
    assert refused.returncode == 2 and len(messages(refused)) == 1
    assert "initialFilling = 0.2: " in messages(refused)[0] and "touch across the boundaries" in messages(refused)[0]
    about, _ = completed(tmp_path, *SMALL, "initialFilling=0.01", "finalFilling=0.011")
    assert about["parameters"]["initialFilling"] == pytest.approx(0.01)


def test_the_estimate_is_near_what_a_run_takes(run):
    _, about, history = run
    parameters = KIND.parse({"grains": 128, "strainRate": 3e-5})
    estimate = KIND.estimate(parameters)
    assert estimate.grains == 128
    steps = history["time"][-1] / about["derived"]["timeStep"]
    assert estimate.steps == pytest.approx(steps, rel=0.25)
    assert estimate.contacts == pytest.approx(history["contacts"].mean(), rel=0.25)
    assert typical_first_filling(16384) == pytest.approx(5.5e-4, rel=0.2)


def test_an_ended_run_is_known_by_its_table(run):
    """What the parameters leave open follows from the run: a row of a table finds its ended run."""
    from yade_scripts.run.agreement import difference

    _, about, _ = run
    wanted = {"grains": 128, "strainRate": 3e-5}
    assert difference(KIND, KIND.parse(wanted), about) is None
    assert difference(KIND, KIND.parse({**wanted, "finalFilling": 0.4}), about).startswith(
        "finalFilling = 0.5, not 0.4"
    )
    assert difference(KIND, KIND.parse({**wanted, "linearDamping": 0}), about).startswith("linearDamping = 0.01, not 0")
