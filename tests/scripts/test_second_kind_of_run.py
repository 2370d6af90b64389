"""A kind of run that a user adds in one script (shrinking_cell.py) is run, recorded and studied."""

import os

import numpy as np
import pytest
from running import call, messages, read_arrays, read_json, study
from shrinking_cell import SHRINK

from analysis import open_run
from analysis.runs.format import CHANNELS, FORMAT


def shrink(folder, *arguments):
    return call(folder, "yade", "-n", "-x", SHRINK, *arguments)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    folder = tmp_path_factory.mktemp("shrink")
    done = shrink(folder)
    assert done.returncode == 0 and messages(done) == [], done.stderr
    return folder / "runs" / "shrink-ice-0.0003"


def test_its_folder_has_its_series_its_states_the_cell_and_its_ledger_the_work_of_the_boundaries(run):
    """Without that work the run would have been stopped: it is many times the energy of the start."""
    about, history = read_json(run, "run.json"), read_arrays(run, "history.npz")
    assert (about["format"], about["kind"], about["outcome"]) == (FORMAT, "shrink", "completed")
    assert list(about["parameters"])[:2] == ["rate", "duration"] and about["derived"]["spacing"] > 1.98e-7
    assert list(history) == ["time", *CHANNELS, "contacts", "filling"]
    strain = 3e-4 * history["time"] / about["derived"]["timeUnit"]
    assert history["filling"] == pytest.approx(history["filling"][0] * np.exp(3 * strain), rel=3e-4)
    found = open_run(run)
    assert found.kind.name == "shrink" and found.ended and len(found.states) == 22
    for state in found.states:
        volume = 27 * 4 / 3 * np.pi * 1e-21 / history["filling"][history["time"] == state.time]
        assert state.cell_size.shape == (3,) and np.prod(state.cell_size) == pytest.approx(volume[0], rel=1e-12)
    stored = sum(history[name] for name in CHANNELS if name != "boundaryWork")
    start = sum(abs(history[name][0]) for name in CHANNELS)
    assert np.ptp(stored) > 5 * start and history["boundaryWork"][-1] < -5 * start
    total = stored + history["boundaryWork"]
    assert np.abs(total - total[0]).max() < 1e-3 * np.ptp(stored)


def test_a_study_of_two_kinds(run, tmp_path):
    """Rows with !SCRIPT are of its kind, those without collisions; an ended run of the kind is skipped, another is
    not."""
    os.symlink(SHRINK, tmp_path / "shrink.py")
    (tmp_path / "both.table").write_text(
        "description !SCRIPT   rate  radius velocity duration out\n"
        "cell        shrink.py 6e-4  *      *        2e-9     *\n"
        "collision   *         *     4      30       2e-9     *\n"
        "nothing     none.py   *     *      *        2e-9     *\n"
        f"ended       shrink.py *     *      *        *        {run}\n"
        f"other       shrink.py 1e-4  *      *        *        {run}x\n"
    )
    os.symlink(run, f"{run}x")
    done = study(tmp_path, "both.table", "-j", "2")
    assert done.returncode == 1
    script, differs = done.stderr.splitlines()
    assert "none.py: no such script" in script and "holds an ended run with rate = 0.0003, not 1e-4" in differs
    assert done.stdout.splitlines()[-1].startswith("both: 5 rows, 3 done, 2 failed; 1 undecided")
    assert open_run(run).parameters["rate"] == 3e-4  # as it was
    kinds = {name: read_json(tmp_path, "runs", name, "run.json")["kind"] for name in ("cell", "collision")}
    assert kinds == {"cell": "shrink", "collision": "collision"}
