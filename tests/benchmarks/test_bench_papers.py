"""make bench-papers works: small scenes of the papers' kinds measured once, and what the report makes of the numbers."""

import json
import re
import shutil
import subprocess
import sys
from pathlib import Path

import bench_papers
import engine_parts
import measured_scenes
import numpy as np
import paper_moments
import paper_report
import paper_scenes
import paper_speed
import peers
import pytest
import scene_file
from measured_on import TOP
from paper_moments import Moment
from paper_scenes import PaperScene

HERE = Path(__file__).resolve().parent
LITTLE = paper_speed.Settings(rounds=2, seconds=0.02, stretch=0.5, peer_steps=10, skins=(0.3, 0.6), sampled=0.2)
SCENE = PaperScene(
    "a small cell",
    "compression",
    {"grains": 128, "strainRate": "3e-6", "stepFraction": 0.3, "finalFilling": 0.1},
    {"start": None, "denser": 0.05},
)


@pytest.fixture(scope="module")
def measured(tmp_path_factory):
    """(folder, found as papers.json holds it): both moments of SCENE."""
    subprocess.run(["make", "build/harness"], cwd=TOP, check=True, capture_output=True)
    folder = tmp_path_factory.mktemp("papers")
    paper_scenes.make("small", SCENE, folder, say=lambda *_, **__: None)
    moments = {name: paper_speed.measure("small", name, LITTLE, None, SCENE, folder) for name in SCENE.moments}
    return folder, {"machine": {"cpu": "a processor", "cores": 2}, "scenes": {"small": moments}}


def test_a_moment_is_measured(measured):
    for result in measured[1]["scenes"]["small"].values():
        engine = result["engine"]
        assert [turn["threads"] for turn in engine["turns"]] == [1, 2] * LITTLE.rounds
        assert engine["grains"] == 128 and 127 <= engine["contacts"] < 400
        steps = sum(turn["steps"] for turn in engine["turns"])
        assert engine["contactUpdates"] == pytest.approx(steps * engine["contacts"], rel=0.02)
        assert engine["searches"] >= 0 and engine["looks"] >= 0
        if shutil.which("lmp"):
            assert result["lammps"]["1"]["msPerStep"] > 0 and result["lammps"]["1"]["skin"] in LITTLE.skins
        else:
            assert "lmp is not installed" in result["lammps"]["missing"]
        assert result["parts"] is None or sum(result["parts"].values()) == pytest.approx(1)
    dense = measured[1]["scenes"]["small"]["denser"]["engine"]
    assert abs(dense["energyChange"]) < 0.02 * abs(dense["boundaryWork"]) != 0


def test_files_that_are_there_are_not_made_again(measured):
    paths = [paper_scenes.path_of("small", name, SCENE, measured[0]) for name in SCENE.moments]
    before = [path.stat().st_mtime_ns for path in paths]
    paper_scenes.make("small", SCENE, measured[0])
    assert [path.stat().st_mtime_ns for path in paths] == before
    assert sorted(measured[0].iterdir()) == sorted(paths)


def test_the_report_holds_what_was_measured(measured):
    text = paper_report.text(measured[1])
    assert text.startswith("\n## Scenes of the papers\n") and text.count("| small | start |") >= 2
    assert re.search(
        r"\| start 0\.\d\d, denser 0\.\d\d \| 0\.3 \| 4\.14e\+05 \|", text
    )  # weights, and steps of the run
    lines = [line for line in text.splitlines() if line.startswith("|")]
    widths = [line.count("|") for line in lines]
    assert all(a == b for a, b, line in zip(widths, widths[1:], lines[1:]) if not line.startswith("| scene"))
    assert re.search(r"\| \d\.\de-\d\d \|$", lines[-4])  # the ledger's error


def result(ms, contacts=1000, progress=0.0, steps=10_000, lammps=None):
    """As paper_speed.measure gives it; ms: {threads: [ms a step]}"""
    turns = [
        {"threads": n, "seconds": 0.1 * one, "steps": 100, "contacts": contacts, "fraction": 1.0}
        for n, each in ms.items()
        for one in each
    ]
    engine = {"grains": 500, "contacts": contacts, "turns": turns, "commit": "c" * 40, "boundaryWork": 0.0}
    engine.update(searches=0, looks=4, events=900, formed=200, broken=100, contactUpdates=200_000)
    engine.update(energyChange=1e-6, kinetic=1.0)
    run = {"steps": steps, "step": 0.2, "progress": progress}
    return {
        "engine": engine,
        "parts": None,
        "lammps": lammps or {"missing": "it is not here"},
        "run": run,
        "settings": {"skins": [0.3]},
    }


def test_numbers_of_a_moment():
    lammps = {"2": {"msPerStep": 20.0, "contacts": 2000, "skin": 0.6}}
    moment = Moment("a22", "flying", result({1: [2.0, 2.5], 2: [1.0, 1.25]}, lammps=lammps))
    assert moment.best(1) == 2.0 and moment.median(2) == pytest.approx(1.125)
    assert moment.rate(2).most == pytest.approx(1.0)  # 1000 contacts in a ms
    assert moment.against_lammps(2).most == pytest.approx(10) and moment.against_lammps(1) is None


def test_time_to_solution_weighs_the_moments():
    """Moments at 0, 0.2 and 0.6 of the run stand for 0.1, 0.3 and 0.6 of its steps; a run with a moment missing has no time."""
    ms = {"flying": (0.0, 1.0), "compressing": (0.2, 3.0), "later": (0.6, 2.0)}
    moments = [Moment("small", name, result({1: [one], 2: [one / 2]}, progress=at)) for name, (at, one) in ms.items()]
    assert paper_moments.weights(moments) == pytest.approx([0.1, 0.3, 0.6])
    assert paper_moments.minutes(moments, lambda m: m.median(1)) == pytest.approx(10_000 * 2.2 / 60e3)
    assert paper_moments.minutes(moments, lambda m: m.lammps(1)) is None
    of_a22 = [Moment("a22", one.name, one.found) for one in moments]
    assert paper_moments.minutes(of_a22, lambda m: m.median(1)) is None  # without its fragments


def test_the_section_of_a_report_by_hand():
    found = {"machine": {"cpu": "a processor", "cores": 2}, "scenes": {}}
    each = {
        name: result({1: [2.0], 2: [1.0]}, progress=time / 6.34e-6, steps=163_695)
        for name, time in paper_scenes.SCENES["a22"].moments.items()
    }
    found["scenes"]["a22"] = each
    found["scenes"]["k13"] = {"phi 0.03": result({1: [2.0], 2: [1.0]})}
    found["scenes"]["a22-slow"] = {"flying": result({1: [2.0], 2: [0.8]})}
    text = paper_report.text(found)
    assert (
        "| minutes for a run, A22: two BPCA of 50,000 at 50.1 m/s, B_off 0.5 | below 6 | 2.73 (2.73 - 2.73) | **reached** |"
        in text
    )
    assert (
        "| flying at 50.1 m/s / the same grains at 0.5 m/s | at least 0.9 | 0.80 (0.80 - 0.80) | not reached |" in text
    )
    assert "| > 200 | 2e-05 | - | - | - | 0.3 | 1 | 0.5 | 1.0e-06 |" in text  # lists, parts, slips, events, ledger
    assert "LAMMPS was not measured where it is not here." in text


def test_the_section_replaces_its_own_place():
    first = paper_report.with_section("# Bench\n\nSpeed.\n", f"\n{paper_report.TITLE}\n\nold\n")
    assert paper_report.with_section(first, f"\n{paper_report.TITLE}\n\nnew\n") == (
        f"# Bench\n\nSpeed.\n\n{paper_report.TITLE}\n\nnew\n"
    )
    assert paper_report.with_section("Speed.\n", "") == "Speed.\n"


def test_only_another_plugin_or_setting_is_measured_again(monkeypatch, tmp_path):
    (tmp_path / "build").mkdir()
    monkeypatch.setattr(bench_papers, "TOP", tmp_path)
    done = {**result({1: [1.0]}), "settings": paper_speed.settings_of(LITTLE)}
    for commit, wanted in (("c" * 40, True), ("d" * 40, False), ("c" * 40 + "-changed", False)):
        (tmp_path / "build/commit.list").write_text(commit + "\n")
        assert bench_papers.is_done(done, LITTLE) == wanted
    (tmp_path / "build/commit.list").write_text("c" * 40)
    assert not bench_papers.is_done(done, paper_speed.FULL) and not bench_papers.is_done(None, LITTLE)


def test_measuring_resumes(monkeypatch, tmp_path, capsys):
    """A stop after the first moment: what was measured is kept, and measured no more; moments without a file are named."""
    commit = (TOP / "build/commit.list").read_text().strip()
    asked = []

    def measure(name, moment, settings, begin):
        assert begin == "begin of small"
        asked.append(moment)
        if len(asked) == 2:
            raise KeyboardInterrupt
        found = result({1: [1.0], 2: [1.0]})
        found["engine"]["commit"] = commit.removesuffix("-changed")
        return {**found, "settings": paper_speed.settings_of(settings)}

    here = {"start": tmp_path / "a", "denser": tmp_path / "b", "densest": tmp_path / "none"}
    here["start"].touch(), here["denser"].touch()
    scene = PaperScene("", "compression", {}, dict.fromkeys(here))
    monkeypatch.setattr(paper_scenes, "SCENES", {"small": scene})
    monkeypatch.setattr(paper_scenes, "path_of", lambda name, moment: here[moment])
    monkeypatch.setattr(paper_scenes, "start_of", lambda scene: "begin of small")
    monkeypatch.setattr(paper_speed, "measure", measure)
    monkeypatch.setattr(bench_papers, "is_done", lambda result, settings: bool(result))
    with pytest.raises(KeyboardInterrupt):
        bench_papers.measure(["small"], LITTLE, tmp_path, again=False)
    bench_papers.measure(["small"], LITTLE, tmp_path, again=False)
    assert asked == ["start", "denser", "denser"]
    assert list(json.loads((tmp_path / "papers.json").read_text())["scenes"]["small"]) == ["start", "denser"]
    assert "small, densest: has no file yet" in capsys.readouterr().out


PERF = """
    53.52%  harness            [.] contact_law::Passes<contact_law::avx512::Pack>::forces<7u, true, false>       -      -
    12.00%  harness            [.] contact_law::PairLists::findDue                                             -      -
     4.00%  harness            [.] contact_law::ContactList::sort                                                -      -
     4.48%  harness            [.] contact_law::avx512::integrate                                                -      -
     6.00%  libc.so.6          [.] __memmove_avx512_unaligned_erms                                               -      -
"""


def test_parts_of_the_time():
    assert engine_parts.parts_of_report(PERF) == pytest.approx(
        {"forces": 0.669, "lists": 0.2, "events": 0, "integration": 0.056, "other": 0.075}
    )
    assert engine_parts.parts_of_report("nothing\n") is None


def test_every_scene_of_the_papers_can_be_started():
    """The quick ones are made; of all: moments in their order, names and numbers that the papers give."""
    for name in ("s17", "k13-1024", "cpe-fast", "cpe"):
        begin = paper_scenes.start_of(paper_scenes.SCENES[name])
        progress = list(begin.progress.values())
        assert (
            progress == sorted(progress) and progress[0] == 0 and progress[-1] <= 1 and len(begin.scene.contacts) == 0
        )
        if begin.scene.head["cellSize"][0] == 0:  # a flight as long as measuring it takes
            assert paper_scenes.SCENES[name].apart > 1.2 * paper_speed.FULL.stretch * begin.duration
    for name in ("a22", "a22-drag", "a22-slow"):
        assert paper_scenes.SCENES[name].apart > 1.2 * paper_speed.FULL.stretch * 6.34e-6
    k13 = paper_scenes.start_of(paper_scenes.SCENES["k13-1024"])
    assert k13.scene.strain_rate * k13.time_unit == pytest.approx(-6e-7) and k13.scene.periodic
    assert k13.scene.grains["velocity"] == pytest.approx(k13.scene.strain_rate * k13.scene.grains["position"])
    s17 = paper_scenes.start_of(paper_scenes.SCENES["s17"]).scene
    assert s17.head["neck"] == 0.7 and np.ptp(s17.grains["position"][:, 2]) == 0 and len(s17.grains) == 2048
    assert np.ptp(s17.grains["velocity"][:, 0]) == pytest.approx(20)


def test_lammps_gets_the_cell_and_the_spins(tmp_path):
    begin = paper_scenes.start_of(SCENE).scene
    begin.grains["angularVelocity"][3] = (1e9, 0, 0)
    peers.write_grains(tmp_path / "grains", paper_speed.scene_of_peers(begin))
    lines = (tmp_path / "grains").read_text().splitlines()
    edge = float(begin.head["cellSize"][0]) / 1e-7
    low, high = (float(number) for number in next(line for line in lines if "xlo" in line).split()[:2])
    assert low == 0 and high == pytest.approx(edge)
    atoms = lines.index("Atoms") + 2
    position = np.array([[float(x) for x in line.split()[4:]] for line in lines[atoms : atoms + 128]])
    assert 0 <= position.min() and position.max() <= edge
    spin = np.array([[float(x) for x in line.split()[4:]] for line in lines[lines.index("Velocities") + 2 :]])
    assert spin[3] == pytest.approx([1, 0, 0]) and (spin[:3] == 0).all()


def test_lammps_runs_a_periodic_scene():
    """Where it is installed: all grains, and the contacts that this repository counts."""
    if reason := peers.missing("lammps"):
        pytest.skip(reason)
    scene = paper_speed.scene_of_peers(paper_scenes.start_of(SCENE).scene)
    found = peers.measure("lammps", scene, 10, skin=0.6)
    assert found["grains"] == 128 and found["contacts"] == measured_scenes.touching(scene)


def test_peers_of_the_bench_stay_in_open_space(tmp_path):
    scene = measured_scenes.make("uniform", 4)
    peers.write_grains(tmp_path / "grains", scene)
    text = (tmp_path / "grains").read_text()
    assert f"-{2 * abs(scene.position).max() / 1e-7} " in text


@pytest.mark.parametrize(
    "arguments, words",
    [
        (["--scene", "a22,a23"], "--scene a23: must be of a22, a22-drag"),
        (["--only", "bake"], "--only bake: must be of make, measure, report"),
    ],
)
def test_what_is_unknown_is_refused(arguments, words):
    command = [sys.executable, str(HERE / "bench_papers.py"), *arguments]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 2 and words in done.stderr


def test_a_report_of_nothing_is_refused(tmp_path):
    command = [sys.executable, str(HERE / "bench_papers.py"), "--only", "report", "--out", str(tmp_path)]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 1 and "holds no measurement: must be measured first" in done.stderr
    assert not (tmp_path / "bench.md").exists()


def test_no_scene_file_is_refused(tmp_path):
    (tmp_path / "x").write_bytes(b"JKRscene")
    with pytest.raises(ValueError, match="must be a scene of format 1"):
        scene_file.load(tmp_path / "x")
