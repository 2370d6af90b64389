"""LAMMPS and LIGGGHTS get the grains that the engine gets, and a peer that is missing, unfit or broken is said and left out."""

import os

import codes
import moments
import numpy as np
import peers
import pytest
import scene_file
import settings
import speed
import starts
from measured_scenes import PAPERS, Scene, bench

from yade_scripts import packings

CELL = Scene(
    "a small cell",
    "compression",
    {"grains": 128, "strainRate": "3e-6", "stepFraction": 0.3, "finalFilling": 0.1},
    {"start": None},
)
OPEN = bench(settings.TINY)["cpe-5"]


def touching(scene):
    """Number of pairs of grains of a SceneFile that overlap."""
    return len(packings.contacts(packings.Packing(scene.grains["position"], scene.grains["radius"], 1)))


@pytest.mark.parametrize("code, scene", [("lammps", OPEN), ("liggghts", OPEN), ("lammps", CELL)])
def test_peers_run_the_scene(code, scene):
    """Where they are installed: all grains, and the contacts that this repository counts."""
    scene = starts.of(scene).scene
    if reason := peers.missing(code, scene):
        pytest.skip(reason)
    found = peers.measure(code, scene, 20, skin=0.6)
    assert found["contacts"] == touching(scene) and found["grains"] == len(scene.grains)
    assert found["contacts"] * found["steps"] / found["seconds"] > 1e5


def test_they_get_the_cell_the_spins_and_room(tmp_path):
    scene = starts.of(CELL).scene
    scene.grains["angularVelocity"][3] = (1e9, 0, 0)
    peers.write_grains(tmp_path / "grains", scene)
    lines = (tmp_path / "grains").read_text().splitlines()
    low, high = (float(number) for number in next(line for line in lines if "xlo" in line).split()[:2])
    assert low == 0 and high == pytest.approx(float(scene.head["cellSize"][0]) / 1e-7)
    numbers = {name: lines.index(name) + 2 for name in ("Atoms", "Velocities")}
    position, spin = (np.array([line.split()[4:] for line in lines[at : at + 128]], float) for at in numbers.values())
    assert 0 <= position.min() and position.max() <= high
    assert spin[3] == pytest.approx([1, 0, 0]) and (spin[:3] == 0).all()
    flying = starts.of(OPEN).scene
    lowest, highest = peers.box_of(flying)
    assert (highest == -lowest).all() and (highest > 2 * np.abs(flying.grains["position"]).max(axis=0) / 1e-7).all()


def test_what_a_peer_cannot_run_is_said(monkeypatch, tmp_path):
    for program in ("lmp", "liggghts"):
        (tmp_path / program).write_text("#!/bin/sh\necho granular\n")
        (tmp_path / program).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    assert peers.missing("lammps", starts.of(OPEN).scene) is None
    assert peers.missing("lammps", starts.of(PAPERS["s17"]).scene) == "it has no sintered bonds"
    for kind in ("materials", "radii"):
        assert (
            peers.missing("liggghts", starts.of(bench(settings.TINY)[kind]).scene)
            == "it is measured on like grains only"
        )


def test_a_peer_that_fails_is_noted_and_not_tried_again(tmp_path, monkeypatch):
    """A program of that name that only fails, as one does whose libraries are missing."""
    for name in ("lmp", "liggghts"):
        (tmp_path / name).write_text(f"#!/bin/sh\necho once >> {tmp_path}/calls; echo no such library >&2; exit 127\n")
        (tmp_path / name).chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}:{os.environ['PATH']}")
    assert "pair_style granular" in codes.missing("lammps")
    scene = Scene("", "collision", OPEN.parameters, apart=OPEN.apart, codes=("liggghts",))
    start = moments.make("one", scene, tmp_path)
    place = speed.Place("one", scene, "flying", start, settings.TINY, tmp_path)
    place.open["liggghts", 1] = codes.PeerCode("liggghts", place.path, settings.TINY)
    place.measure("liggghts", 1), place.measure("liggghts", 1)
    assert (tmp_path / "calls").read_text().count("once") == 2  # lammps's help, and one run
    (row,) = place.rows()
    assert row["code"] == "liggghts" and row["note"].startswith("failed: ") and "no such library" in row["note"]


def test_two_sizes_start_at_rest():
    """Large and small grains of the rock salt, and large ones, overlap by the equilibrium overlap of their pair; the softer material is half of the grains."""
    scene = starts.of(bench(settings.TINY)["radii"]).scene
    position, radius = scene.grains["position"], scene.grains["radius"]
    small, large = np.unique(radius)
    distance = np.linalg.norm(position[:, None] - position[None], axis=2)
    ice = starts.collision.CollisionParameters.parse({})
    for first, second in ((large, large), (small, large)):
        overlap = first + second - distance[(radius[:, None] == first) & (radius[None] == second)]
        overlap = overlap[(overlap > 0) & (overlap < first)]  # the grain itself left out
        expected = starts.pair_constants(ice, (first, second))["equilibriumOverlap"]
        assert len(overlap) > 50 and np.median(overlap) == pytest.approx(expected, rel=1e-6)
    two = starts.of(bench(settings.TINY)["materials"]).scene
    assert 0.3 < two.grains["material"].mean() < 0.7 and len(np.unique(two.materials)) == 2


def test_every_scene_of_the_papers_can_be_started():
    """The quick ones are made; of all: moments in their order, names and numbers that the papers give."""
    for name in ("s17", "k13-1024", "cpe-fast", "cpe"):
        start = starts.of(PAPERS[name])
        progress = list(start.progress.values())
        assert progress == sorted(progress) and progress[0] == 0 and progress[-1] <= 1 and not len(start.scene.contacts)
    k13 = starts.of(PAPERS["k13-1024"])
    assert k13.scene.strain_rate * k13.time_unit == pytest.approx(-6e-7) and k13.scene.periodic
    assert k13.scene.grains["velocity"] == pytest.approx(k13.scene.strain_rate * k13.scene.grains["position"])
    s17 = starts.of(PAPERS["s17"]).scene
    assert s17.head["neck"] == 0.7 and np.ptp(s17.grains["position"][:, 2]) == 0 and len(s17.grains) == 2048
    assert np.ptp(s17.grains["velocity"][:, 0]) == pytest.approx(20)


def test_measuring_leaves_a_flight_in_the_air(tmp_path):
    """All measurements of a round's codes together are shorter than the flight, and of a later moment a small part of the run."""
    for name in ("cpe", "a22-slow"):
        scene = PAPERS[name]
        start = (
            starts.of(scene)
            if name == "cpe"
            else starts.of(Scene("", "collision", {**scene.parameters, "grains": 100}, apart=scene.apart))
        )
        path = moments.path_of(name, "flying", scene, tmp_path)
        scene_file.save(path, start.scene)
        place = speed.Place(name, scene, "flying", start, settings.FULL, tmp_path)
        assert 0.5 * scene.apart < 2 * settings.FULL.rounds * place.most() * start.step < scene.apart
