"""CPE aggregates beside spheres cut out of compressed cells, of made collisions."""

import pytest
from study_answers_before import answered, quantities
from written_runs import RADIUS, two_pairs

from analysis.__main__ import main

PACKING = {"packing": "compressed", "filling": 0.401, "nominal": 0.4, "aggregateRadius": 20 * RADIUS}


def collision(path, seed, compressed=False, **derived):
    if compressed:
        derived |= {"targetPacking": {**PACKING, "cell": seed}, "projectilePacking": {**PACKING, "filling": 0.399}}
    two_pairs(path, 3.0, seed, derived=derived, packing="file" if compressed else "cpe", filling=0.4, radius=20.0)


def test_both_kinds_from_the_first_touch_on(tmp_path, capsys):
    """They touch at 101 ns and turn around at 200 ns, 99^2/200 ns times v nearer."""
    for seed in (1, 2, 3):
        for compressed in (0, 1):
            collision(tmp_path / f"{compressed}-{seed}", seed, compressed=bool(compressed))
    assert main(["study", "compressed", str(tmp_path), "--json", "--figures", str(tmp_path / "out")]) == 0
    found = quantities(capsys.readouterr().out)
    deepest = pytest.approx(3.0 * 99e-9**2 / 200e-9 / RADIUS, rel=1e-3)
    assert [(row["kind"], row["value"]) for row in found["compression"]] == [("CPE", deepest), ("compressed", deepest)]
    assert all(row["value"] == pytest.approx(99e-9, rel=0.02) and row["pairs"] == 3 for row in found["t_max"])
    assert all(row["value"] == pytest.approx(1.0) for row in (*found["compression_ratio"], *found["lost"]))
    # A24 eqs 31 and 44, of spheres of 400 kg/m^3 with R* = 10 r
    over = 16 / 3 * 400 * 3.0**2 / (0.1 * deepest.expected) ** 2 / (0.47e6 * (1 / 0.4 - 1 / 0.74) ** -3)
    for name in ("over_static", "collision_over_kind"):
        assert found[name] and all(row["value"] == pytest.approx(over, rel=3e-3) for row in found[name]), name
    assert found["sticking"][0]["value"] == 1.0 and (tmp_path / "out" / "channels.png").exists()


def test_other_packings_are_left_out_and_other_grains_and_steps_kept_apart(tmp_path, capsys):
    collision(tmp_path / "a", 1)
    collision(tmp_path / "gamma", 1, surfaceEnergy=0.05)
    collision(tmp_path / "step", 1, timeStep=1e-11)
    two_pairs(tmp_path / "other", 3.0, 1, packing="file")
    found, _, err = answered(capsys, "compressed", tmp_path)
    assert "neither CPE aggregates nor spheres cut out" in err and "the same" not in err
    assert sorted(row["of"] for row in found["compression"]) == ["ice", "ice", "ice (gamma = 0.05 J/m^2)"]
    assert {row["pairs"] for row in found["compression"]} == {1}
