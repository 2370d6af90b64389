"""A checkpoint that isn't what was written is refused with one line, and nothing of its run is removed."""

import shutil

import numpy as np
import pytest
from faults.commands import OTHER, RECORDER, RUN, arrays
from faults.forks import END_BEFORE
from written_runs import change_arrays, flip

RESUME = RUN + ("resume=1",)
STATE = "states/000001.npz"


def killed(forks, folder, arguments, checkpoints=4):
    """A run folder whose run was killed after so many checkpoints."""
    calls = forks.run(arguments, folder).calls
    shutil.rmtree(folder)
    ends = [call.number for call in calls if call.name == "rename" and call.path == RECORDER]
    forks.run(arguments, folder, ends[checkpoints - 1] + 4, END_BEFORE)
    return folder


@pytest.fixture(scope="module")
def originals(forks, tmp_path_factory):
    """(a killed run's folder, that of one with another seed)."""
    folder = tmp_path_factory.mktemp("killed")
    return killed(forks, folder / "run", RUN), killed(forks, folder / "other", RUN + OTHER)


@pytest.fixture
def run(originals, tmp_path):
    return shutil.copytree(originals[0], tmp_path / "run")


def scene_of(run):
    return next((run / "checkpoint").glob("scene-*.yade"))


def change_rows(run, change, about=str):
    """Write recorder.npz again with other rows, and another text about them."""
    with np.load(run / RECORDER) as archive:
        np.savez(run / RECORDER, rows=change(archive["rows"].copy()), about=about(archive["about"]))


def cut(file, length):
    file.write_bytes(file.read_bytes()[:length])


# What is replaced in the text about the rows, by what, and what is said of it.
ABOUT = {
    "another commit": ('"commit": "', '"commit": "0', "written by the plugin of commit 0"),
    "another YADE": ('"yade": "', '"yade": "1', "written by YADE 1"),
    "other columns": ('"drag", ', "", "of a history with other columns"),
    "another kind": ('"kind": "collision"', '"kind": "toy"', "of a run with kind = toy, not collision"),
    "a text that is no JSON": (": ", "", "not a checkpoint ("),
}


def with_text(before, after):
    return lambda run, other: change_rows(run, np.copy, lambda about: str(about).replace(before, after))


DAMAGE = {
    **{name: (with_text(before, after), message) for name, (before, after, message) in ABOUT.items()},
    "a bit of the scene": (lambda run, other: flip(scene_of(run), 0.5), "scene-4.yade: "),
    "half a scene": (lambda run, other: cut(scene_of(run), 2000), "scene-4.yade: 2000 bytes, SHA-256"),
    "another run's scene": (lambda run, other: shutil.copy(scene_of(other), scene_of(run)), "scene-4.yade: "),
    "no scene": (lambda run, other: scene_of(run).unlink(), "not a checkpoint ([Errno 2]"),
    "rows cut": (lambda run, other: change_rows(run, lambda rows: rows[:-1]), "recorder.npz: rows have the shape (4, "),
    "a number in rows": (lambda run, other: change_rows(run, lambda rows: rows * (1 + 1e-15)), "recorder.npz: "),
    "words as rows": (lambda run, other: change_rows(run, lambda rows: rows.astype(str)), "recorder.npz: "),
    "half a recorder": (lambda run, other: cut(run / RECORDER, 900), "not a checkpoint ("),
    "a state missing": (lambda run, other: (run / STATE).unlink(), "000001.npz: missing"),
    "half a state": (lambda run, other: (run / STATE).write_bytes(b"half"), "000001.npz: damaged, or not an .npz"),
    "a state of another time": (
        lambda run, other: change_arrays(run / STATE, time=1.0),
        "000001.npz: of 1 s; must be of",
    ),
    "a state of another kind": (
        lambda run, other: change_arrays(run / STATE, aggregate=np.zeros(3, int)),
        "'aggregate' has",
    ),
}


def content(folder):
    return {path.relative_to(folder): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


@pytest.mark.parametrize("damage", DAMAGE)
def test_a_damaged_checkpoint_is_one_line_and_removes_nothing(forks, originals, run, damage):
    spoil, message = DAMAGE[damage]
    spoil(run, originals[1])
    before = content(run)
    done = forks.run(RESUME, run)
    assert done.status == 2 and len(done.lines) == 1, done
    assert done.lines[0].startswith("collide.py: run/") and message in done.lines[0] and "must be" in done.lines[0]
    assert content(run) == before


def test_a_run_with_a_checkpoint_starts_again_only_when_asked_nor_resumes_as_another(forks, run):
    before = content(run)
    for arguments, message in (
        (RUN, "holds a run that was stopped, with a checkpoint; must be another folder, or resume=1 (to continue it)"),
        (RESUME + OTHER, "run/checkpoint: of a run with seed = 1, not 2; must be the same"),
    ):
        done = forks.run(arguments, run)
        assert done.status == 2 and len(done.lines) == 1 and message in done.lines[0], done
    assert content(run) == before


def test_every_bit_of_a_recorder_that_is_flipped_is_noticed_or_without_effect(forks, run, tmp_path):
    """np.load finds the flips by the archive's own sums; those it can't see (dates, attributes) change nothing."""
    assert forks.run(RUN, tmp_path / "straight").status == 0
    whole, straight = (run / RECORDER).read_bytes(), arrays(tmp_path / "straight")
    saved = shutil.copytree(run, tmp_path / "saved")
    statuses = set()
    for where in np.linspace(0, len(whole) - 1, 40) / len(whole):
        shutil.rmtree(run)
        shutil.copytree(saved, run)
        flip(run / RECORDER, where)
        before = content(run)
        done = forks.run(RESUME, run)
        statuses.add(done.status)
        if done.status == 0:
            assert arrays(run) == straight
        else:
            assert done.status == 2 and len(done.lines) == 1, done
            assert content(run) == before
    assert 2 in statuses


def test_the_checkpoint_of_a_run_of_the_functors_is_whole(forks, tmp_path):
    """Where a step begins with a sample, not ends: the number of rows is another one."""
    arguments = RUN + ("engine=functors",)
    run = killed(forks, tmp_path / "run", arguments)
    done = forks.run(arguments + ("resume=1",), run)
    assert done.status == 0, done.lines
    change_rows(killed(forks, tmp_path / "again", arguments), lambda rows: rows[:-1])
    assert forks.run(arguments + ("resume=1",), tmp_path / "again").status == 2


def test_a_run_resumes_with_another_number_of_states(forks, run):
    """Those that are there stay; the others are written where the new number has them."""
    done = forks.run([argument.replace("states=4", "states=7") for argument in RESUME], run)
    assert done.status == 0, done.lines
    times = [float(np.load(path)["time"]) for path in sorted((run / "states").iterdir())]
    with np.load(run / "history.npz") as history:
        assert times == [history["time"][number] for number in (0, 2, 4, 5, 6)]
