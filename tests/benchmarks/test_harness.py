"""The harness runs the engine as YADE does: the same grains after the same steps, whatever the scene; any number of threads, the same bits."""

import json
import shutil
import subprocess
import sys
from dataclasses import replace

import codes
import moments
import numpy as np
import pytest
import scene_file
from measured_on import TOP
from measured_scenes import Scene

STEPS = 300

# Small ones of the papers' kinds: drag; a periodic cell with damping; sintered bonds in a plane, some of which break.
DRAG = {"packing": "bpca", "grains": 300, "velocity": 60, "viscoelasticTime": "6e-12", "stepFraction": 0.2}
CELL = {"grains": 128, "strainRate": "3e-6", "stepFraction": 0.3, "finalFilling": 0.1}
BONDS = {"packing": "bcca", "grains": 64, "planar": 1, "neck": 0.3, "velocity": 60, "stepFraction": 0.1}
SMALL = {
    "drag": Scene("", "collision", DRAG, {"flying": 0.0, "compressing": 30e-9}),
    "cell": Scene("", "compression", CELL, {"start": None, "denser": 0.03}),
    "bonds": Scene("", "collision", BONDS, {"flying": 0.0, "broken": 60e-9}),
}


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
    import yade_scene
    from yade.wrapper import Omega

    import contact_law

    omega, loaded = Omega(), scene_file.load(scene)
    yade_scene.add_bodies(loaded)
    yade_scene.start_engine(loaded, 50)
    for _ in range(STEPS // 50):
        omega.step()
    return {**contact_law.snapshot(), "cell": list(omega.cell.size) if omega.periodic else [0, 0, 0]}


@pytest.mark.parametrize("name", list(SMALL))
def test_the_same_as_in_yade(name, folder, yade):
    """From a start without contacts, and from a moment whose contacts have springs: positions to 1e-12 of a radius, the same contacts."""
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
    """Drag forces, stretched contacts, a cell that has shrunk, broken bonds: otherwise the comparison would show nothing of them."""
    drag, cell, bonds = (scene_file.load(files(name, folder)[1][1]) for name in ("drag", "cell", "bonds"))
    assert np.abs(drag.contacts["drag"]).max() > 0 and drag.contacts["overlap"].min() < 0
    assert moments.filling_of(cell) == pytest.approx(0.03, rel=0.02) and len(cell.contacts) > 127
    assert 0 < bonds.contacts["bonded"].sum() < 126 and bonds.contacts["rest"].max() > 0


def test_as_many_threads_as_wanted_give_the_same_bits_and_what_is_printed(folder):
    path = files("drag", folder)[1][1]
    hashes = {codes.harness(path, steps=200, domains=8, threads=n)[-1]["hash"] for n in (1, 2, 3, 8)}
    assert len(hashes) == 1
    assert codes.harness(path, steps=250, domains=8)[-1]["hash"] not in hashes
    how = {"steps": 100, "threads": "1,2,1,2", "domains": 4, "instructions": "portable"}
    *measured, end = codes.harness(files("drag", folder)[1][1], **how)
    assert [m["threads"] for m in measured] == [1, 2, 1, 2]
    assert all(m["msPerStep"] > 0 and m["steps"] == 100 and m["contacts"] > 500 for m in measured)
    assert end["instructions"] == "portable" and end["domains"] == 4 and end["grains"] == 600
    assert abs(end["energyChange"]) < 1e-3 * end["kinetic"]
    assert end["time"] == pytest.approx(30e-9 + 400 * 0.2 * 1.9365e-10, rel=0.05)


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


def test_files_come_back_as_they_were_and_are_made_once(folder):
    path = files("cell", folder)[1][1]
    scene_file.save(folder / "copy.scene", scene_file.load(path))
    assert (folder / "copy.scene").read_bytes() == path.read_bytes()
    made = path.stat().st_mtime_ns
    assert files("cell", folder)[1][1].stat().st_mtime_ns == made
    assert not [one for one in folder.iterdir() if one.suffix in (".fast", ".own", ".new", ".begin")]
    (folder / "head").write_bytes(b"JKRscene")
    with pytest.raises(ValueError, match="must be a scene of format 1"):
        scene_file.load(folder / "head")


BAD = {
    "none.scene": "none.scene: must be a scene that",
    "{path} steps=0": "steps = 0: must be a whole number of at least 1",
    "{path} threads=1,x": "threads = x: must be a whole number",
    "{path} colour=red": "colour=red: no such parameter",
    "{path} instructions=mmx": "instructions = 'mmx': must be",
    "{short}": "must be as long as its head says",
    "": "no scene: must be given first",
}


def test_bad_input_is_refused_in_one_line(folder):
    path, short = files("drag", folder)[1][1], folder / "short.scene"
    short.write_bytes(path.read_bytes()[:-8])
    for arguments, words in BAD.items():
        command = [codes.HARNESS, *arguments.format(path=path, short=short).split()]
        done = subprocess.run(command, capture_output=True, text=True)
        assert (done.returncode, done.stdout, done.stderr.count("\n")) == (1, "", 1) and words in done.stderr


def test_a_run_that_breaks_down_says_so_and_another_strain_rate_brings_its_mean_flow(folder):
    path = files("drag", folder)[0][1]
    scene = scene_file.load(path)
    grains = scene.grains.copy()
    grains["velocity"][0] = (1e5, 0, 0)
    scene_file.save(folder / "wild.scene", replace(scene, grains=grains))
    with pytest.raises(codes.CodeFailed, match="the run broke down: grain 0 moves at "):
        codes.harness(folder / "wild.scene", steps=10)
    scene = scene_file.load(files("cell", folder)[1][1])
    faster = scene.with_strain_rate(2 * scene.strain_rate)
    flow = scene.strain_rate * scene.grains["position"]
    assert faster.grains["velocity"] - scene.grains["velocity"] == pytest.approx(flow)
    assert (faster.strain_rate == 2 * scene.strain_rate).all()
    assert sys.byteorder == "little"  # as the files are
