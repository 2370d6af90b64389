"""The study of S17 from made run folders whose answers are known: measured, compared, drawn, and read again from its table."""

import json
import re

import numpy as np
import pandas
import pytest
from same_answer import differences
from written_runs import MASS, RADIUS, record, state_arrays, write_run

from analysis.__main__ import main
from analysis.runs.folder import open_run
from analysis.runs.format import BROKEN_BONDS, CHANNELS
from analysis.studies.definition import NotMeasured
from analysis.studies.sintered import paper
from analysis.studies.sintered.bouncing import chain_grains, predicted_ratio
from analysis.studies.sintered.comparison import remarks
from analysis.studies.sintered.fits import OWN, Law, fit
from analysis.studies.sintered.growth import critical_velocity
from analysis.studies.sintered.loops import loops
from analysis.studies.sintered.measure import PARTS as MEASURED_PARTS
from analysis.studies.sintered.measure import energy_ratio, measure
from analysis.studies.sintered.results import make_results
from analysis.theory import ICE

GRAINS = 400  # of both aggregates: chains of 200
AMPLITUDE, EXPONENT = 0.05, 0.8  # of the made necks
ICE_GRAIN = dict(grainRadius=RADIUS, density=ICE.density, surfaceEnergy=ICE.surface_energy)
PARTS = {"rollingDissipation": 0.4, "disconnection": 0.1, "normal": 0.05}


def chain(start, number):
    return [[k, k + 1] for k in range(start, start + number - 1)]


def made_run(path, velocity, neck, seed, largest=GRAINS, growth=0.0, broken=None, **parameters):
    """A collision of two straight chains: at the end a piece of `largest` grains, the rest a second piece; necks broken as
    the power law has it (or `broken`), one in eight by sliding, the others by rolling."""
    ratio = energy_ratio(neck, velocity, **ICE_GRAIN) if neck else 0.0
    noise = 1 + 0.05 * np.random.default_rng(seed).normal()
    if broken is None:
        broken = int(round(GRAINS * AMPLITUDE * ratio**EXPONENT * noise)) if neck else 0
    counts = dict(zip(BROKEN_BONDS, (0, broken // 8, broken - broken // 8, 0)))
    kinetic = GRAINS * 0.5 * MASS * (velocity / 2) ** 2
    time = np.linspace(0, 4e-6, 21)
    history = {name: np.zeros(21) for name in CHANNELS}
    for name, part in PARTS.items():
        history[name] = part * kinetic * time / time[-1]
    history["kinetic"] = kinetic * (1 - sum(PARTS.values()) * time / time[-1])
    history.update(time=time, d=0 * time, v=0 * time, contacts=0 * time.astype(int))
    history["contacts_between"] = (time > 0).astype(int)
    if neck:
        history.update({name: np.linspace(0, number, 21).astype(int) for name, number in counts.items()})
    aggregate = np.repeat([0, 1], GRAINS // 2)
    position = 2 * RADIUS * np.arange(GRAINS)[:, None] * (1, 0, 0)
    whole = chain(0, GRAINS // 2) + chain(GRAINS // 2, GRAINS // 2)
    end = chain(0, largest) + chain(largest, GRAINS - largest)
    states = [
        state_arrays(0.0, position, 0 * position, aggregate, whole),
        state_arrays(4e-6, position, 0 * position, aggregate, end),
    ]
    for state in states:
        state["contact_bonded"] = np.full(len(state["contact_pairs"]), neck > 0)
    values = {
        "packing": "file" if growth else "bcca",
        "material": "ice",
        "planar": 1,
        "neck": neck,
        "velocity": velocity,
        "viscoelasticTime": 0.0,
        "limit": "cut",
        "slidingStiffnessFactor": 2.0,
        "impact": 0.0,
        "duration": 24.4e-6,
        "seed": 1 if growth else seed,
        **parameters,
    }
    about = record(200 * RADIUS, values)
    about["derived"].update(criticalRolling=2e-10)
    if growth:
        about["derived"]["targetPacking"] = {"growthVelocity": growth, "seed": seed}
    return write_run(path, about, history, states)


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    folder = tmp_path_factory.mktemp("sintered") / "runs"
    for seed in (1, 2, 3, 4):
        for neck in (0.0, 0.2, 0.4, 0.5, 0.7):
            for velocity in (10.0, 30.0, 50.0):
                # BCCA of 0.7 at 10 m/s: seeds 1 and 2 bounce
                bounce = (neck, velocity) == (0.7, 10.0) and seed < 3
                made_run(
                    folder / f"b{neck}-v{velocity}-s{seed}", velocity, neck, seed, GRAINS // 2 if bounce else GRAINS
                )
        for neck in (0.2, 0.7):
            made_run(folder / f"vg3-b{neck}-s{seed}", 3.0, neck, seed, GRAINS // 2, growth=3.0, broken=0)
    return folder


def test_runs_of_other_grains_are_left_out(tmp_path):
    path = made_run(tmp_path / "run", 10.0, 0.7, 1)
    about = json.loads((path / "run.json").read_text())
    about["derived"]["surfaceEnergy"] = 0.02
    (path / "run.json").write_text(json.dumps(about))
    with pytest.raises(NotMeasured, match=re.escape("other grains than the paper's (surfaceEnergy = 0.02)")):
        measure(open_run(path))


def test_aggregates_of_unlike_size_are_no_seeds_of_one_point(runs):
    """Of 400 and 800 grains: the commoner; beside aggregates of the paper's size only these. Compacted ones differ anyway."""
    measured = pandas.DataFrame([measure(open_run(path)) for path in sorted(runs.glob("*-s[12]"))])
    bcca = measured[measured.growth_velocity == 0]
    for other, left in ((2 * GRAINS, len(bcca)), (2 * paper.GRAINS, 1)):
        found = make_results(pandas.concat([measured, bcca.iloc[:1].assign(grains=other)], ignore_index=True))
        own = found.table[found.table.growth_velocity == 0]
        assert len(own) == left and own.grains.nunique() == 1 and found.other_sizes == len(bcca) + 1 - left
        assert len(found.table) - len(own) == len(measured) - len(bcca)
        assert any("of another number of grains" in line for line in remarks(found))


def test_one_run(runs):
    row = measure(open_run(runs / "b0.7-v30.0-s2"))
    assert (row["neck"], row["packing_seed"], row["growth_velocity"], row["grains"]) == (0.7, 2, 0.0, GRAINS)
    assert row["energy_ratio"] == pytest.approx(MASS * 30.0**2 / 4 / (np.pi * 0.1 * (0.7 * RADIUS) ** 2))
    assert row["largest"] == 1.0 and row["second"] == 0.0 and row["fragments"] == 0.0 and row["outcome"] == "sticking"
    # a straight chain of n grains 2R apart: R_g^2 = 4 R^2 (n^2 - 1)/12
    assert row["gyration_radius"] == pytest.approx(2 * np.sqrt((GRAINS**2 - 1) / 12))
    assert row["initial_radius"] == pytest.approx(2 * np.sqrt(((GRAINS / 2) ** 2 - 1) / 12))
    assert row["contacts"] == pytest.approx(2 * (GRAINS - 2) / GRAINS) and row["necks_at_start"] == GRAINS - 2
    assert row["brokenByRolling"] > 6 * row["brokenBySliding"] > 0 == row["brokenByTwisting"]
    assert row["part_kinetic"] == pytest.approx(0.45) and row["part_elastic"] == pytest.approx(0.05)
    assert row["part_rolling_friction"] == pytest.approx(0.4) and row["part_stretching"] == pytest.approx(0.1)
    assert sum(row[f"part_{name}"] for name in MEASURED_PARTS) == pytest.approx(1.0) and row["closure"] < 1e-12
    assert row["ended_by"]
    # 1,250 periods of 1.22 ns fall next to two fifths of the record, in which half of K(0) is lost evenly
    assert row["left_1250"] == pytest.approx(0.8) and np.isnan(row["left_5000"]) and np.isnan(row["part_necks_5000"])
    assert (row["loops_at_start"], row["loop_grains_at_start"], row["loops"], row["loop_grains"]) == (0, 0, 0, 0)


def test_a_compacted_pair_keeps_its_origin(runs):
    row = measure(open_run(runs / "vg3-b0.7-s4"))
    assert (row["growth_velocity"], row["packing_seed"]) == (3.0, 4)
    assert row["largest"] == row["second"] == 0.5 and row["fragments"] == 0.0


def test_points_and_the_fit_of_made_runs(runs):
    table = pandas.DataFrame([measure(open_run(path)) for path in sorted(runs.iterdir())])
    results = make_results(table)
    assert len(results.points) == 5 * 3 + 2 and all(point.runs == 4 for point in results.points)
    point = results.main(growth_velocity=0.0, neck=0.7, velocity=10.0)[0]
    assert (point.grown, point.outcomes.get("sticking")) == (2, 2)
    assert point.means["largest"] == pytest.approx((0.75, 0.5 / np.sqrt(12)))
    assert point.means["rolling_of_lost"][0] == pytest.approx(0.4 / 0.5)
    falls = results.paired("largest", {"neck": 0.0, "velocity": 10.0}, {"neck": 0.7, "velocity": 10.0})
    assert sorted(falls) == pytest.approx([0.0, 0.0, 0.5, 0.5])
    assert len(results.paired("largest", {"neck": 0.0, "velocity": 10.0}, {"neck": 0.65, "velocity": 10.0})) == 0
    # not BCCA of beta = 0.2; of the compacted ones, in which no neck broke, those of beta = 0.7
    every = results.fits[1, 0.0]["beta >= 0.3"]
    assert (every.points, every.runs, every.empty, every.seeds) == (10, 40, 1, 4)
    own = results.fits[1, 0.0][OWN]
    assert (own.points, own.runs) == (4, 16)
    for law in (every.means, own.means):
        assert law.amplitude == pytest.approx(AMPLITUDE, rel=0.1) and law.exponent == pytest.approx(EXPONENT, abs=0.04)
        assert 0 < law.exponent_error < 0.2 and 0 < law.amplitude_error < 0.2 * AMPLITUDE
    # the end's energies, as the runs have ended before 5,000 periods
    assert point.means["left_5000"] == point.means["left_20000"] == (pytest.approx(0.5), pytest.approx(0.0))
    assert point.means["cut_energy"][0] == pytest.approx(2 * point.means["cut_per_grain"][0] / point.energy_ratio)


def made_counts(seeds, ratios, law, grains=2048):
    """Table of runs whose broken necks are Poisson numbers about a Law."""
    random = np.random.default_rng(3)
    rows = [(seed, ratio, random.poisson(grains * law.at(ratio))) for seed in range(seeds) for ratio in ratios]
    return pandas.DataFrame(rows, columns=["packing_seed", "energy_ratio", "broken"]).assign(grains=grains)


def test_both_fits_find_a_law_and_counts_know_runs_without_a_broken_neck():
    true = Law(0.05, 1.4)
    many = fit(made_counts(40, (0.1, 0.3, 1.0, 3.0), true), ["energy_ratio"])
    for law in (many.means, many.counts):
        assert abs(law.amplitude - 0.05) < 4 * law.amplitude_error and abs(law.exponent - 1.4) < 4 * law.exponent_error
        assert law.amplitude_error < 0.002 and law.exponent_error < 0.05
    assert many.empty == 0 and many.points == 4
    # means of all runs: at the lowest ratio most have no broken neck, and those that have one alone would be far too high
    few = fit(made_counts(40, (0.01, 0.3, 1.0, 3.0), true), ["energy_ratio"])
    assert few.empty == 0 and few.means.exponent == pytest.approx(1.4, abs=0.1)
    none = fit(made_counts(40, (1e-6, 0.3, 1.0, 3.0), true), ["energy_ratio"])
    assert none.empty == 1 and none.points == 4 and none.counts.exponent == pytest.approx(1.4, abs=0.05)


def test_a_fit_needs_two_energies_with_broken_necks():
    table = made_counts(3, (1e-6, 1.0), Law(0.05, 1.4))
    assert fit(table, ["energy_ratio"]) is None and fit(table[:0], ["energy_ratio"]) is None


def test_loops_of_a_lattice_and_what_hangs_on_it():
    """Two triangles with a common side, a square apart from them, and chains between and beside."""
    pairs = [[0, 1], [1, 2], [2, 0], [1, 3], [2, 3], [3, 4], [4, 5], [5, 6], [6, 7], [7, 8], [8, 5], [8, 9], [10, 11]]
    assert loops(12, pairs) == (3, 8)
    assert loops(12, pairs[5:6]) == (0, 0) and loops(3, []) == (0, 0)


def test_the_critical_velocity_and_its_interval():
    rows = [(v, seed, 1 - v / 80 + 0.02 * (seed - 2)) for v in (10.0, 20.0, 50.0) for seed in (1, 2, 3)]
    table = pandas.DataFrame(rows, columns=["velocity", "packing_seed", "largest"])
    found = critical_velocity(table)
    assert found.velocity == pytest.approx(40.0) and found.low < 40 < found.high < 50 and found.seeds == 3
    early = critical_velocity(table[table.velocity < 30])
    assert early.velocity == early.low == early.high == np.inf and early.highest == 20
    assert critical_velocity(table[table.velocity < 15]) is None


def test_runs_with_another_law_are_points_of_their_own(tmp_path):
    laws = {"held": {"limit": "held"}, "W07": {"slidingStiffnessFactor": 1.0}, "S17": {}}
    for name, law in laws.items():
        made_run(tmp_path / name, 30.0, 0.7, 1, **law)
    table = pandas.DataFrame([measure(open_run(path)) for path in sorted(tmp_path.iterdir())])
    results = make_results(table)
    assert sorted((point.cut, point.sliding_factor) for point in results.points) == [(0, 2.0), (1, 1.0), (1, 2.0)]
    assert len(results.main()) == len(results.runs()) == len(results.sintered()) == 1
    assert len(list(remarks(results))) == 3  # of both others, and no fit
    assert results.fits == {(1, 0.0): {}}


def test_the_chain_model_of_points(runs):
    table = pandas.DataFrame([measure(open_run(path)) for path in sorted(runs.iterdir())])
    results = make_results(table)
    loops = results.main(growth_velocity=0.0, neck=0.7, velocity=10.0)[0]
    assert chain_grains(loops) == 100 and predicted_ratio(loops) > 1 > predicted_ratio(loops, paper.LOOP_GRAINS)
    unsintered = results.main(growth_velocity=0.0, neck=0.0, velocity=10.0)[0]
    assert np.isnan(predicted_ratio(unsintered))
    straight = results.main(growth_velocity=3.0, neck=0.7)[0]  # fewer than two contacts a grain: no lattice of chains
    assert np.isinf(chain_grains(straight)) and np.isinf(predicted_ratio(straight))


def test_comparison_and_figures(runs, tmp_path, capsys):
    assert main(["study", "sintered", str(runs), "--figures", str(tmp_path / "out"), "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    lines = {row["quantity"]: row for s in answer["sections"] for row in s["rows"] if "quantity" in row}
    assert lines["sticking efficiency, unsintered, 50 m/s"]["ours"] == 1.0
    assert "within it" in lines["sticking efficiency, unsintered, 50 m/s"]["note"]
    assert "outside it" in lines["sticking efficiency, beta = 0.7, 30 m/s"]["note"]
    bounce = lines["fraction that bounces, beta = 0.7, 10 m/s"]
    assert bounce["ours"] == pytest.approx(0.5) and bounce["paper"] == pytest.approx(0.4)
    assert lines["fraction that bounces, V_g = 3 m/s, beta = 0.7, 3 m/s"]["ours"] == 1.0
    assert lines["rolling friction takes, unsintered, 10 m/s"]["ours"] == pytest.approx(0.4)
    assert point_of(answer, 0.0, 10.0)["largest"][0] == 1.0
    assert lines["kinetic and elastic after 5000 periods, beta = 0.5, 10 m/s"]["ours"] == pytest.approx(0.5)
    assert lines["kinetic and elastic after 1250 periods, beta = 0.5, 10 m/s"]["ours"] == pytest.approx(0.8)
    assert lines["necks broken by rolling, in the plane"]["ours"] == pytest.approx(7 / 8, abs=0.02)
    assert "Fisher's exact p = 1" in bounce["note"]
    assert lines["mean largest piece is half, unsintered, in the plane"]["ours"] is None
    assert lines["R_g/R of the largest piece, beta = 0.7 less unsintered, 30 m/s"]["ours"] == pytest.approx(0)
    fits = [s for s in answer["sections"] if s["heading"].startswith("broken necks, N_cut")][0]["rows"]
    assert fits[0]["selection"] == OWN and fits[0]["means_exponent"][0] == pytest.approx(EXPONENT, abs=0.04)
    drawn = {file.name for file in (tmp_path / "out").glob("*.png")}
    figures = {"fig06_contacts", "fig08_velocity", "fig11_beta", "fig12_fragments", "fig13_compacted", "fig14_energy"}
    assert {f"{name}.png" for name in figures | {"fig15_necks", "fig17_chains", "modes", "fig07_snapshots"}} <= drawn
    assert main(["study", "sintered", str(tmp_path / "out" / "runs.csv"), "--json"]) == 0
    assert differences(json.loads(capsys.readouterr().out)["sections"], answer["sections"]) == []


def lines_of_runs(folder, capsys, held=False):
    """{quantity: record} of the lines beside the paper, or of those of springs that are held."""
    assert main(["study", "sintered", str(folder), "--json"]) == 0
    answer = json.loads(capsys.readouterr().out)
    chosen = [s for s in answer["sections"] if s["heading"].startswith("springs held: ") == held]
    return {row["quantity"]: row for s in chosen for row in s["rows"] if "quantity" in row}


def test_compacted_aggregates_beside_others(tmp_path, capsys):
    for seed in (1, 2, 3, 4):
        more = {"broken": 160 + seed, "seed": seed}
        made_run(tmp_path / f"bcca{seed}", 30.0, 0.7, seed, broken=100 + 5 * seed)
        for growth, largest in ((1.0, GRAINS), (3.0, GRAINS - 40 * seed)):
            made_run(tmp_path / f"fast{growth}-{seed}", 30.0, 0.7, largest=largest, growth=growth, **more)
        made_run(tmp_path / f"slow{seed}", 10.0, 0.7, seed, GRAINS // 2 if seed < 4 else GRAINS, growth=3.0, broken=0)
        made_run(tmp_path / f"unsintered{seed}", 3.0, 0.0, seed, growth=3.0)
    found = lines_of_runs(tmp_path, capsys)
    assert found["contacts a grain, V_g = 3 m/s"]["ours"] == pytest.approx(2 * (GRAINS - 2) / GRAINS)
    assert found["fraction that sticks, V_g = 3 m/s, unsintered, 3 m/s"]["ours"] == 1.0
    bounces = found["fraction that bounces, V_g = 3 m/s, beta = 0.7, 10 m/s"]
    assert bounces["ours"] == 0.75 and "3 of 4" in bounces["note"] and "1 stick" in bounces["note"]
    assert found["sticking efficiency, V_g = 1 m/s, beta = 0.7, 30 m/s"]["paper"] == paper.BROKEN_EFFICIENCY
    assert "outside it" in found["sticking efficiency, V_g = 3 m/s, beta = 0.7, 30 m/s"]["note"]
    ratio = found["N_cut/N_t over BCCA's, V_g = 1 m/s, beta = 0.7, 30 m/s"]
    assert ratio["ours"] == pytest.approx(162.5 / 112.5) and ratio["paper"] == 1.0 and 0.02 < ratio["error"] < 0.06
    assert "mass in fragments less BCCA's, V_g = 1 m/s, beta = 0.7, 30 m/s" not in found  # neither has any


def test_space_and_other_laws_beside_the_plane(tmp_path, capsys):
    changes = {"plane": {}, "space": {"planar": 0}, "held": {"limit": "held"}}
    for seed in (1, 2, 3):
        broken = {"plane": 80 + 8 * seed, "space": 40, "held": 120 + 12 * seed}
        for name, change in changes.items():
            largest = GRAINS if name == "plane" else GRAINS // 2
            made_run(tmp_path / f"{name}{seed}", 30.0, 0.7, seed, largest, broken=broken[name], **change)
    found = lines_of_runs(tmp_path, capsys)
    ratio = found["N_cut/N_t, space over plane, beta = 0.7, 30 m/s"]
    assert ratio["ours"] == pytest.approx(40 / 96) and ratio["paper"] == 1.0 and ratio["chance"] < 0.05
    touching = "N_cut over the largest number of contacts between the aggregates, space over plane, beta = 0.7, 30 m/s"
    assert found[touching]["ours"] == pytest.approx(40 / 96) and found[touching]["paper"] is None
    bounces = found["fraction that bounces, space less plane, beta = 0.7, 30 m/s"]
    assert bounces["ours"] == 1.0 and "Fisher's exact p = 0.1" in bounces["note"]
    assert found["necks broken by twisting in space, beta = 0.7, 30 m/s"]["ours"] == 0.0
    assert found["sticking efficiency, held less main, beta = 0.7, 30 m/s"]["ours"] == -0.5
    # seed by seed, so that what pairs have in common drops out
    ratio = found["N_cut/N_t, held over main, beta = 0.7, 30 m/s"]
    assert ratio["ours"] == pytest.approx(1.5) and ratio["error"] == 0.0
    # each law beside the paper
    name = "sticking efficiency, beta = 0.7, 30 m/s"
    assert found[name]["ours"] == 1.0 and lines_of_runs(tmp_path, capsys, held=True)[name]["ours"] == 0.5
    assert main(["study", "sintered", str(tmp_path), "--figures", str(tmp_path / "out")]) == 0
    drawn = {file.name for file in (tmp_path / "out").glob("*.png")}
    assert {"held.png", "space.png"} <= drawn and "space_compacted.png" not in drawn


def point_of(answer, neck, velocity):
    """The record of a point of BCCA aggregates in the section of all points."""
    points = [s for s in answer["sections"] if s["heading"] == "all points"][0]["rows"]
    return next(p for p in points if (p["growth_velocity"], p["neck"], p["velocity"]) == (0.0, neck, velocity))


def test_the_same_pair_twice_counts_once(tmp_path, capsys):
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        made_run(tmp_path / name, 3.0, 0.7, seed, growth=3.0)
    assert main(["study", "sintered", str(tmp_path), "--json"]) == 0
    said = capsys.readouterr()
    assert "packing_seed as" in said.err
    points = [s for s in json.loads(said.out)["sections"] if s["heading"] == "all points"][0]["rows"]
    assert [point["runs"] for point in points] == [2]


def test_runs_of_other_scenes_are_left_out(tmp_path, capsys):
    made_run(tmp_path / "oblique", 10.0, 0.7, 1, impact=0.5)
    made_run(tmp_path / "extracted", 10.0, 0.7, 1, packing="cpe")
    assert main(["study", "sintered", str(tmp_path)]) == 2
    said = capsys.readouterr().err
    assert "impact = 0.5, S17's scene has 0.0" in said and "packing = cpe, S17's are bcca and file" in said
