"""The study of Kataoka et al. (2013), of made compressions whose answers are known."""

import numpy as np
import pytest
from made_compressions import SILICATE_GRAINS, made_compression
from study_answers_before import answered, quantities, rows
from written_runs import seal

from analysis.__main__ import main
from analysis.studies.compression.strength import exponent, level

SCALE = 4.7374e5


def power(factor=1.0):
    return lambda filling: factor * SCALE * filling**3


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    """{quantity: [row]} of four clusters of P0 phi^3 that scatter by tenths, two of another xi_crit, silicate, and one that is stretched."""
    tmp_path = tmp_path_factory.mktemp("compression")
    for seed, factor in enumerate((0.8, 1.2, 0.9, 1.1), start=1):
        made_compression(tmp_path / f"base-s{seed}", seed, power(factor))
    for seed in (1, 2):
        made_compression(tmp_path / f"xi-s{seed}", seed, power(2.0), criticalRolling=1.6e-9, states=False)
    silicate = lambda filling: 300.0 * (filling / 0.24) ** 3
    made_compression(tmp_path / "silicate-s1", 1, silicate, states=False, **SILICATE_GRAINS)
    made_compression(tmp_path / "stretched-s1", 1, power(0.8), states=False, finalFilling=0.501, stretched=True)
    assert main(["study", "compression", str(tmp_path), "--figures", str(tmp_path / "out")]) == 0
    return quantities((tmp_path / "out" / "comparison.json").read_text())


def test_what_was_made_comes_back(found):
    """The mean of factors 0.8, 1.2, 0.9, 1.1 has the standard error 0.0913. Before the state at 0.0305 cells are not connected along
    z: the first bin above is that of 0.0422, where fits begin. Twice the pressure at twice E_roll, of the two clusters that have 0.8
    and 1.2 of it otherwise: their mean is 1. Rolling until 0.1 and twisting beyond; a cubic lattice 3.4 r0 apart has one site nearer
    than 3 r0 and 93 nearer than 10 r0."""
    (n,), (scale,) = (rows(found[name], material="ice", criticalRolling=8e-10) for name in ("exponent", "level"))
    assert n["value"] == pytest.approx(3.0, abs=1e-3) and n["error"] < 1e-3
    assert scale["value"] == pytest.approx(1.0, rel=1e-3) and scale["error"] == pytest.approx(0.0913, rel=0.06)
    begins = [row["start"] for row in rows(found["level_from"], material="ice", criticalRolling=8e-10)]
    assert begins == pytest.approx([0.0422, 0.0562], rel=2e-3)
    dense = rows(found["dense"], filling=0.49)[0]
    assert dense["value"] == pytest.approx(0.49**3 * (1 / 0.49 - 1 / 0.74) ** 3, rel=5e-3)
    assert all(row["value"] == pytest.approx(0.0, abs=1e-9) for row in found["contacts"])
    (change,) = found["change"]
    assert (change["changed"], change["criticalRolling"], change["pairs"]) == ("critical displacement", 1.6e-9, 2)
    assert change["value"] == pytest.approx(1.0, rel=1e-3) and change["error"] == pytest.approx(0.2, rel=0.1)
    base = {"material": "ice", "criticalRolling": 8e-10}
    for since, until, channel in ((0.03, 0.1, "rolling"), (0.3, 0.4, "twisting")):
        (row,) = rows(found["shares"], **base, since=since, until=until, channel=channel)
        assert row["value"] == pytest.approx(1.0)
    assert rows(found["twisting_from"], **base, share=0.001)[0]["value"] == pytest.approx(0.1, rel=5e-3)
    (dimension,) = rows(found["dimension"], **base, filling=0.1)
    assert dimension["value"] == pytest.approx(np.log(93) / np.log(10 / 3), rel=1e-9)
    assert found["tensile"][0]["value"] == pytest.approx(0.8 * SCALE * 0.5**3, rel=0.02) and not found["tensile_over"]
    assert rows(found["filling_at_300"], material="silicate")[0]["value"] == pytest.approx(0.24, rel=2e-3)


def test_a_mean_is_over_all_clusters_that_went_so_far(tmp_path, capsys):
    """Two of three end at 0.5; the third begins at 0.01, and where it has no pressure yet there is no mean."""
    for seed in (1, 2, 3):
        ends = {"low": 0.01} if seed == 3 else {"high": 0.64} if seed == 1 else {}
        made_compression(tmp_path / f"a{seed}", seed, power(0.7 + 0.1 * seed), states=False, **ends)
    found, _, _ = answered(capsys, "compression", tmp_path)
    pairs = {round(row["filling"], 4): row["pairs"] for row in found["strength"]}
    assert (pairs[0.0133], pairs[0.49], pairs[0.55], pairs[0.625]) == (3, 3, 1, 1) and min(pairs) == 0.0133


def test_a_fit_is_of_the_same_clusters_everywhere(tmp_path, capsys):
    """Nine times the pressure of a cluster that ends before the bin around 0.1 makes no slope."""
    made_compression(tmp_path / "a1", 1, power(1.0), states=False)
    made_compression(tmp_path / "a2", 2, power(9.0), states=False, high=0.11)
    (n,) = answered(capsys, "compression", tmp_path)[0]["exponent"]
    assert n["value"] == pytest.approx(3.0, abs=1e-3) and n["pairs"] == 2


@pytest.mark.parametrize(
    "name, value, shown, e_roll",  # over r0^3, of K13's
    [
        ("surfaceEnergy", 0.05, "ice (gamma = 0.05 J/m^2)", 0.5),
        ("young", 3.5e9, "ice (E = 3.5 GPa)", 1.0),
        ("grainRadius", 5e-8, "ice (r0 = 0.05 um)", 4.0),
        ("slidingStiffnessFactor", 2.0, "ice (k_s factor = 2)", 1.0),
        ("criticalRolling", 4e-10, "ice", 0.5),
    ],
)
def test_other_grains_are_sets_of_their_own(tmp_path, capsys, name, value, shown, e_roll):
    for seed in (1, 2):
        made_compression(tmp_path / f"a{seed}", seed, power(), states=False)
        made_compression(tmp_path / f"b{seed}", seed, power(), states=False, **{name: value})
    found, _, err = answered(capsys, "compression", tmp_path)
    assert "the same" not in err and [row["pairs"] for row in found["level"]] == [2, 2]
    own, other = sorted(found["level"], key=lambda row: (row["material"] != "ice", row["criticalRolling"] != 8e-10))
    assert other["material"] == shown and other["value"] * e_roll == pytest.approx(own["value"], rel=1e-6)


def test_twins_and_runs_without_a_bin_are_left_out(tmp_path, capsys):
    for path in ("a", "twin"):
        made_compression(tmp_path / path, 1, power(), states=False)
    made_compression(tmp_path / "short", 7, power(), states=False)
    with np.load(tmp_path / "short" / "history.npz") as file:
        np.savez(tmp_path / "short" / "history.npz", **{name: array[:30] for name, array in file.items()})
    seal(tmp_path / "short")
    made_compression(tmp_path / "drag", 8, power(), states=False, viscoelasticTime=1e-12)
    found, _, err = answered(capsys, "compression", tmp_path)
    assert len(err.splitlines()) == 3 and "covers no bin of the filling factor" in err
    assert "the same grains" in err and "viscoelasticTime = 1e-12" in err


def test_power_laws_in_closed_form():
    filling = np.geomspace(0.01, 0.1, 7)
    over = np.stack([0.8 * filling**0.2, 2.0 * filling**-0.5])
    assert exponent(filling, over) == pytest.approx([3.2, 2.5])
    assert level(filling, over) == pytest.approx([0.8 * 0.001**0.1, 2.0 * 0.001**-0.25])
    assert np.isnan(exponent(filling, -over)).all() and np.isnan(level(filling, -over)).all()
