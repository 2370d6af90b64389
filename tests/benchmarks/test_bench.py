"""The bench works: everything measured once, as little as possible; what is not installed is said and left out; what was
measured stays, and is what the pages say."""

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
import pytest
import report
import speed
import step_choice_report
import throughput
from measured_on import RESULTS, TOP
from results import Results, Spread, weights
from settings import FULL, TINY
from step_choice import COLLISIONS, COMPRESSIONS
from test_harness import SMALL, harness_is_built  # noqa: F401  (a fixture)

CELL = SMALL["cell"]
LITTLE = replace(TINY, stretch=0.5, peer_steps=10)


def run_bench(*arguments, **environment):
    command = [sys.executable, str(TOP / "tests/benchmarks/bench.py"), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment}, timeout=300)


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
    expected = {(name, "engine") for name in ("cpe-4", "cpe-5", "materials", "radii")}
    expected |= {(name, code) for name in ("cpe-4", "cpe-5") for code in measured_scenes.SLOW}
    assert set(zip(measured.scene, measured.code)) == expected
    reference = measured[measured.scene == "cpe-5"]  # of which every code counts the same contacts
    assert set(reference.contacts) == set(results.moments.query("scene == 'cpe-5'").contacts) and len(reference) == 16
    assert set(measured[measured.code == "engine"].threads) == {1, 2}
    assert set(measured[measured.code == "engine-portable"].version) == {"portable"}
    assert set(results.speed[results.speed.note.notna()].code) == {"lammps", "liggghts"}
    page = (folder / "bench.md").read_text()
    assert page in printed
    assert "LAMMPS was not measured: lmp is not installed" in page


def test_half_a_time_unit_is_shown_as_refused(tiny):
    found = tiny[2].error.set_index(["scene", "step"]).sort_index()
    assert "must be > 0 and <= 0.4" in found.refused["collision", 0.5]
    assert "- 0.5 t0, collision: collide.py: stepFraction = 0.5" in (tiny[1] / "bench.md").read_text()


def test_moments_are_measured(tmp_path):
    start, results = moments.make("cell", CELL, tmp_path), Results(tmp_path)
    for batch in speed.batches({"cell": CELL}):
        results.put(**speed.measure(batch, {"cell": start}, LITTLE, tmp_path))
    table = results.moments.set_index("moment")
    assert list(table.index) == ["start", "denser"]
    assert (table.grains == 128).all() and table.contacts.between(127, 400).all()
    assert table.contactUpdates.to_numpy() == pytest.approx(table.measuredSteps * table.contacts, rel=0.02)
    assert abs(table.energyChange["denser"]) < 0.02 * abs(table.boundaryWork["denser"]) != 0
    parts = table[[*engine_parts.PARTS, engine_parts.OTHER]].sum(axis=1)
    assert all(total == 0 or total == pytest.approx(1) for total in parts)  # 0: perf cannot sample here
    for moment in CELL.moments:
        assert list(results.of("cell", moment, "engine", 2).index) == [0, 1]
        lammps = results.speed.query("moment == @moment and code == 'lammps'")
        assert (lammps.skin == 0.6).all() if lammps.note.isna().all() else lammps.note.str.contains("lmp is not").all()


def test_compressions_are_measured_against_the_step():
    steps, cell = (0.05, 0.1, 0.2, 0.3, 0.36), {"grains": 64, "strainRate": 1e-4, "linearDamping": 0.01}
    asked = [{**cell, "finalFilling": 0.5, "stepFraction": step, "seed": seed} for step in steps for seed in (1, 2)]
    found = errors.of_scripts(asked)
    for ledger in (lambda run: run["ledger"], lambda run: run["byFilling"][0.1][0]):
        error = np.sqrt(np.mean(np.reshape([ledger(run) ** 2 for run in found], (5, 2)), axis=1))
        slope, wrong = errors.order(np.array(steps), error, (0.05, 0.36))
        assert slope == pytest.approx(2, abs=0.3 + 2 * wrong)
    work = np.reshape([run["byFilling"][0.1][1] - run["byFilling"][0.05][1] for run in found], (5, 2))
    assert abs(np.log(work / work[0])).max() < 0.05


def test_what_is_done_is_not_measured_again(tiny, monkeypatch):
    """Real measurements; only the commit that is built is said to be that of an unchanged tree."""
    results, commit = Results(tiny[1]), tiny[2].moments.commit[0].removesuffix("-changed")
    results.put(moments=results.moments.assign(commit=commit).to_dict("records"))
    monkeypatch.setattr(bench, "built_commit", lambda: commit)
    bench.measure_speed(measured_scenes.bench(TINY), TINY, results)
    assert list(results.speed.seconds.dropna()) == list(tiny[2].speed.seconds.dropna())
    place, about = {"scene": "cpe-4", "moment": "flying"}, {"commit": commit, "settings": TINY.text()}
    assert results.is_done(**place, **about)
    for changed in ({"commit": "d" * 40}, {"settings": FULL.text()}, {"moment": "later"}):
        assert not results.is_done(**{**place, **about, **changed})


def test_what_was_measured_stays(tmp_path):
    """Rows of the same scene and moment are replaced, others kept, to the last bit."""
    results, here = Results(tmp_path), {"scene": "b", "moment": "flying"}
    results.put(speed=[{**here, "scene": "a", "rate": 0.1 + 0.2}, {**here, "rate": 1 / 3}])
    results.put(speed=[{**here, "rate": 2 / 3}, {**here, "moment": "later", "rate": 1.0}])
    assert list(Results(tmp_path).speed.rate) == [0.1 + 0.2, 2 / 3, 1.0]
    assert sorted(path.name for path in tmp_path.iterdir()) == ["speed.csv"]
    results.put(moments=[{**here, "progress": 0.0}, {**here, "moment": "later", "progress": 0.5}])
    results.put(moments=[{**here, "progress": 0.0}])  # measured again
    assert list(Results(tmp_path).moments.moment) == ["flying", "later"]


@pytest.mark.parametrize("name", ["bench.md", "throughput.md"])
def test_the_page_is_that_of_the_tables(name):
    throughputs = lambda: throughput.text(Results(throughput.FOLDER))
    page = throughputs() if name == "throughput.md" else report.text(Results(RESULTS), FULL)
    assert (RESULTS / name).read_text() == page
    for table in page.split("\n\n"):
        assert len({line.count("|") for line in table.splitlines() if line.startswith("|")}) <= 1


def test_step_choice_is_that_of_its_tables(tmp_path):
    assert (RESULTS / "step_choice.md").read_text() == step_choice_report.text()
    for table in (COLLISIONS, COMPRESSIONS):
        copy = replace(table, path=tmp_path / "copy.csv")
        copy.path.write_text(table.path.read_text())
        copy.write(copy.read())
        assert copy.path.read_text() == table.path.read_text()
    # a line without an error is measured; the others keep theirs, and the comments tell where
    head = COLLISIONS.path.read_text().splitlines()[:6]
    new = head[-1].rpartition(",")[0].replace("10.0,", "4.0,", 1) + ","
    copy = replace(COLLISIONS, path=tmp_path / "scenes.csv")
    copy.path.write_text("\n".join([*head, new]) + "\n")
    copy.measure()
    old, new = copy.read().error
    assert old == float(head[-1].rpartition(",")[2]) and 1e-6 < new < 1e-2 and "measured last on" in copy.origins()


def results_of(folder, rates, moments=()):
    """Results with these rates: {(moment, code, threads): [rate of each round]} of scene a22, one contact; rows of moments."""
    results, rows = Results(folder), []
    for (moment, code, threads), each in rates.items():
        at = {"scene": "a22", "moment": moment, "code": code, "threads": threads, "fraction": 0.5, "seconds": 1}
        rows += [{**at, "round": k, "rate": rate, "steps": rate} for k, rate in enumerate(each)]
    results.put(speed=rows, moments=[{"scene": "a22", **row} for row in moments])
    return results


def test_ratios_are_taken_within_a_round(tmp_path):
    rates = {("flying", "engine", 1): [20, 30, 40], ("flying", "stock", 1): [2, 2, 5], ("flying", "lammps", 1): [4]}
    results = results_of(tmp_path, {**rates, ("later", "engine", 1): [10, 40, 20]})
    engine = ("a22", "flying", "engine", 1)
    for code, ratio in (("stock", Spread(10, 8, 15)), ("lammps", Spread(7.5, 5, 10)), ("liggghts", None)):
        assert results.ratio(engine, ("a22", "flying", code, 1)) == ratio
    apart = results_of(tmp_path, {}, [{"moment": "flying"}, {"moment": "later"}])  # moments of one scene: other rounds
    assert apart.ratio(engine, ("a22", "later", "engine", 1)) == Spread(1.5, 0.5, 4)


def test_time_to_solution_weighs_the_moments(tmp_path):
    """Moments at 0, 0.2 and 0.6 of the run stand for 0.1, 0.3 and 0.6 of its steps; a run with a moment missing has none."""
    scene = replace(measured_scenes.PAPERS["a22"], moments={"flying": 0.0, "compressing": 1.0, "later": 2.0})
    rows = [{"moment": name, "progress": at, "runSteps": 10_000} for name, at in zip(scene.moments, (0.0, 0.2, 0.6))]
    rates = {(name, "engine", 1): [1e3 / ms] for name, ms in zip(scene.moments, (1.0, 3.0, 2.0))}
    results = results_of(tmp_path, rates, rows)
    whole = results.whole({"a22": scene})["a22"]
    assert weights(whole) == pytest.approx([0.1, 0.3, 0.6])
    assert results.minutes(whole, "engine", 1) == pytest.approx(10_000 * 2.2 / 60e3)
    assert results.minutes(whole, "lammps", 1) is None and results.whole(measured_scenes.PAPERS) == {}


PERF = """
 53.52%  harness    [.] contact_law::Passes<contact_law::avx512::Pack>::forces<7u, true, false>     -      -
 12.00%  harness    [.] contact_law::PairLists::findDue                                             -      -
  4.00%  harness    [.] contact_law::ContactList::sort                                              -      -
  4.48%  harness    [.] contact_law::avx512::integrate                                              -      -
  6.00%  libc.so.6  [.] __memmove_avx512_unaligned_erms                                             -      -
"""


def test_parts_of_the_time():
    expected = {"forces": 0.669, "lists": 0.2, "eventHandling": 0, "integration": 0.056, "other": 0.075}
    assert engine_parts.of_report(PERF) == pytest.approx(expected) and engine_parts.of_report("nothing\n") == {}


REFUSED = {
    "--scene a22,a23": r"--scene a23: must be of bench, papers, peers, .*a22-drag",
    "--only bake": "--only bake: must be of make, measure, report",
    "--only report --out nowhere": "holds no measurement: must be measured first",
}


def test_what_is_unknown_is_refused():
    for arguments, words in REFUSED.items():
        done = run_bench(*arguments.split())
        assert done.returncode in (1, 2) and re.search(words, done.stderr) and not Path("nowhere").exists()
    given = bench.arguments(["--scene", "papers,cpe-40,ringing", "--quick"])
    assert given.scene == [*measured_scenes.PAPERS, "cpe-40", "ringing"]
