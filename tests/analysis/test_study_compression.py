"""python3 -m analysis study compression as a user runs it, on made-up run folders."""

import io
import json
import shutil
import warnings
from contextlib import redirect_stderr, redirect_stdout
from types import SimpleNamespace

import numpy as np
import pytest
from made_compressions import SILICATE_GRAINS, made_compression

from analysis.__main__ import main

SCALE = 4.7374e5


def analyse(*arguments):
    out, err = io.StringIO(), io.StringIO()
    with redirect_stdout(out), redirect_stderr(err), warnings.catch_warnings():
        warnings.simplefilter("error", RuntimeWarning)
        status = main(["study", "compression", *map(str, arguments)])
    return SimpleNamespace(returncode=status, stdout=out.getvalue(), stderr=err.getvalue())


def power(factor=1.0, exponent=3.0):
    return lambda filling: factor * SCALE * filling**exponent


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """Four seeds of P0 phi^3 that scatter by tenths, two of another xi_crit and k_n, silicate, and one stretched."""
    folder = tmp_path_factory.mktemp("compression")
    for seed, factor in enumerate((0.8, 1.2, 0.9, 1.1), start=1):
        made_compression(folder / f"base-s{seed}", seed, power(factor))
    for seed in (1, 2):
        made_compression(folder / f"xi-s{seed}", seed, power(2.0), criticalRolling=1.6e-9, states=False)
    made_compression(folder / "k0-s1", 1, power(), linearDamping=0.0, stepFraction=0.1, states=False)
    silicate = made_compression(
        folder / "silicate-s1",
        1,
        lambda filling: 300.0 * (filling / 0.24) ** 3,
        states=False,
        **SILICATE_GRAINS,
    )
    assert silicate.exists()
    made_compression(folder / "stretched-s1", 1, power(0.8), states=False, finalFilling=0.501, stretched=True)
    return folder


@pytest.fixture(scope="module")
def found(runs, tmp_path_factory):
    folder = tmp_path_factory.mktemp("figures")
    done = analyse(runs, "--figures", folder, "--json")
    assert done.returncode == 0, done.stderr
    return folder, json.loads(done.stdout), done


def section(content, heading):
    return next(s["rows"] for s in content["sections"] if s["heading"].startswith(heading))


def test_the_power_law_comes_back(found):
    _, content, _ = found
    lines = {
        row["quantity"]: row
        for row in section(content, "compressive strength: ice, N = 512, C_v = 3e-07, k_n = 0.01, xi_crit = 8")
    }
    assert lines["n"]["ours"] == pytest.approx(3.0, abs=1e-3) and lines["n"]["error"] < 1e-3
    # Bins are averaged as T23's formula rises, to which phi^3 is flatter by 0.5 at 0.1: a thousandth, continued to 1.
    assert lines["P0"]["ours"] == pytest.approx(SCALE, rel=4e-3)
    three = lines["P0 with n = 3"]
    # The mean of factors 0.8, 1.2, 0.9, 1.1: their standard deviation is 0.183, of the mean 0.091.
    assert three["ours"] == pytest.approx(SCALE, rel=1e-3) and three["error"] == pytest.approx(0.0913 * SCALE, rel=0.02)
    assert three["paper"] == pytest.approx(SCALE, rel=1e-3)


def test_dependence_on_the_parameters(found):
    _, content, _ = found
    rows = section(content, "dependence on the parameters")
    ratios = {(row["material"], row["criticalRolling"], row["linearDamping"]): row["ratio"] for row in rows}
    assert ratios["ice", 1.6e-9, 0.01] == pytest.approx(1.0, rel=1e-3)  # twice the pressure, twice E_roll
    assert ratios["ice", 0.8e-9, 0.0] == pytest.approx(1.0, rel=1e-3)
    assert next(row["runs"] for row in rows if row["criticalRolling"] == 0.8e-9 and row["linearDamping"] == 0.01) == 4


def test_what_a_parameter_changes_by_the_same_clusters(found):
    """Twice the pressure at twice E_roll, of clusters that have 0.8 and 1.2 of it otherwise; k_n = 0 has another step too."""
    _, content, _ = found
    (row,) = section(content, "one parameter changed")
    logarithms = -np.log([0.8, 1.2])
    assert (row["parameter"], row["from"], row["to"], row["seeds"]) == ("xi_crit [Å]", 8.0, 16.0, 2)
    assert row["ratio"] == pytest.approx(np.exp(logarithms.mean()), rel=1e-3)
    assert row["error"] == pytest.approx(logarithms.std(ddof=1) / np.sqrt(2), rel=2e-2)
    # Student's t with one degree of freedom is Cauchy's distribution
    assert row["chance"] == pytest.approx(1 - 2 / np.pi * np.arctan(logarithms.mean() / row["error"]), rel=1e-2)


def test_silicate_at_300_pascal(found):
    _, content, _ = found
    rows = section(content, "silicate at 300 Pa")
    assert [row["paper"] for row in rows] == [0.24, 0.21, 0.17]
    assert rows[0]["ours"] == pytest.approx(0.24, rel=2e-3)


def test_which_channel_is_largest(found):
    _, content, _ = found
    rows = [row for row in section(content, "where the energy goes") if row["criticalRolling"] == 1.6e-9]
    assert {row["filling"]: row["largest"] for row in rows} == {
        0.01: "rolling",
        0.03: "rolling",
        0.1: "rolling",
        0.3: "twisting",
        0.4: "twisting",
        0.5: "twisting",
    }
    assert all(row["rollingDissipation"] + row["twistingDissipation"] == pytest.approx(1.0) for row in rows)


def test_structure_strength_at_any_filling_and_tension(found):
    _, content, _ = found
    rows = section(content, "strength at any filling")
    own = [row for row in rows if row["linearDamping"] == 0.01]
    assert own[0]["filling"] == pytest.approx(0.0422, rel=2e-3) and own[-1]["filling"] == 0.49
    # Means of factors 0.8, 1.2, 0.9, 1.1, to what the width of a bin of phi^3 is worth.
    assert all(row["over_K13"] == pytest.approx([1.0, 0.0913], rel=5e-3) and row["runs"] == 4 for row in own)
    t23 = [row["pressure"][0] * (1 / row["filling"] - 1 / 0.74) ** 3 / SCALE for row in own]
    assert [row["over_T23"][0] for row in own] == pytest.approx(t23, rel=1e-4)
    assert all(row["less_A24"][0] == pytest.approx(0.0, abs=1e-9) for row in own)
    dimension = {row["quantity"]: row["ours"] for row in section(content, "fractal structure")}
    # Of a cubic lattice 3.4 r0 apart: one site nearer than 3 r0, 93 nearer than 10 r0.
    assert dimension["D at a filling of 0.1"] == pytest.approx(np.log(93) / np.log(10 / 3), rel=1e-9)
    (tension,) = section(content, "tensile strength")
    assert tension["ours"] == pytest.approx(0.8 * SCALE * 0.5**3, rel=0.02) and tension["paper"] is None  # three axes


def test_figures_and_page(found):
    folder, _, _ = found
    names = {file.name for file in folder.iterdir()}
    figures = {"fig04_strength", "fig07_damping", "fig08_energy", "fig09_rolling", "fig10_energy", "fig11_structure"}
    assert {f"{name}.png" for name in figures | {"fig12_silicate", "fig13_silicate", "tension", "whole_range"}} <= names
    assert "fig05_rate.png" not in names  # one strain rate only
    assert "What this can't tell" in (folder / "comparison.md").read_text()


def test_the_table_gives_the_same(found):
    folder, content, _ = found
    again = json.loads(analyse(folder / "runs.csv", "--json").stdout)
    assert again["sections"] == content["sections"]


def test_what_is_left_out(runs, tmp_path):
    shutil.copytree(runs / "k0-s1", tmp_path / "a")
    shutil.copytree(runs / "k0-s1", tmp_path / "twin")
    made_compression(tmp_path / "short", 7, power(), states=False)
    with np.load(tmp_path / "short" / "history.npz") as file:
        history = {name: array[:30] for name, array in file.items()}
    np.savez(tmp_path / "short" / "history.npz", **history)
    made_compression(tmp_path / "drag", 8, power(), states=False, viscoelasticTime=1e-12)
    done = analyse(tmp_path, "--json")
    assert done.returncode == 0
    lines = sorted(line.split(": ", 2)[-1] for line in done.stderr.splitlines())
    assert len(lines) == 3
    assert any("covers no bin of the filling factor" in line for line in lines)
    assert any("the same grains" in line for line in lines)
    assert any("viscoelasticTime = 1e-12" in line for line in lines)


def test_families_of_one_parameter(runs):
    """Of k_n, with a longer step for one of its values, and of xi_crit; none of the strain rate."""
    from analysis.studies.analyse import analyse as analyse_runs
    from analysis.studies.compression.results import family
    from analysis.studies.find import find

    results = analyse_runs(find("compression"), [runs]).results
    damping = family(results, "linearDamping")
    assert [group.parameters["linearDamping"] for group in damping] == [0.0, 0.01]
    assert [group.seeds for group in damping] == [1, 4]
    assert [group.parameters["criticalRolling"] for group in family(results, "criticalRolling")] == [0.8e-9, 1.6e-9]
    assert family(results, "strainRate") == ()
    assert results.main is damping[1]


@pytest.mark.parametrize(
    "name, value, shown",
    [
        ("surfaceEnergy", 0.05, "ice (gamma = 0.05 J/m^2)"),
        ("young", 3.5e9, "ice (E = 3.5 GPa)"),
        ("poisson", 0.3, "ice (nu = 0.3)"),
        ("density", 500.0, "ice (rho = 500 kg/m^3)"),
        ("grainRadius", 5e-8, "ice (r0 = 0.05 um)"),
        ("slidingStiffnessFactor", 2.0, "ice (k_s factor = 2)"),
        ("criticalRolling", 4e-10, "ice"),
    ],
)
def test_other_grains_are_kept_apart(tmp_path, name, value, shown):
    """The same seeds of other grains are neither duplicates of K13's nor seeds of one group, and have an E_roll of their own."""
    for seed in (1, 2):
        made_compression(tmp_path / f"a{seed}", seed, power(), states=False)
        made_compression(tmp_path / f"b{seed}", seed, power(), states=False, **{name: value})
    done = analyse(tmp_path, "--json")
    assert done.returncode == 0 and "the same" not in done.stderr
    rows = section(json.loads(done.stdout), "dependence on the parameters")
    assert sorted(row["runs"] for row in rows) == [2, 2]
    own, other = sorted(rows, key=lambda row: row[name] == value)
    e_roll = {"surfaceEnergy": 0.5, "criticalRolling": 0.5, "grainRadius": 4.0}.get(name, 1.0)  # over r0^3
    assert other["ratio"] * e_roll == pytest.approx(own["ratio"], rel=1e-6)
    text = analyse(tmp_path).stdout
    assert f"compressive strength: {shown}, N = 512" in text


def test_private_grains_are_not_k13s(tmp_path):
    """They come last, whatever their seeds; with silicate of another radius there is no number of a paper."""
    from analysis.studies.analyse import analyse as analyse_runs
    from analysis.studies.find import find

    made_compression(tmp_path / "a", 1, power(), states=False)
    for seed in (1, 2, 3):
        made_compression(tmp_path / f"b{seed}", seed, power(), states=False, surfaceEnergy=0.05, grains=2048)
    made_compression(tmp_path / "c", 1, power(), states=False, **{**SILICATE_GRAINS, "grainRadius": 1e-7})
    found = analyse_runs(find("compression"), [tmp_path])
    assert found.results.main.parameters["surfaceEnergy"] == 0.1 and found.results.larger is None
    assert [group.seeds for group in found.results.of_k13s_grains] == [1]
    (row, *_) = section(json.loads(analyse(tmp_path, "--json").stdout), "strength at any filling")
    assert row["surfaceEnergy"] == 0.1
    (silicate,) = section({"sections": [vars(s) | {"rows": s.records} for s in found.report.sections]}, "silicate")
    assert silicate["paper"] is None and np.isfinite(silicate["ours"])


def test_k13s_silicate_is_shown_before_other_silicate(tmp_path):
    """Fig. 13 draws the first: K13's, though the other has more clusters."""
    made_compression(tmp_path / "own", 1, power(), states=False, **SILICATE_GRAINS)
    for seed in (1, 2):
        made_compression(
            tmp_path / f"b{seed}", seed, power(), states=False, **{**SILICATE_GRAINS, "surfaceEnergy": 0.1}
        )
    rows = section(json.loads(analyse(tmp_path, "--json").stdout), "silicate at 300 Pa")
    assert [row["paper"] for row in rows] == [0.24, 0.21, 0.17, None]


def test_tension_of_unlike_runs_is_not_pooled(tmp_path):
    for number, other in enumerate(({}, {"criticalRolling": 4e-10}, {"linearDamping": 0.0}, {"stepFraction": 0.1})):
        for seed in (1, 2):
            path = tmp_path / f"{number}-{seed}"
            made_compression(path, seed, power(0.8 + 0.1 * number), states=False, stretched=True, **other)
    rows = section(json.loads(analyse(tmp_path, "--json").stdout), "tensile strength")
    assert len(rows) == 4 and all("2 runs" in row["note"] for row in rows)
    assert len({round(row["ours"]) for row in rows}) == 4


def test_the_set_of_most_clusters_is_shown_first_and_more_grains_beside_it(tmp_path):
    from analysis.studies.analyse import analyse as analyse_runs
    from analysis.studies.find import find

    for seed in (1, 2, 3):
        made_compression(tmp_path / f"a{seed}", seed, power(), states=False)
    made_compression(tmp_path / "b", 1, power(), states=False, grains=4096)
    results = analyse_runs(find("compression"), [tmp_path]).results
    assert (results.main.parameters["grains"], results.main.seeds) == (512, 3)
    assert results.larger.parameters["grains"] == 4096 and results.shown == (results.main, results.larger)


def test_filling_factors_beyond_some_clusters_are_those_of_the_others(tmp_path):
    """Two of three end at 0.5: 0.6 is of the third alone, and no error is given for it."""
    for seed in (1, 2, 3):
        made_compression(
            tmp_path / f"a{seed}", seed, power(0.7 + 0.1 * seed), states=False, high=0.64 if seed == 1 else 0.5
        )
    rows = section(json.loads(analyse(tmp_path, "--json").stdout), "strength at any filling")
    runs = {row["filling"]: row["runs"] for row in rows}
    assert (runs[0.49], runs[0.55], runs[0.6], runs[0.625]) == (3, 1, 1, 1)
    last = rows[-1]
    assert last["over_K13"][0] == pytest.approx(0.8, rel=0.02) and last["over_K13"][1] is None


def test_bins_before_the_cell_is_spanned_are_not_fitted(found):
    """The made states are not connected along z before that at 0.0305: the first bin above is that of 0.0422."""
    _, content, _ = found
    rows = section(content, "dependence on the parameters")
    lows = {(row["criticalRolling"], row["linearDamping"]): row["from"] for row in rows if row["material"] == "ice"}
    assert lows[0.8e-9, 0.01] == pytest.approx(0.0422, rel=2e-3)
    assert lows[1.6e-9, 0.01] == pytest.approx(0.0205, rel=2e-3)  # no states tell: a free cluster's (eq 24)


def test_increments_and_where_twisting_sets_in(found):
    """Rolling until 0.1 and twisting beyond, in all runs."""
    _, content, _ = found
    rows = [row for row in section(content, "where the energy goes between") if row["criticalRolling"] == 0.8e-9]
    shares = {row["from"]: (row["rollingDissipation"][0], row["twistingDissipation"][0]) for row in rows}
    assert shares[0.01] == pytest.approx((1, 0)) and shares[0.3] == pytest.approx((0, 1))
    (own,) = (
        row
        for row in section(content, "where twisting sets in")
        if (row["material"], row["criticalRolling"], row["linearDamping"]) == ("ice", 0.8e-9, 0.01)
    )
    assert own["0.001"] == pytest.approx([0.1] * 4, rel=5e-3) and all(0.1 < filling < 0.12 for filling in own["0.1"])


def test_p_of_a_scale_is_of_its_logarithm(found):
    _, content, _ = found
    lines = section(content, "compressive strength: ice, N = 512, C_v = 3e-07, k_n = 0.01, xi_crit = 8")
    (line,) = (row for row in lines if row["quantity"] == "P0 with n = 3")
    assert line["difference"] == pytest.approx(np.log(line["ours"] / line["paper"]) / (line["error"] / line["ours"]))


def test_every_channel_is_named_in_the_legend(runs):
    """With damping in the dashed lines only, it is named too, and by K13's word."""
    from analysis.studies.analyse import analyse as analyse_runs
    from analysis.studies.compression.figures.energy import damping_figure
    from analysis.studies.find import find

    damped = runs / "stretched-s1" / "history.npz"  # that of seed 1 that is drawn
    kept = damped.read_bytes()
    with np.load(damped) as file:
        history = dict(file)
    np.savez(damped, **{**history, "drag": 0.1 * history["rollingDissipation"]})
    try:
        drawn = damping_figure(analyse_runs(find("compression"), [runs]).results)
    finally:
        damped.write_bytes(kept)
    names = [text.get_text() for text in drawn.axes[0].get_legend().get_texts()]
    assert "normal damping" in names and "rolling dissipation" in names and len(set(names)) == len(names)
