"""The bench works: everything measured once, as little as possible; what is not installed is said and left out; what was measured stays and is reported."""

import os
import re
import subprocess
import sys
from dataclasses import replace
from pathlib import Path

import bench
import engine_parts
import errors
import measured_scenes
import moments
import numpy as np
import pandas as pd
import pytest
import report
import settings
import speed
import step_choice_report
from measured_on import RESULTS, TOP
from results import COLUMNS, Results, Spread, weights
from settings import FULL, TINY
from step_choice_data import COLLISIONS, COMPRESSIONS
from targets import Target

HERE = Path(__file__).resolve().parent
CELL = measured_scenes.Scene(
    "a small cell",
    "compression",
    {"grains": 128, "strainRate": "3e-6", "stepFraction": 0.3, "finalFilling": 0.1},
    {"start": None, "denser": 0.05},
)
LITTLE = replace(TINY, stretch=0.5, peer_steps=10)


def run_bench(*arguments, **environment):
    command = [sys.executable, str(HERE / "bench.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment}, timeout=300)


@pytest.fixture(scope="module", autouse=True)
def harness_is_built():
    subprocess.run(["make", "build/harness"], cwd=TOP, check=True, capture_output=True)


@pytest.fixture(scope="module")
def tiny(tmp_path_factory):
    """(what was printed, folder, Results) of a run without the peers, which a machine may lack: the PATH has YADE only."""
    folder = tmp_path_factory.mktemp("bench")
    (folder / "bin").mkdir()
    for program in ("yade", "git"):
        (folder / "bin" / program).symlink_to(f"/usr/bin/{program}")
    done = run_bench("--tiny", "--out", folder / "out", PATH=str(folder / "bin"))
    assert done.returncode == 0, done.stderr[-2000:]
    return done.stdout, folder / "out", Results(folder / "out")


def test_measures_everything_and_says_what_it_goes_without(tiny):
    printed, folder, results = tiny
    for program in ("lmp", "liggghts"):
        assert f"{program} is not installed (make bench-peers installs it)" in printed
    measured = results.speed[results.speed.rate > 0]
    expected = {("cpe-4", "engine", n) for n in (1, 2)} | {
        (kind, "engine", n) for kind in ("materials", "radii", "through-60") for n in (1, 2)
    }
    expected |= {("cpe-5", code, n) for code in ("engine", "functors", "stock") for n in (1, 2)}
    expected |= {("cpe-5", f"engine-{name}", 1) for name in ("avx2", "portable")}
    assert set(zip(measured.scene, measured.code, measured.threads)) == expected
    assert set(measured[measured.code == "engine-portable"].version) == {"portable"}
    assert set(results.speed[results.speed.note.notna()].code) == {"lammps", "liggghts"}
    assert list(results.moments[results.moments.scene == "through-60"].moment) == ["flying", "4 ns", "8 ns"]
    assert all((folder / name).stat().st_size > 10000 for name in ("bench-speed.png", "bench-error.png"))
    page = (folder / "bench.md").read_text()
    assert page in printed
    for words in (
        "/ LAMMPS, one core | at least 10 | - | not measured |",
        "two materials / like grains",
        "memory, bytes a contact",
        "## Through a collision",
    ):
        assert words in page


def test_every_code_counts_the_same_contacts(tiny):
    found = tiny[2].speed.query("scene == 'cpe-5' and rate > 0")
    assert set(found.contacts) == {tiny[2].moments.set_index("scene").contacts["cpe-5"]} and len(found) == 16


def test_half_a_time_unit_is_shown_as_refused(tiny):
    found = tiny[2].error.set_index(["scene", "step"]).sort_index()
    assert "must be > 0 and <= 0.4" in found.refused["collision", 0.5].iloc[0]
    assert "must be above 0 and below" in found.refused["pair", 0.5].iloc[0]
    assert found.rebound["pair", 0.4].notna().sum() == TINY.gaps
    assert "- 0.5 t0, collision: stepFraction = 0.5" in (tiny[1] / "bench.md").read_text()


@pytest.fixture(scope="module")
def cell(tmp_path_factory):
    """(folder, Results): both moments of CELL, each in its batch."""
    folder, scenes = tmp_path_factory.mktemp("cell"), {"cell": CELL}
    start = moments.make("cell", CELL, folder, say=lambda *_, **__: None)
    results, measured = Results(folder), []
    for batch in speed.batches(scenes):
        results.put(**speed.measure(batch, {"cell": start}, LITTLE, lambda: measured.append(1), folder))
    assert len(measured) == sum(speed.count_of(batch, LITTLE) for batch in speed.batches(scenes))
    return folder, results


def test_moments_are_measured(cell):
    table = cell[1].moments.set_index("moment")
    assert (
        list(table.index) == ["start", "denser"]
        and (table.grains == 128).all()
        and table.contacts.between(127, 400).all()
    )
    assert table.contactUpdates.to_numpy() == pytest.approx(table.measuredSteps * table.contacts, rel=0.02)
    assert abs(table.energyChange["denser"]) < 0.02 * abs(table.boundaryWork["denser"]) != 0
    parts = table[["lists", "forces", "eventHandling", "integration", "other"]].sum(axis=1)
    assert all(total == 0 or total == pytest.approx(1) for total in parts)  # 0: perf cannot sample here
    for moment in CELL.moments:
        assert list(cell[1].of("cell", moment, "engine", 2).index) == [0, 1]
        lammps = cell[1].speed.query("moment == @moment and code == 'lammps'")
        assert (lammps.skin == 0.6).all() if lammps.note.isna().all() else lammps.note.str.contains("lmp is not").all()


def test_compressions_are_measured_against_the_step():
    rows = pd.DataFrame(errors.measure("compression", replace(TINY, compression_seeds=(1,))), columns=COLUMNS["error"])
    for quantity in ("ledger", "ledgerThin"):
        steps, error = errors.curve(rows, quantity)
        slope, wrong = errors.order(steps, error, (0.05, 0.36))
        assert list(steps) == list(errors.COMPRESSION_STEPS) and slope == pytest.approx(2, abs=0.3 + 2 * wrong)
    assert errors.curve(rows, "workThin")[1].max() < 0.02


def test_what_is_done_is_not_measured_again(monkeypatch, tmp_path):
    """Real measurements; only the commit that is built is said to be that of an unchanged tree."""
    scenes = {"cpe-4": measured_scenes.bench(TINY)["cpe-4"]}
    monkeypatch.setattr(moments, "FOLDER", tmp_path)
    start = moments.make("cpe-4", scenes["cpe-4"], tmp_path)
    results = Results(tmp_path)
    results.put(**speed.measure(*speed.batches(scenes), {"cpe-4": start}, TINY, lambda: None, tmp_path))
    seconds = list(results.speed.seconds)
    monkeypatch.setattr(bench, "built_commit", lambda: results.moments.commit[0].removesuffix("-changed"))
    results.put(moments=results.moments.assign(commit=bench.built_commit()).to_dict("records"))
    bench.measure_speed(scenes, TINY, results, again=False)
    assert list(results.speed.seconds) == seconds
    place = {"scene": "cpe-4", "moment": "flying"}
    about = {"commit": bench.built_commit(), "settings": TINY.text()}
    assert results.is_done(**place, **about)
    for changed in ({"commit": "d" * 40}, {"settings": FULL.text()}, {"moment": "later"}):
        assert not results.is_done(**{**place, **about, **changed})


def test_what_was_measured_stays(tmp_path):
    """Rows of the same scene and moment are replaced, others kept, to the last bit."""
    results = Results(tmp_path)
    results.put(
        speed=[{"scene": name, "moment": "flying", "rate": rate} for name, rate in (("a", 0.1 + 0.2), ("b", 1 / 3))]
    )
    results.put(
        speed=[{"scene": "b", "moment": "flying", "rate": 2 / 3}, {"scene": "b", "moment": "later", "rate": 1.0}]
    )
    assert list(Results(tmp_path).speed.rate) == [0.1 + 0.2, 2 / 3, 1.0]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["speed.csv"]


@pytest.mark.parametrize("folder", [RESULTS, RESULTS / "epyc-zen5"], ids=lambda folder: folder.name)
def test_the_page_is_that_of_the_tables(folder):
    page = report.text(Results(folder), FULL)
    assert (folder / "bench.md").read_text() == page
    for table in page.split("\n\n"):
        assert len({line.count("|") for line in table.splitlines() if line.startswith("|")}) <= 1


def test_step_choice_is_that_of_its_tables(tmp_path):
    assert (RESULTS / "step_choice.md").read_text() == step_choice_report.text()
    for table in (COLLISIONS, COMPRESSIONS):
        copy = replace(table, path=tmp_path / "copy.csv")
        copy.path.write_text(table.path.read_text())
        copy.write(copy.read())
        assert copy.path.read_text() == table.path.read_text()


def results_of(folder, rates, **moments):
    """Results with these rates: {(scene, moment, code, threads): [rate of each round]}, a contact and ms a step of 1e3/rate; moments: {scene: rows}."""
    rows = [
        {
            **dict(zip(("scene", "moment", "code", "threads"), where)),
            "round": k,
            "rate": rate,
            "fraction": 0.5,
            "contacts": 1,
            "steps": rate,
            "seconds": 1.0,
        }
        for where, each in rates.items()
        for k, rate in enumerate(each)
    ]
    results = Results(folder)
    results.put(
        speed=rows, moments=[{"scene": scene, **row} for scene, of_scene in moments.items() for row in of_scene]
    )
    return results


def test_ratios_are_taken_within_a_round(tmp_path):
    here = ("cpe-40", "flying")
    results = results_of(
        tmp_path, {(*here, "engine", 1): [20, 30, 40], (*here, "stock", 1): [2, 2, 5], (*here, "lammps", 1): [4]}
    )
    assert results.ratio((*here, "engine", 1), (*here, "stock", 1)) == Spread(10, 8, 15)
    assert results.ratio((*here, "engine", 1), (*here, "lammps", 1)) == Spread(7.5, 5, 10)
    assert results.ratio((*here, "engine", 1), (*here, "liggghts", 1)) is None
    assert list(results.rates(*here, "engine", 1, by_processor=True)) == [40, 60, 80]


def test_time_to_solution_weighs_the_moments(tmp_path):
    """Moments at 0, 0.2 and 0.6 of the run stand for 0.1, 0.3 and 0.6 of its steps; a run with a moment missing has no time."""
    scene = replace(measured_scenes.PAPERS["a22"], moments={"flying": 0.0, "compressing": 1.0, "later": 2.0})
    rows = [{"moment": name, "progress": at, "runSteps": 10_000} for name, at in zip(scene.moments, (0.0, 0.2, 0.6))]
    rates = {("a22", name, "engine", 1): [1e3 / ms] for name, ms in zip(scene.moments, (1.0, 3.0, 2.0))}
    results = results_of(tmp_path, rates, a22=rows)
    whole = results.whole({"a22": scene})["a22"]
    assert weights(whole) == pytest.approx([0.1, 0.3, 0.6])
    assert results.minutes(whole, "engine", 1) == pytest.approx(10_000 * 2.2 / 60e3)
    assert results.minutes(whole, "lammps", 1) is None
    assert results.whole(measured_scenes.PAPERS) == {}  # without its fragments


@pytest.mark.parametrize(
    "bound, found, at_least, verdict",
    [
        (27, Spread(28, 27, 29), True, "**reached**"),
        (27, Spread(28, 26, 29), True, "reached by the median, not in every round"),
        (27, Spread(26, 25, 28), True, "not reached"),
        (6, Spread(5, 4, 5.9), False, "**reached**"),
        (6, Spread(5, 4, 6), False, "reached by the median, not in every round"),
        (27, None, True, "not measured"),
    ],
)
def test_a_target_says_whether_it_is_reached(bound, found, at_least, verdict):
    assert Target("x", bound, found, at_least).cells()[-1] == verdict


def test_the_fitted_order():
    steps = np.array(FULL.error_steps[:-1])
    slope, wrong = errors.order(steps, 3e-3 * steps**2 * np.where(steps > errors.FITTED[1], 10, 1))
    assert slope == pytest.approx(2) and wrong < 1e-6


def test_parts_of_the_time():
    perf = """
    53.52%  harness            [.] contact_law::Passes<contact_law::avx512::Pack>::forces<7u, true, false>       -      -
    12.00%  harness            [.] contact_law::PairLists::findDue                                             -      -
     4.00%  harness            [.] contact_law::ContactList::sort                                                -      -
     4.48%  harness            [.] contact_law::avx512::integrate                                                -      -
     6.00%  libc.so.6          [.] __memmove_avx512_unaligned_erms                                               -      -
"""
    expected = {"forces": 0.669, "lists": 0.2, "events": 0, "integration": 0.056, "other": 0.075}
    assert engine_parts.of_report(perf) == pytest.approx(expected) and engine_parts.of_report("nothing\n") == {}


@pytest.mark.parametrize(
    "arguments, words",
    [
        (["--scene", "a22,a23"], r"--scene a23: must be of bench, papers, compressions, .*a22-drag"),
        (["--only", "bake"], "--only bake: must be of make, measure, report"),
        (["--only", "report", "--out", "nowhere"], "holds no measurement: must be measured first"),
    ],
)
def test_what_is_unknown_is_refused(arguments, words):
    done = run_bench(*arguments)
    assert done.returncode in (1, 2) and re.search(words, done.stderr) and not Path("nowhere").exists()


def test_the_groups_hold_all_scenes():
    groups = bench.groups(settings.FULL)
    assert bench.arguments(["--scene", "papers,cpe-40", "--quick"]).scene == [*measured_scenes.PAPERS, "cpe-40"]
    assert set(groups["all"]) == {*measured_scenes.all_scenes(FULL), *errors.scenes(FULL)}
