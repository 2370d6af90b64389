"""The engine without YADE (build/harness) moves grains to the same places, on any processor; the bench runs."""

import json
import shutil
import subprocess
import sys

import codes
import measured_scenes
import moments
import numpy as np
import pytest
import scene_file
from measured_on import TOP
from measured_scenes import SMALL

STEPS = 300


@pytest.fixture(scope="module", autouse=True)
def harness_is_built():
    subprocess.run(["make", "build/harness"], cwd=TOP, check=True, capture_output=True)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("scenes")


def files(name, folder):
    """[(moment, its file)] of one of SMALL, made when missing."""
    scene = SMALL[name]
    moments.make(name, scene, folder)
    return [(moment, moments.path_of(name, moment, scene, folder)) for moment in scene.moments]


def moved_by_yade(scene):
    """The snapshot after STEPS small steps of the scene of a file, with the cell's edges."""
    import in_yade
    from yade import O

    import contact_law

    loaded = scene_file.load(scene)
    in_yade.add_bodies(loaded)
    in_yade.start_engine(loaded, 50)
    O.run(STEPS // 50, True)
    return {**contact_law.snapshot(), "cell": list(O.cell.size) if O.periodic else [0, 0, 0]}


@pytest.mark.parametrize("name", list(SMALL))
def test_the_same_as_in_yade(name, folder, yade):
    """From a start, and from a moment whose contacts have springs: positions to 1e-12 radii, the same contacts."""
    for moment, path in files(name, folder):
        end = folder / "end.scene"
        codes.harness(path, steps=STEPS, out=end)
        ours, theirs = scene_file.load(end), yade(moved_by_yade, {"scene": str(path)})
        radius, speed = ours.grains["radius"][0], np.ptp(ours.grains["velocity"], axis=0).max()
        spin = np.abs(ours.grains["angularVelocity"]).max()
        scales = {"position": radius, "velocity": speed, "angularVelocity": spin}
        for (name, scale), name_there in zip(scales.items(), ("position", "velocity", "angular_velocity")):
            assert np.abs(ours.grains[name] - theirs[name_there]).max() <= 1e-12 * scale, (moment, name)
        pairs = np.column_stack([ours.contacts["first"], ours.contacts["second"]]), theirs["contact_pairs"]
        assert len({frozenset(map(tuple, np.sort(each, axis=1))) for each in pairs}) == 1, moment
        assert ours.contacts["bonded"].sum() == theirs["contact_bonded"].sum()
        assert ours.head["cellSize"] == pytest.approx(theirs["cell"], rel=1e-12)


def test_the_scenes_have_what_they_are_for(folder):
    """Drag forces, stretched contacts, a cell that has shrunk, broken bonds."""
    drag, cell, bonds = (scene_file.load(files(name, folder)[1][1]) for name in ("drag", "cell", "bonds"))
    assert np.abs(drag.contacts["drag"]).max() > 0 and drag.contacts["overlap"].min() < 0
    assert moments.filling_of(cell) == pytest.approx(0.03, rel=0.02) and len(cell.contacts) > 127
    assert 0 < bonds.contacts["bonded"].sum() < 126 and bonds.contacts["rest"].max() > 0


def test_fewer_threads_than_asked_for_give_the_same_bits(folder):
    """As OpenMP may: a limit of its own, or a machine that is busy."""
    path = files("drag", folder)[1][1]
    fewer = codes.harness(path, prefix=("env", "OMP_THREAD_LIMIT=1"), timeout=60, steps=50, threads=2)
    assert fewer[-1]["hash"] == codes.harness(path, steps=50, threads=2)[-1]["hash"]


@pytest.mark.parametrize("processor, best", [("Nehalem", "portable"), ("Haswell-noTSX", "avx2")])
def test_processors_without_the_newest_instructions_run_what_they_have(folder, processor, best):
    """Emulated ones, to which any other instruction is illegal."""
    emulator = shutil.which("qemu-x86_64") or shutil.which("qemu-x86_64-static")
    if not emulator:
        pytest.skip("no qemu-x86_64 (Debian's qemu-user)")
    path = files("drag", folder)[1][1]
    command = [emulator, "-cpu", processor, codes.HARNESS, path, "steps=50"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    end = json.loads(done.stdout.splitlines()[-1])
    assert end["instructions"] == best
    assert end["hash"] == codes.harness(path, steps=50, instructions=best)[-1]["hash"]


def test_what_is_compiled_for_an_instruction_set_is_taken_for_no_other():
    """Of a function that several files define the linker takes one, for all of them."""
    for name in ("avx2", "avx512"):
        listed = ["nm", "-C", "--defined-only", TOP / f"build/objects/engine/{name}.o"]
        symbols = subprocess.run(listed, check=True, capture_output=True, text=True).stdout.splitlines()
        shared = [line for line in symbols if line.split()[1] == "W" and f"{name}::Pack" not in line]
        assert len(symbols) > 50 and shared == []


def test_the_harness_refuses_bad_input_in_one_line(folder):
    path, short = files("drag", folder)[1][1], folder / "short.scene"
    short.write_bytes(path.read_bytes()[:-8])
    for arguments in (
        "none.scene",
        f"{path} steps=0",
        f"{path} colour=red",
        f"{path} instructions=mmx",
        f"{short}",
        "",
    ):
        done = subprocess.run([codes.HARNESS, *arguments.split()], capture_output=True, text=True)
        assert (done.returncode, done.stdout, done.stderr.count("\n")) == (1, "", 1), arguments


def test_the_bench_runs():
    """As little as possible, of every code that YADE runs."""
    done = subprocess.run(
        [sys.executable, codes.HERE / "bench.py", "--tiny"], capture_output=True, text=True, timeout=300
    )
    assert done.returncode == 0, done.stderr[-2000:]
    for code in measured_scenes.IN_YADE:
        assert f" {codes.CODES[code].name} " in done.stdout
    assert "order of convergence: ledger" in done.stdout
