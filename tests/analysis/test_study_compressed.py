"""CPE aggregates beside spheres cut out of compressed cells, of made collisions."""

import re

import pytest
from study_answers import answered
from written_runs import RADIUS, two_pairs

PACKING = {"packing": "compressed", "filling": 0.401, "nominal": 0.4, "aggregateRadius": 20 * RADIUS}


def collision(path, seed, compressed=False, **derived):
    if compressed:
        derived |= {"targetPacking": {**PACKING, "cell": seed}, "projectilePacking": {**PACKING, "filling": 0.399}}
    packing = "file" if compressed else "cpe"
    two_pairs(path, 3.0, seed, derived=derived, packing=packing, filling=0.4, radius=20.0)


def test_both_kinds_from_the_first_touch_on(tmp_path, capsys):
    """They touch at 101 ns and turn around at 200 ns, 99^2/200 ns times v nearer."""
    for seed in (1, 2, 3):
        for compressed in (0, 1):
            collision(tmp_path / f"{compressed}-{seed}", seed, compressed=bool(compressed))
    found, _, _ = answered(capsys, "compressed", tmp_path)
    found = {re.sub(r", φ = 0.4, 3 m/s.*?(?= \[|$)", "", what): row["ours"] for what, row in found.items()}
    deepest = pytest.approx(3.0 * 99e-9**2 / 200e-9 / RADIUS, rel=1e-3)
    # A24 eqs 31 and 44, of spheres of 400 kg/m^3 with R* = 10 r
    over = 16 / 3 * 400 * 3.0**2 / (0.1 * deepest.expected) ** 2 / (0.47e6 * (1 / 0.4 - 1 / 0.74) ** -3)
    for kind in ("CPE", "compressed"):
        assert found[f"compression from the first touch to d_max, {kind} [r]"] == deepest
        assert found[f"its time, {kind} [ns]"] == pytest.approx(99, rel=0.02)
        assert found[f"yield stress over A24's static one, {kind}"] == pytest.approx(over, rel=3e-3)
        assert found[f"sticking, {kind}"] == pytest.approx(0.8)
    assert found["compression, compressed over CPE"] == pytest.approx(1.0)


def test_other_packings_are_left_out_and_other_grains_and_steps_kept_apart(tmp_path, capsys):
    collision(tmp_path / "a", 1)
    collision(tmp_path / "gamma", 1, surfaceEnergy=0.05)
    collision(tmp_path / "step", 1, timeStep=1e-11)
    two_pairs(tmp_path / "other", 3.0, 1, packing="file")
    found, runs, err = answered(capsys, "compressed", tmp_path)
    assert "neither CPE aggregates nor spheres cut out" in err and "the same" not in err and runs == 3
    deepest = [quantity for quantity in found if quantity.startswith("compression from")]
    assert len(deepest) == 3 and sum("ice (surfaceEnergy = 0.05)" in quantity for quantity in deepest) == 1
