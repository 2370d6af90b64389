"""LAMMPS and LIGGGHTS get the grains that the engine gets; one that is missing, unfit or broken is said and left out. Starts
of scenes are what they are said to be."""

from contextlib import ExitStack

import codes
import errors
import moments
import numpy as np
import peers
import pytest
import settings
import speed
import starts
from measured_scenes import EVERY, PAPERS, bench
from test_harness import SMALL

from yade_scripts import packings

TINY = bench(settings.TINY)
CELL = SMALL["cell"]


@pytest.mark.parametrize("code, scene", [("lammps", TINY["cpe-5"]), ("liggghts", TINY["cpe-5"]), ("lammps", CELL)])
def test_peers_run_the_scene(code, scene):
    """Where they are installed: all grains, and the contacts that this repository counts."""
    scene = starts.of(scene).scene
    if reason := peers.missing(code, scene):
        pytest.skip(reason)
    found = peers.measure(code, scene, 20, skin=0.6)
    touching = packings.contacts(packings.Packing(scene.grains["position"], scene.grains["radius"], 1))
    assert found["contacts"] == len(touching) and found["grains"] == len(scene.grains)
    assert speed.rate(found) > 1e5


@pytest.mark.parametrize("code", ["lammps", "liggghts"])
def test_the_time_of_a_peers_start_is_not_its_time(code, monkeypatch, tmp_path):
    """MPI alone takes half a second to start, in which the processor waits."""
    if reason := peers.missing(code):
        pytest.skip(reason)
    late = tmp_path / "late"
    late.write_text(f'#!/bin/sh\nsleep 2\nexec {peers.PROGRAMS[code]} "$@"\n')
    late.chmod(0o755)
    monkeypatch.setitem(peers.PROGRAMS, code, str(late))
    found = peers.measure(code, starts.of(TINY["cpe-5"]).scene, 2000)  # half a millisecond is too short for its clock
    assert found["seconds"] < 1 and not found["fraction"] < 0.3


def test_all_codes_ring_alike():
    """Where nothing is made, broken or slips: this law's two codes to rounding, the others to what their springs differ."""
    scene, kinetic = starts.rung(starts.of(TINY["cpe-5"]), 2e5), {}
    scene.head["step"] = errors.INTERVAL / 26
    for code in (code for code in EVERY if code != "liggghts" and not codes.missing(code, scene)):
        found = np.array(errors._follow(code, scene, 10, 26, settings.TINY)["kinetic"])
        kinetic[code] = found / found[0]
    assert kinetic["functors"] == pytest.approx(kinetic["engine"], abs=1e-6)
    assert all(found == pytest.approx(kinetic["engine"], abs=0.03) for found in kinetic.values())
    assert np.ptp(kinetic["engine"]) > 0.3


def test_they_get_the_cell_the_spins_and_room(tmp_path):
    scene = starts.of(CELL).scene
    scene.grains["angularVelocity"][3] = (1e9, 0, 0)
    peers.write_grains(tmp_path / "grains", scene)
    lines = (tmp_path / "grains").read_text().splitlines()
    low, high = (float(number) for number in next(line for line in lines if "xlo" in line).split()[:2])
    assert low == 0 and high == pytest.approx(float(scene.head["cellSize"][0]) / 1e-7)
    numbers = [lines.index(name) + 2 for name in ("Atoms", "Velocities")]
    position, spin = (np.array([line.split()[4:] for line in lines[at : at + 128]], float) for at in numbers)
    assert 0 <= position.min() and position.max() <= high
    assert spin[3] == pytest.approx([1, 0, 0]) and (spin[:3] == 0).all()
    flying = starts.of(TINY["cpe-5"]).scene
    lowest, highest = peers.box_of(flying)
    assert (highest == -lowest).all() and (highest > 2 * np.abs(flying.grains["position"]).max(axis=0) / 1e-7).all()


def test_what_a_peer_cannot_run_is_said(program):
    program("lmp", "echo granular")
    unfit = [(PAPERS["s17"], "it has no sintered bonds"), (TINY["cpe-5"], None)]
    unfit += [(TINY[kind], "it is measured on like grains only") for kind in ("materials", "radii")]
    for scene, reason in unfit:
        assert peers.missing("lammps", starts.of(scene).scene) == reason


def test_a_peer_that_fails_is_noted_and_not_tried_again(tmp_path, program):
    """As one does whose libraries are missing."""
    for name in ("lmp", "liggghts"):
        program(name, f"echo once >> {tmp_path}/{name}.calls; echo no such library >&2; exit 127")
    assert "pair_style granular" in codes.missing("lammps")
    start = moments.make("one", TINY["cpe-5"], tmp_path)
    place = speed.Place("one", TINY["cpe-5"], "flying", start, settings.TINY, tmp_path, ExitStack())
    place.measure("liggghts", 1), place.measure("liggghts", 1)
    assert (tmp_path / "liggghts.calls").read_text() == "once\n"
    notes = {row["code"]: row["note"] for row in place.rows()}
    assert notes["liggghts"].startswith("failed: ") and "no such library" in notes["liggghts"]


def test_two_sizes_start_at_rest():
    """Large and small grains of the rock salt, and large ones, overlap by the equilibrium overlap of their pair."""
    scene = starts.of(TINY["radii"]).scene
    position, radius = scene.grains["position"], scene.grains["radius"]
    small, large = np.unique(radius)
    distance = np.linalg.norm(position[:, None] - position[None], axis=2)
    ice = starts.collision.CollisionParameters.parse({})
    for first, second in ((large, large), (small, large)):
        overlap = first + second - distance[(radius[:, None] == first) & (radius[None] == second)]
        overlap = overlap[(overlap > 0) & (overlap < first)]  # the grain itself left out
        expected = starts.pair_constants(ice, (first, second))["equilibriumOverlap"]
        assert len(overlap) > 50 and np.median(overlap) == pytest.approx(expected, rel=1e-6)
    assert 0.3 < starts.of(TINY["materials"]).scene.grains["material"].mean() < 0.7


def test_the_scenes_of_the_papers_can_be_started(tmp_path):
    """The quick ones: moments in their order, numbers that the papers give, and flights that outlast their measurements."""
    found = {name: starts.of(PAPERS[name]) for name in ("s17", "k13-1024", "cpe-fast", "cpe")}
    for name, start in found.items():
        progress = list(start.progress.values())
        assert progress == sorted(progress) and progress[0] == 0 and progress[-1] <= 1
        first = next(iter(PAPERS[name].moments))
        moments.scene_file.save(moments.path_of(name, first, PAPERS[name], tmp_path), start.scene)
        most = speed.Place(name, PAPERS[name], first, start, settings.FULL, tmp_path, ExitStack()).most()
        within = PAPERS[name].apart or 0.06 * start.duration
        assert 0.5 * within < 2 * settings.FULL.rounds * most * start.step < within
    k13, s17 = found["k13-1024"], found["s17"].scene
    assert k13.scene.strain_rate * k13.time_unit == pytest.approx(-6e-7) and k13.scene.periodic
    assert k13.scene.grains["velocity"] == pytest.approx(k13.scene.strain_rate * k13.scene.grains["position"])
    assert s17.head["neck"] == 0.7 and np.ptp(s17.grains["position"][:, 2]) == 0 and len(s17.grains) == 2048
    assert np.ptp(s17.grains["velocity"][:, 0]) == pytest.approx(20)
