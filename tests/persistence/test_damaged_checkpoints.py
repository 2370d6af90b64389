"""A checkpoint that isn't what was written is refused with one line, and nothing of its run is removed."""

import os
import shutil

import numpy as np
import pytest
from faults import OTHER, RECORDER, RUN
from test_faults import killed_run
from written_runs import flip

RESUME = RUN + ("resume=1",)
STATE = "states/000001.npz"


@pytest.fixture(scope="module")
def originals(forks, tmp_path_factory):
    """(a killed run's folder, that of one with another seed)."""
    folder = tmp_path_factory.mktemp("killed")
    return killed_run(forks, folder / "run", RUN, 4), killed_run(forks, folder / "other", RUN + OTHER, 4)


@pytest.fixture
def run(originals, tmp_path):
    return shutil.copytree(originals[0], tmp_path / "run")


def scene_of(run):
    return next((run / "checkpoint").glob("scene-*.yade"))


def of_another_commit(run, other):
    with np.load(run / RECORDER) as archive:
        rows, about = archive["rows"], str(archive["about"])
    np.savez(run / RECORDER, rows=rows, about=about.replace('"commit": "', '"commit": "0'))


DAMAGE = {
    "another commit": (of_another_commit, "written by the plugin of commit 0"),
    "a bit of the scene": (lambda run, other: flip(scene_of(run), 0.5), "scene-4.yade: not as it was written"),
    "another run's scene": (lambda run, other: shutil.copy(scene_of(other), scene_of(run)), "scene-4.yade: "),
    "half a recorder": (lambda run, other: os.truncate(run / RECORDER, 900), "not a checkpoint ("),
    "a bit of a state": (lambda run, other: flip(run / STATE, 0.5), "000001.npz: not as it was written"),
}


def content(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


def without_lock(found):
    return {path: text for path, text in found.items() if path.name != "lock"}


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_checkpoint_is_one_line_and_removes_nothing(forks, originals, run, damage):
    spoil, message = DAMAGE[damage]
    spoil(run, originals[1])
    before = content(run)
    done = forks.run(RESUME, run)
    assert done.status == 2 and len(done.lines) == 1, done
    assert done.lines[0].startswith("collide.py: run/") and message in done.lines[0] and "must be" in done.lines[0]
    assert content(run) == without_lock(before)


def test_a_run_with_a_checkpoint_starts_again_only_when_told_nor_resumes_as_another(forks, run):
    before = content(run)
    for arguments, message in (
        (RUN, "holds a run that was stopped, with a checkpoint; must be another folder, or resume=1 (to continue it)"),
        (RESUME + OTHER, "run/checkpoint: of a run with seed = 1, not 2; must be the same"),
    ):
        done = forks.run(arguments, run)
        assert done.status == 2 and len(done.lines) == 1 and message in done.lines[0], done
    assert content(run) == without_lock(before)


def test_a_run_resumes_with_another_number_of_states(forks, run):
    """Those that are there stay; the others are written where the new number has them."""
    done = forks.run([argument.replace("states=4", "states=7") for argument in RESUME], run)
    assert done.status == 0, done.lines
    times = [float(np.load(path)["time"]) for path in sorted((run / "states").iterdir())]
    with np.load(run / "history.npz") as history:
        assert times == [history["time"][number] for number in (0, 2, 4, 5, 6)]
