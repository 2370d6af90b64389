"""A run that was killed or stopped resumes from its checkpoint as if nothing had happened."""

import os
import shutil
import signal
import subprocess
import time

import numpy as np
import pytest
from running import COLLIDE, collide, collided, environment, messages, read_arrays, read_json

# A second or so of stepping, with a checkpoint after each few steps.
RUN = ("radius=10", "velocity=10", "duration=400e-9", "threads=1")
OFTEN = "checkpointInterval=0.1"


def arrays(folder):
    """{file: {name: array}} of a run folder."""
    names = ["history.npz"] + [os.path.join("states", name) for name in sorted(os.listdir(folder / "states"))]
    return {name: read_arrays(folder, name) for name in names}


def same_bits(one, other):
    return one.keys() == other.keys() and all(
        one[name].keys() == other[name].keys()
        and all(one[name][key].tobytes() == other[name][key].tobytes() for key in one[name])
        for name in one
    )


def stop_midway(folder, arguments, signal_number):
    """Start a run, stop it by a signal once a checkpoint of some way into the run is there; the process."""
    process = subprocess.Popen(
        ["yade", "-n", "-x", COLLIDE, *arguments],
        cwd=folder,
        text=True,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        env=environment(),
    )
    checkpoint = folder / "run" / "checkpoint" / "recorder.npz"
    deadline = time.monotonic() + 60
    while not checkpoint.exists() and process.poll() is None and time.monotonic() < deadline:
        time.sleep(0.01)
    process.send_signal(signal_number)
    process.communicate(timeout=60)
    assert checkpoint.exists() and not (folder / "run" / "ended").exists()
    return process


@pytest.fixture(scope="module")
def straight(tmp_path_factory):
    """The arrays of the run without a stop."""
    folder = tmp_path_factory.mktemp("straight")
    collided(folder, *RUN, "out=run")
    assert not (folder / "run" / "checkpoint").exists()
    return arrays(folder / "run")


@pytest.fixture(scope="module")
def killed(tmp_path_factory):
    """A folder whose run/ was killed by SIGKILL."""
    folder = tmp_path_factory.mktemp("killed")
    assert stop_midway(folder, [*RUN, OFTEN, "out=run"], signal.SIGKILL).returncode == -signal.SIGKILL
    return folder


def test_a_killed_run_resumes_to_the_same_bits(straight, killed, tmp_path):
    run = shutil.copytree(killed / "run", tmp_path / "run")
    saved = read_arrays(run, "checkpoint", "recorder.npz")["rows"]
    assert 1 < len(saved) < len(straight["history.npz"]["time"])
    assert read_json(run, "run.json")["outcome"] == "running"
    collided(tmp_path, *RUN, "out=run", "resume=1")
    assert same_bits(arrays(run), straight)
    assert sorted(os.listdir(run)) == ["ended", "history.npz", "run.json", "states"]
    assert read_json(run, "run.json")["outcome"] == "completed"


def test_what_a_killed_writer_left_is_removed(killed, tmp_path):
    run = shutil.copytree(killed / "run", tmp_path / "run")
    left = [run / ".history.npz.x.unfinished", run / "states" / ".000003.npz.x.unfinished"]
    for path in left:
        path.write_bytes(b"half")
    collided(tmp_path, *RUN, "out=run", "resume=1")
    assert not any(path.exists() for path in left)


def test_a_stopped_run_resumes_to_the_same_bits(straight, tmp_path):
    """SIGTERM records one state more, where it stopped; that one is removed when the run resumes."""
    assert stop_midway(tmp_path, [*RUN, OFTEN, "out=run"], signal.SIGTERM).returncode == 143
    before = read_json(tmp_path, "run", "run.json")
    assert before["outcome"] == "interrupted"
    collided(tmp_path, *RUN, "out=run", "resume=1")
    assert same_bits(arrays(tmp_path / "run"), straight)
    assert read_json(tmp_path, "run", "run.json")["wallTime"] > before["wallTime"]


def test_a_checkpoint_of_other_parameters_is_refused(killed):
    before = sorted(os.listdir(killed / "run"))
    refused = collide(killed, *RUN, "out=run", "resume=1", "seed=2")
    assert refused.returncode == 2
    assert messages(refused) == [
        "collide.py: run/checkpoint: of a run with seed = 1, not 2; must be the same, or removed to start the run again"
    ]
    assert sorted(os.listdir(killed / "run")) == before


@pytest.mark.parametrize(
    "damage, message",
    [
        (lambda about: about.replace('"commit": "', '"commit": "0'), "written by the plugin of commit 0"),
        (lambda about: about.replace('"yade": "', '"yade": "1'), "written by YADE 1"),
        (lambda about: about.replace("scene-", "nothing-"), "not a checkpoint ([Errno 2]"),
        (lambda about: about[:20], "not a checkpoint ("),
        (lambda about: about.replace('"drag", ', ""), "of a history with other columns"),
        (
            lambda about: about.replace('"kind": "collision"', '"kind": "toy"'),
            "of a run with kind = toy, not collision",
        ),
    ],
    ids=["commit", "yade", "no scene", "cut off", "columns", "kind"],
)
def test_a_checkpoint_that_cannot_be_used_gives_one_line(killed, tmp_path, damage, message):
    shutil.copytree(killed / "run", tmp_path / "run")
    path = tmp_path / "run" / "checkpoint" / "recorder.npz"
    held = read_arrays(path)
    np.savez(path, rows=held["rows"], about=damage(str(held["about"])))
    refused = collide(tmp_path, *RUN, "out=run", "resume=1")
    assert refused.returncode == 2
    lines = messages(refused)
    assert len(lines) == 1 and lines[0].startswith(f"collide.py: run/checkpoint: {message}") and "must be " in lines[0]


def test_resume_without_a_checkpoint_starts_from_the_beginning(straight, tmp_path):
    done = collide(tmp_path, *RUN, "out=run", "resume=1")
    assert done.returncode == 0 and same_bits(arrays(tmp_path / "run"), straight)


def test_without_resume_a_checkpoint_is_thrown_away(straight, killed, tmp_path):
    shutil.copytree(killed / "run", tmp_path / "run")
    done = collide(tmp_path, *RUN, "out=run")
    assert done.returncode == 0 and same_bits(arrays(tmp_path / "run"), straight)
    assert not (tmp_path / "run" / "checkpoint").exists()


def test_yades_own_loop_resumes_to_rounding(tmp_path):
    """Forces may be added in another order after loading; early in a run that is all the difference."""
    arguments = ("radius=5", "velocity=30", "duration=12e-9", "engine=functors")
    assert collide(tmp_path, *arguments, "out=straight").returncode == 0
    stop_midway(tmp_path, [*arguments, "checkpointInterval=0.05", "out=run"], signal.SIGKILL)
    collided(tmp_path, *arguments, "out=run", "resume=1")
    one, other = arrays(tmp_path / "straight"), arrays(tmp_path / "run")
    assert one.keys() == other.keys()
    assert np.array_equal(one["history.npz"]["contacts"], other["history.npz"]["contacts"])
    for name in ("kinetic", "normal", "connection", "d", "v"):
        scale = np.abs(one["history.npz"][name]).max()
        assert np.allclose(one["history.npz"][name], other["history.npz"][name], rtol=0, atol=1e-6 * scale), name
