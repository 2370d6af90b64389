"""Another kind of run, as one script of a user: it is run, recorded, resumed and studied without a change elsewhere."""

import os
import signal
import subprocess
import time

import numpy as np
import pytest
from running import PYTHON, TOP, environment, messages, read_arrays, read_json

from analysis import open_run
from analysis.runs.format import CHANNELS
from yade_scripts.run.kind import NoKind, kind_of

# 27 grains on a cubic lattice in a periodic cell that shrinks: the boundaries do many times the work that the contacts
# held at the start.
SCRIPT = f"""
import sys
sys.path.insert(0, {TOP!r})
from dataclasses import dataclass
import numpy as np
from analysis.runs.format import Quantity, RunKind
from yade_scripts import packings
from yade_scripts.materials import GrainParameters, pair_constants
from yade_scripts.parameters import POSITIVE, parameter
from yade_scripts.run import script
from yade_scripts.run.kind import Estimate, Kind, Scene
from yade_scripts.run.parameters import RunParameters


@dataclass(frozen=True)
class ShrinkParameters(GrainParameters, RunParameters):
    '''The cell.'''

    rate: float = parameter(3e-4, POSITIVE, "rate at which each edge shrinks", "1/t0")
    duration: float = parameter(20e-9, POSITIVE, "time that is simulated", "s")

    def title(self):
        return f"shrink-{{self.material}}-{{self.rate:g}}", ("material", "rate")


def prepare(parameters, threads):
    from yade.minieigenHP import Matrix3
    from yade.wrapper import Omega
    from yade_scripts.run import scene as yade_scene

    constants = yade_scene.pair_constants(parameters)
    parameters = parameters.with_threads(threads)
    spacing = 2 * parameters.grainRadius - constants["equilibriumOverlap"]
    sites = spacing * (np.stack(np.meshgrid(*3 * [np.arange(3)]), axis=-1).reshape(-1, 3) + 0.5)
    packing = packings.Packing(sites, np.full(27, parameters.grainRadius), 0)

    def build():
        omega = Omega()
        omega.periodic = True
        omega.cell.setBox(3 * spacing, 3 * spacing, 3 * spacing)
        omega.cell.homoDeform = 0
        omega.cell.velGrad = Matrix3.Identity * -(parameters.rate / constants["timeUnit"])
        yade_scene.add_bodies([packing], [(0, 0, 0)], yade_scene.material_of(parameters))

    def series(state):
        return {{"filling": 27 * 4 / 3 * np.pi * parameters.grainRadius**3 / np.prod(state["cell_size"])}}

    return Scene(parameters, constants, {{"spacing": spacing}}, np.zeros(27, int), build, series)


def estimate(parameters):
    steps = parameters.duration / pair_constants(parameters)["timeUnit"] / parameters.stepFraction
    return Estimate(27, 81, steps)


KIND = Kind(
    RunKind("shrink", (Quantity("filling", ("T",), "1", "volume filling factor"),)),
    ShrinkParameters,
    prepare,
    estimate,
)

if __name__ == "__main__":
    script.main(KIND, "Shrink a periodic cell.")
"""


def shrink(folder, *arguments):
    (folder / "shrink.py").write_text(SCRIPT)
    return subprocess.run(
        ["yade", "-n", "-x", "shrink.py", *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        env=environment(),
        timeout=60,
    )


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("shrink")
    done = shrink(folder)
    assert done.returncode == 0 and messages(done) == [], done.stderr
    return folder / "runs" / "shrink-ice-0.0003"


def test_the_run_folder_tells_the_kind_and_holds_its_series(run):
    about, history = read_json(run, "run.json"), read_arrays(run, "history.npz")
    assert (about["format"], about["kind"], about["outcome"]) == (3, "shrink", "completed")
    assert list(about["parameters"])[:2] == ["rate", "duration"] and about["derived"]["spacing"] > 1.98e-7
    assert list(history) == ["time", *CHANNELS, "contacts", "filling"]
    strain = 3e-4 * history["time"] / about["derived"]["timeUnit"]
    assert history["filling"] == pytest.approx(history["filling"][0] * np.exp(3 * strain), rel=3e-4)


def test_the_analysis_reads_it(run):
    found = open_run(run)
    assert found.kind.name == "shrink" and found.ended and len(found.states) == 22
    assert np.array_equal(found.history["filling"], read_arrays(run, "history.npz")["filling"])


def test_states_have_the_cell(run):
    history = read_arrays(run, "history.npz")
    names = sorted(os.listdir(run / "states"))
    assert len(names) == 22
    for name in names:
        state = read_arrays(run, "states", name)
        row = np.flatnonzero(history["time"] == state["time"])
        volume = 27 * 4 / 3 * np.pi * 1e-21 / history["filling"][row[0]]
        assert state["cell_size"].shape == (3,) and np.prod(state["cell_size"]) == pytest.approx(volume, rel=1e-12)


def test_the_ledger_counts_the_work_of_the_boundaries(run):
    """Without it the run would have been stopped: the work is many times the energy of the start."""
    history = read_arrays(run, "history.npz")
    stored = sum(history[name] for name in CHANNELS if name != "boundaryWork")
    start = sum(abs(history[name][0]) for name in CHANNELS)
    assert np.ptp(stored) > 5 * start and history["boundaryWork"][-1] < -5 * start
    total = stored + history["boundaryWork"]
    assert np.abs(total - total[0]).max() < 1e-3 * np.ptp(stored)


@pytest.mark.parametrize(
    "argument, message",
    [
        ("rate=-1", "rate = -1: must be > 0 [1/t0]"),
        ("stepFraction=auto", "stepFraction = auto: not measured for this kind of run; must be a number [t0]"),
        (
            "duration=1e9",
            "duration = 1e+09: 5.2e+19 steps of 0.1 t0; must be at most 1e+09 steps, 0.0194 s with this "
            "stepFraction",
        ),
    ],
)
def test_wrong_parameters_give_one_line(tmp_path, argument, message):
    refused = shrink(tmp_path, argument)
    assert refused.returncode == 2 and messages(refused) == [f"shrink.py: {message}"]
    assert os.listdir(tmp_path) == ["shrink.py"]


def test_help(tmp_path):
    assert "rate = 0.0003 [1/t0]" in shrink(tmp_path, "--help").stdout


def test_a_study_of_two_kinds(run, tmp_path):
    """Rows with !SCRIPT are of its kind, those without collisions; an ended run of the kind is skipped, another is not."""
    (tmp_path / "shrink.py").write_text(SCRIPT)
    (tmp_path / "both.table").write_text(
        "description !SCRIPT   rate  radius velocity duration out\n"
        "cell        shrink.py 6e-4  *      *        2e-9     *\n"
        "collision   *         *     4      30       2e-9     *\n"
        "nothing     none.py   *     *      *        2e-9     *\n"
        f"ended       shrink.py *     *      *        *        {run}\n"
        f"other       shrink.py 1e-4  *      *        *        {run}x\n"
    )
    os.symlink(run, f"{run}x")
    done = subprocess.run(
        [PYTHON, os.path.join(TOP, "yade_scripts", "study.py"), "both.table", "-j", "2"],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        env=environment(),
        timeout=120,
    )
    assert done.returncode == 1
    lines = [line for line in done.stderr.splitlines() if not line.endswith("the other rows are run")]
    assert lines == [
        "study.py: nothing: line 4 of both.table: none.py: no such script",
        f"study.py: other: {run}x: holds an ended run with rate = 0.0003, not 0.0001; must be the same, or removed to "
        "run the row",
    ]
    assert done.stdout.splitlines()[-1] == "both: 5 rows, 3 done, 2 failed"
    kinds = {name: read_json(tmp_path, "runs", name, "run.json")["kind"] for name in ("cell", "collision")}
    assert kinds == {"cell": "shrink", "collision": "collision"}


def test_a_killed_run_resumes_to_the_same_bits(run, tmp_path):
    (tmp_path / "shrink.py").write_text(SCRIPT)
    command = ["yade", "-n", "-x", "shrink.py", "duration=200e-9", "rate=3e-5", "threads=1"]
    options = dict(cwd=tmp_path, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, env=environment())
    killed = subprocess.Popen([*command, "checkpointInterval=0.01", "out=killed"], **options)
    saved, deadline = tmp_path / "killed" / "checkpoint" / "recorder.npz", time.monotonic() + 60
    while not saved.exists() and killed.poll() is None and time.monotonic() < deadline:
        time.sleep(0.002)
    killed.send_signal(signal.SIGKILL)
    killed.wait()
    assert saved.exists() and not (tmp_path / "killed" / "ended").exists()
    assert subprocess.run([*command, "out=killed", "resume=1"], **options).returncode == 0
    assert subprocess.run([*command, "out=straight"], **options).returncode == 0
    one, other = (read_arrays(tmp_path, name, "history.npz") for name in ("killed", "straight"))
    assert all(one[name].tobytes() == other[name].tobytes() for name in other)


@pytest.mark.parametrize(
    "text, message",
    [("x = 1", "defines no KIND; must be a script such as"), ("1/0", "division by zero"), ("def", "invalid syntax")],
)
def test_scripts_that_define_no_kind(tmp_path, text, message):
    (tmp_path / "script.py").write_text(text)
    with pytest.raises(NoKind, match=message) as error:
        kind_of(str(tmp_path / "script.py"))
    assert "\n" not in str(error.value)
