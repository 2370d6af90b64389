"""python3 -m analysis study compression as a user runs it, on made-up run folders."""

import io
import json
import shutil
import warnings
from contextlib import redirect_stderr, redirect_stdout
from types import SimpleNamespace

import numpy as np
import pytest
from made_compressions import made_compression

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
        material="silicate",
        grainRadius=6e-7,
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
    assert lines["P0"]["ours"] == pytest.approx(SCALE, rel=2e-3)
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
        0.5: "twisting",
    }
    assert all(row["rollingDissipation"] + row["twistingDissipation"] == pytest.approx(1.0) for row in rows)


def test_structure_strength_at_any_filling_and_tension(found):
    _, content, _ = found
    rows = section(content, "strength at any filling")
    assert all(row["pressure"] / row["K13"] == pytest.approx(1.0, rel=1e-3) for row in rows)
    assert all(row["coordination"] == pytest.approx(row["A24"], rel=0.02) for row in rows)
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
