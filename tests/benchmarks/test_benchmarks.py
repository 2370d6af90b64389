"""The engine without YADE (build/harness) moves grains to the same places, on any processor; the bench runs."""

import shutil
import subprocess
import sys

import codes
import measured_scenes
import numpy as np
import pytest
import scene_file
from measured_scenes import SMALL, make

STEPS = 300


@pytest.fixture(scope="module", autouse=True)
def harness_is_built():
    subprocess.run(["make", "build/harness"], cwd=codes.TOP, check=True, capture_output=True)


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("scenes")


@pytest.fixture
def with_drag(folder):
    """File of a collision in which many grains touch."""
    return make("drag", SMALL["drag"], folder)[1]["compressing"]


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
    for moment, path in make(name, SMALL[name], folder)[1].items():
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


@pytest.mark.parametrize("processor, best", [("Nehalem", "portable"), ("Haswell-noTSX", "avx2")])
def test_processors_without_the_newest_instructions_run_what_they_have(with_drag, processor, best):
    """Emulated ones, to which any other instruction is illegal."""
    emulator = shutil.which("qemu-x86_64") or shutil.which("qemu-x86_64-static")
    if not emulator:
        pytest.skip("no qemu-x86_64 (Debian's qemu-user)")
    emulated = codes.harness(with_drag, prefix=(emulator, "-cpu", processor), timeout=600, steps=50)
    assert emulated["instructions"] == best
    assert emulated["hash"] == codes.harness(with_drag, steps=50, instructions=best)["hash"]


def test_what_is_compiled_for_an_instruction_set_is_taken_for_no_other():
    """Of a function that several files define the linker takes one, for all of them."""
    for name in ("avx2", "avx512"):
        listed = ["nm", "-C", "--defined-only", codes.TOP / f"build/objects/engine/{name}.o"]
        symbols = subprocess.run(listed, check=True, capture_output=True, text=True).stdout.splitlines()
        shared = [line for line in symbols if line.split()[1] == "W" and f"{name}::Pack" not in line]
        assert len(symbols) > 50 and shared == []


def test_the_bench_runs():
    """As little as possible, of every code that YADE runs."""
    command = [sys.executable, codes.HERE / "bench.py", "--tiny"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=300)
    assert done.returncode == 0, done.stderr[-2000:]
    for code in measured_scenes.IN_YADE:
        assert f" {codes.CODES[code].title} " in done.stdout
    assert "order of convergence: ledger" in done.stdout
