"""study.py --device: collisions by the device's code leave run folders as YADE's scripts do."""

import os
import re
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from analysis.runs.folder import open_run
from analysis.runs.format import same
from analysis.runs.status import run_of, status_of, verify_run
from yade_scripts.experiments.collision import CollisionParameters
from yade_scripts.run import on_device

sys.path.insert(0, os.path.join(os.path.dirname(os.path.dirname(__file__)), "scripts"))
from running import PYTHON, STUDY, environment, start, study, wait_for

ROWS = {
    "like": "packing=bcca grains=30 velocity=15 impact=0.3",
    "mixed": "packing=bcca grains=30 velocity=15 impact=0.3 material=ice,silicate materialFraction=0.4",
    "turning": "packing=bpca grains=30 velocity=3 seed=2 spin=2e7",
    "shorter": "packing=bcca grains=30 velocity=15 stepFraction=0.3 impactStepFraction=0.08",
    "sintered": "packing=bcca grains=30 velocity=15 seed=3 stepFraction=0.1 neck=0.3",
}


def write_table(file, rows, **usual):
    """A table of {description: 'name=value ...'}, `usual` where a row has no value."""
    cells = [{**usual, **dict(word.split("=") for word in row.split())} for row in rows.values()]
    names = list(dict.fromkeys(name for row in cells for name in row))
    lines = [" ".join([name, *(row.get(key, "*") for key in names)]) for name, row in zip(rows, cells)]
    file.write_text("\n".join([" ".join(["description", *names]), *lines]) + "\n")


@pytest.fixture(scope="module")
def both(tmp_path_factory):
    """Folders in which the table was run by the device's code, without YADE on PATH, and by YADE."""
    folders = [tmp_path_factory.mktemp(name) for name in ("device", "yade")]
    for folder in folders:
        write_table(folder / "a.table", ROWS, stepFraction="0.2", threads="1", states="4")
    ours = subprocess.run(
        [PYTHON, STUDY, "a.table", "--device", "processor"],
        cwd=folders[0],
        env={**environment(), "PATH": os.path.dirname(shutil.which("true"))},
        capture_output=True,
        text=True,
    )
    theirs = study(folders[1], "a.table", "-j", "2")
    assert "5 done, 0 failed" in ours.stdout and "5 done" in theirs.stdout, ours.stderr + theirs.stderr
    return folders


@pytest.mark.parametrize("name", ROWS)
def test_a_run_on_a_device_is_that_of_yade(both, name):
    """The same parameters, derived constants, arrays and, until motions part, numbers; and the same outcome."""
    ours, theirs = (open_run(folder / "runs" / name) for folder in both)
    assert ours.record["device"] == "processor" and verify_run(ours.path)[0] == []
    assert ours.record["outcome"] == theirs.record["outcome"] and ours.history.keys() == theirs.history.keys()
    assert [key for key, value in theirs.parameters.items() if not same(value, ours.parameters[key])] == ["resume"]
    assert theirs.derived.keys() == ours.derived.keys()
    assert ours.derived["firstTouch"] == pytest.approx(theirs.derived["firstTouch"], rel=1e-12)
    before = theirs.history["time"] < theirs.derived["firstTouch"] + 20 * theirs.derived["timeUnit"]
    scale = theirs.history["kinetic"][0]
    for column in ("kinetic", "normal", "rolling", "slidingDissipation", "d", "v", "formed", "contacts"):
        one, other = (run.history[column][: np.count_nonzero(before)] for run in (ours, theirs))
        assert one == pytest.approx(
            other, rel=1e-6, abs=1e-6 * (scale if abs(other).max() < 1e-9 else abs(other).max())
        )
    first, other = vars(ours.start), vars(theirs.start)
    assert {key for key in first if first[key] is not None} == {key for key in other if other[key] is not None}
    assert np.array_equal(first["aggregate"], other["aggregate"])
    assert first["position"] == pytest.approx(other["position"], abs=1e-12 * 1e-7)
    assert first["velocity"] == pytest.approx(other["velocity"], abs=1e-9)


def test_what_a_device_cannot_run_goes_to_yade_and_one_failure_is_its_own(tmp_path):
    rows = {"plate": "velocity=5 target=wall", "fine": "velocity=5", "fast": "velocity=90000 unusual=1"}
    write_table(tmp_path / "b.table", rows, packing="bcca", grains="20", stepFraction="0.4")
    done = study(tmp_path, "b.table", "--device", "processor", "-j", "1")
    assert "2 rows on processor; 1 are done, or not for it" in done.stdout and "2 done, 1 failed" in done.stdout
    assert done.returncode == 1 and "fast: a grain moves more than half a radius in a step" in done.stderr
    assert "device" not in open_run(tmp_path / "runs" / "plate").record


@pytest.mark.parametrize("signal_of_stop", [signal.SIGINT, signal.SIGTERM])
def test_stopped_runs_give_their_folders_back_and_start_again(tmp_path, signal_of_stop):
    write_table(tmp_path / "c.table", {"a": "seed=1", "b": "seed=2"}, packing="bcca", grains="200", velocity="5")
    command = [PYTHON, STUDY, "c.table", "--device", "processor"]
    running = start(tmp_path, *command)
    wait_for(lambda: list((tmp_path / "runs").glob("?/states")))
    running.send_signal(signal_of_stop)
    printed, problems = running.communicate(timeout=120)
    assert running.returncode == 128 + signal_of_stop and "0 done, 0 failed, 2 left" in printed and problems == ""
    assert not list((tmp_path / "runs").glob("?/lock"))


def test_a_large_collision_gets_the_whole_device(tmp_path, monkeypatch):
    monkeypatch.setattr(on_device, "LARGE", 40)
    library, sizes = on_device.library_of("processor"), []
    run = library.large.run
    monkeypatch.setattr(
        library.large, "run", lambda own, steps: (sizes.extend(one.grains for one in own), run(own, steps))
    )
    cells = {"packing": "bcca", "velocity": "15", "stepFraction": "0.2", "states": "4"}
    given = [
        CollisionParameters.parse({**cells, "grains": grains, "out": str(tmp_path / grains)}) for grains in ("15", "30")
    ]
    assert on_device.run(given, library) == {} and set(sizes) == {60}
    assert [open_run(one.out).record["outcome"] for one in given] == ["sticking", "sticking"]


class Lost(on_device.Library):
    """A device that is lost at its third launch."""

    launches = 0

    def run(self, collisions, steps):
        self.launches += 1
        if self.launches > 2:
            raise on_device.DeviceError("the device is lost")
        super().run(collisions, steps)


def test_what_was_on_a_lost_device_fails_each_with_its_line(tmp_path):
    given = [
        CollisionParameters.parse({"packing": "bcca", "grains": 20, "seed": seed, "out": str(tmp_path / str(seed))})
        for seed in range(3)
    ]
    assert on_device.run(given, Lost()) == dict.fromkeys(range(3), "the device is lost")
    assert [status_of(run_of(one.out)) for one in given] == ["failed: the device is lost"] * 3


def test_a_device_that_is_not_there_is_one_line(tmp_path, monkeypatch):
    monkeypatch.setitem(on_device.LIBRARIES, "gpu", 2 * (tmp_path / "none.so",))
    with pytest.raises(on_device.InputError, match="^--device gpu: .*none.so is not built; must be made first"):
        on_device.library_of("gpu")


RESOURCES = [on_device.DEVICE.with_name(f"resources{of}.txt") for of in ("", "-whole")]


@pytest.mark.skipif(not all(map(Path.exists, RESOURCES)), reason="make gpu has not been called")
def test_the_device_has_room_for_two_blocks_of_every_kernel():
    """What nvcc says of registers and of what they spill: 65,536 registers for 2 x 256 threads; spills cost time."""
    text = "".join(map(Path.read_text, RESOURCES))
    registers = [int(number) for number in re.findall(r"Used (\d+) registers", text)]
    spilt = [int(number) for number in re.findall(r"(\d+) bytes spill stores", text)]
    assert registers and max(registers) <= 128 and max(spilt) <= 800, (registers, spilt)
