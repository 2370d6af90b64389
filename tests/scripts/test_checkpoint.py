"""A run that was killed or stopped resumes from its checkpoint as if nothing had happened."""

import os
import shlex
import signal

import numpy as np
import pytest
from running import *

OFTEN = "checkpointInterval=0.05"  # after each few steps
# A second or so of stepping: a collision whose steps change, a compression whose end follows from the history.
KINDS = {
    "collision": (COLLIDE, "radius=8 velocity=30 duration=400e-9 threads=1 stepFraction=0.2 impactStepFraction=0.06"),
    "compression": (COMPRESS, "grains=64 strainRate=2e-5 threads=1 finalFilling=0.2 stretch=x"),
}


@pytest.mark.parametrize("name", KINDS)
def test_a_run_that_was_killed_resumes_to_the_same_bits(tmp_path, name):
    """What its writer has left half done is removed."""
    script, arguments = KINDS[name][0], KINDS[name][1].split()
    completed(tmp_path / "straight", *arguments, script=script)
    stop_midway(tmp_path, [*arguments, OFTEN], script=script, after=0.5 if script == COMPRESS else 0.0)
    run, straight = tmp_path / "run", tmp_path / "straight" / "run"
    before, saved = read_json(run, "run.json"), read_arrays(run, "checkpoint", "recorder.npz")["rows"]
    assert before["status"] == "running" and 1 < len(saved) < len(read_arrays(straight, "history.npz")["time"])
    half = run / "states" / ".000003.npz.0123abcd.unfinished"
    half.write_bytes(b"half")
    about, _ = completed(tmp_path, *arguments, "resume=1", script=script)
    assert about["wallTime"] > before["wallTime"] and about["status"] == "completed"
    assert same_bits(run, straight) and not half.exists()


def test_yades_own_loop_resumes_to_rounding(tmp_path):
    """Forces may be added in another order after loading; early in a run that is all the difference."""
    arguments = ("radius=5", "velocity=30", "duration=12e-9", "engine=functors")
    _, one = completed(tmp_path / "straight", *arguments)
    stop_midway(tmp_path, [*arguments, OFTEN])
    _, other = completed(tmp_path, *arguments, "resume=1")
    assert np.array_equal(one["contacts"], other["contacts"])
    for name in ("kinetic", "normal", "connection", "d", "v"):
        assert np.allclose(one[name], other[name], rtol=0, atol=1e-6 * np.abs(one[name]).max()), name


def test_a_run_that_ends_undecided_goes_on_to_the_same_bits(tmp_path):
    """Its line has the command. A row of a table is its run if that is as long as it wants, and goes on with it
    otherwise."""
    fluffy = "packing=bcca grains=64 velocity=2 states=2 threads=1 stepFraction=0.025".split()
    _, straight = completed(tmp_path / "straight", *fluffy, "duration=6e-7")
    done = collide(tmp_path, *fluffy, "duration=3e-7", "out=run")
    reason, _, command = done.stdout.partition("\nto continue: ")
    assert "outcome undecided: " in reason and (tmp_path / "run" / "ended").exists()
    command = shlex.split(command.splitlines()[0])
    assert command[-1] == "duration=6e-07"
    assert "must be longer" in refusal(forked(tmp_path, *command[3:-1], "duration=2e-7"))
    assert "velocity: given with continue = run" in refusal(forked(tmp_path, *command[3:], "velocity=3"))
    assert "outcome undecided" in call(tmp_path, *command[:-1], "duration=3.1e-7").stdout
    for wanted, words in (
        ("duration=3e-7", "rows: 1 rows, 1 done"),
        ("duration=6e-7", "1 to run, 1 of them from checkpoints"),
        ("duration=6e-7 seed=2", "holds an ended run with seed = 1, not 2; must be the same"),
    ):
        cells = dict(cell.split("=") for cell in ("description=row", "out=run", *fluffy, *wanted.split()))
        (tmp_path / "rows.table").write_text(" ".join(cells) + "\n" + " ".join(cells.values()) + "\n")
        done = study(tmp_path, "rows.table", "-j", "1")
        assert words in done.stdout + done.stderr
    continued = read_arrays(tmp_path, "run", "history.npz")
    assert all(continued[name].tobytes() == straight[name].tobytes() for name in straight)


def test_a_study_goes_on_with_what_is_undecided_and_leaves_what_is_decided(tmp_path):
    """Rows without a duration end early if they can, the longer run too; a call again has nothing to do."""
    cells = "description packing grains velocity threads stepFraction states duration endWhenApart".split()
    rows = ["slow bcca 64 2 1 0.2 2 3e-7 1", "passes bcca 4 20 1 0.2 2 3e-7 1"]
    (tmp_path / "two.table").write_text("\n".join([" ".join(cells), *rows]) + "\n")
    assert "2 done, 0 failed; 1 undecided" in study(tmp_path, "two.table", "-j", "1").stdout
    before = (tmp_path / "runs" / "passes" / "ended").stat().st_mtime_ns
    done = study(tmp_path, "two.table", "-j", "1", "--longer", "6e-7")
    assert "1 to run, 1 of them from checkpoints" in done.stdout and "2 done" in done.stdout, done.stdout + done.stderr
    assert read_json(tmp_path, "runs", "slow", "run.json")["timeReached"] > 3.1e-7
    assert (tmp_path / "runs" / "passes" / "ended").stat().st_mtime_ns == before
    again = study(tmp_path, "two.table", "-j", "1", "--longer", "6e-7").stdout
    assert "to run" not in again and "2 done, 0 failed" in again


@pytest.mark.parametrize("number, status", [(signal.SIGTERM, 143), (signal.SIGINT, 130)])
def test_an_interrupted_run_leaves_what_it_had_and_prints_what_continues(tmp_path, number, status):
    process = stop_midway(tmp_path, [*KINDS["collision"][1].split(), OFTEN], number)
    assert process.returncode == status and "run folder: run (interrupted, " in process.output
    assert sorted(os.listdir(tmp_path / "run")) == ["checkpoint", "history.npz", "run.json", "states"]
    history = read_arrays(tmp_path, "run", "history.npz")
    assert states(tmp_path / "run")[-1]["time"] == history["time"][-1] > 0
    command = next(line for line in process.output.splitlines() if line.startswith("to continue: "))
    _, _, *yade, script, folder = shlex.split(command)
    assert yade == ["yade", "-n", "-x"] and forked(tmp_path, script, folder).returncode == 0
    assert (tmp_path / "run" / "ended").exists()
