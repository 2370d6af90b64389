"""A program that is killed, or finds the disk full, leaves whole files, and the same call again comes to the same end.

Tried at one call of each kind (function and kind of file) of each program."""

import re
import shutil
import subprocess
from pathlib import Path

import pytest
from faults import DISK_FULL, KILLED, OTHER, RECORDER, RUN, arrays, fast_folder

from analysis.runs.files import is_unfinished

RESUME, OVERWRITE = "resume=1", "overwrite=1"
# What the call that meets a fault is given, what the run that was in the folder before (None: none) and whether that
# was killed.
SCENES = {
    "a new run": (RUN, None, False),
    "a resumed run": (RUN + (RESUME,), RUN, True),
    "a run that replaces an ended one": (RUN + (OVERWRITE,), RUN + OTHER, False),
}
ENDED = {"ended", "history.npz", "run.json", "states"}


def sample(calls, name=lambda path: re.sub(r"\d+", "", path)):
    """The last call of each kind: by function and file, numbers and the random part of temporary names left out."""
    kind = lambda call: (call.name, name(re.sub(r"\.[0-9a-f]{8}\.unfinished", "", call.path)))
    return list({kind(call): call for call in calls}.values())


def killed_run(forks, folder, arguments, checkpoints=3):
    """A run folder (Path) whose run was killed after so many checkpoints."""
    calls = forks.run(arguments, folder).calls
    shutil.rmtree(folder)
    written = [call.number for call in calls if call.name == "replace" and call.path.endswith(RECORDER)]
    assert forks.run(arguments, folder, written[checkpoints - 1] + 4).status == -9
    return folder


def unfinished(folder):
    return [path for path in folder.rglob("*") if is_unfinished(path.name)]


@pytest.fixture(scope="module")
def straight(forks):
    with fast_folder() as folder:
        assert forks.run(RUN, folder / "run").status == 0
        yield arrays(folder / "run")


@pytest.mark.parametrize("scene, fault", [*((scene, KILLED) for scene in SCENES), ("a new run", DISK_FULL)])
def test_a_run_is_resumed_or_made_again_with_the_same_bits(forks, straight, scene, fault):
    arguments, before, was_killed = SCENES[scene]
    with fast_folder() as folder:
        kept, run = folder / "kept" / "run", folder / "at" / "run"
        kept.parent.mkdir()
        if was_killed:
            killed_run(forks, kept, before)
        elif before:
            assert forks.run(before, kept).status == 0
        else:
            kept.mkdir()
        calls = forks.run(arguments, Path(shutil.copytree(kept, folder / "once" / "run"))).calls
        assert len(sample(calls)) > 15
        for call in sample(calls):
            shutil.rmtree(run.parent, ignore_errors=True)
            shutil.copytree(kept, run)
            done = forks.run(arguments, run, call.number, fault)
            if fault == KILLED:
                assert done.status == -9
            elif done.status:
                assert any("No space left on device" in line for line in done.lines)
                assert not any("Traceback" in line for line in done.lines)
            if (run / "ended").exists():
                assert arrays(run) in [straight, *([arrays(kept)] if (kept / "ended").exists() else [])], call
            else:
                again = forks.run(
                    arguments if RESUME in arguments or OVERWRITE in arguments else [*arguments, RESUME], run
                )
                assert again.status == 0 and arrays(run) == straight, (call, again.lines)
                assert unfinished(run) == [] and {path.name for path in run.iterdir()} == ENDED, call


# A program that writes other kinds of files, and its arguments.
PROGRAMS = {
    "make_packing": ("yade_scripts/make_packing.py", ("out/a.npz", "radius=4")),
    "export": ("analysis", ("export", "run", "--format", "all", "--out", "out")),
    "figures": ("analysis", ("figures", "run", "--out", "out")),
    "view": ("analysis", ("view", "run", "--out", "out/view.html")),
}


# The run that commands read: it has one figure.
COMPRESSION = "grains=12 strainRate=1e-3 stepFraction=0.2 finalFilling=0.2 states=2 threads=1 out=run".split()


@pytest.mark.parametrize("name", PROGRAMS)
def test_no_fault_leaves_half_of_what_a_command_writes(forks, name):
    program, arguments = PROGRAMS[name]
    with fast_folder() as folder:
        assert forks.call("yade_scripts/compress.py", COMPRESSION, folder).status == 0
        out = folder / "out"
        out.mkdir()
        files = lambda: [path for path in out.rglob("*") if path.is_file() and not is_unfinished(path.name)]
        found = lambda: {path: path.read_bytes() for path in files()}
        calls = forks.call(program, arguments, folder).calls
        whole = found()
        assert len(whole) >= 1 and len(calls) >= 3
        for call in sample(calls, lambda path: Path(path).suffix):
            for fault in (KILLED, DISK_FULL) if call.name == "fsync" else (KILLED,):
                shutil.rmtree(out)
                out.mkdir()
                done = forks.call(program, arguments, folder, call.number, fault)
                assert all(content == whole[path] for path, content in found().items()), call
                assert fault == KILLED or done.status == 0 or any("No space left" in line for line in done.lines)
                assert forks.call(program, arguments, folder).status == 0 and found() == whole


def test_a_disk_that_is_really_full(forks, straight, tmp_path):
    """A file system of 32 kB in memory (a run needs less than 80); mounting takes root."""
    if subprocess.run(["mount", "-t", "tmpfs", "-o", "size=32k", "none", tmp_path], capture_output=True).returncode:
        pytest.skip("mounting takes root")
    try:
        done = forks.run(RUN, tmp_path / "run")
        assert done.status and any("No space left on device" in line for line in done.lines)
        subprocess.run(["mount", "-o", "remount,size=4m", tmp_path], check=True)
        assert forks.run(RUN + (RESUME,), tmp_path / "run").status == 0
        assert arrays(tmp_path / "run") == straight
    finally:
        subprocess.run(["umount", tmp_path], check=True)
