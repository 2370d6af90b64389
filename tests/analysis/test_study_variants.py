"""The same pairs changed and unchanged, compared pair by pair."""

import io
import json
from contextlib import redirect_stdout

import pytest
from made_collisions import made_run

from analysis.__main__ import main


def test_paired_differences(tmp_path):
    """Compressions larger by 5 % and 4 % with drag in pairs that differ by 1 r: the difference is that of d_max itself, and the
    scatter of the pairs drops out. A run without a twin does not count as a pair."""
    for seed, stretch in ((1, 1.05), (2, 1.04)):
        shift = float(seed)
        made_run(tmp_path / f"a{seed}", 40.0, 10**0.5, seed, shift, filling=0.35, viscoelasticTime=0.0)
        made_run(
            tmp_path / f"b{seed}", 40.0, 10**0.5, seed, shift, filling=0.35, stretch=stretch, viscoelasticTime=3e-12
        )
    made_run(tmp_path / "c", 40.0, 10**0.5, 9, 0.0, filling=0.35, viscoelasticTime=3e-12)
    out = io.StringIO()
    with redirect_stdout(out):
        assert main(["study", "elastoplastic_variants", str(tmp_path), "--json"]) == 0
    ((row,),) = [section["rows"] for section in json.loads(out.getvalue())["sections"]]
    assert (row["viscoelasticTime"], row["runs"], row["pairs"]) == (3e-12, 3, 2)
    mean, error, chance = row["d_max"]
    assert (
        0.005 < error < mean
        and mean / error == pytest.approx(9.0, rel=0.02)
        and chance == pytest.approx(0.07, abs=0.005)
    )
    assert row["t_max"][0] > 0


def test_every_variant_is_compared_with_the_unchanged_pairs(tmp_path, capsys):
    for seed in (1, 2):
        made_run(tmp_path / f"a{seed}", 40.0, 10**0.5, seed, float(seed), filling=0.35)
        for name, changed in (("b", {"removeLooseGrains": 1}), ("c", {"initialOverlap": 1e-3})):
            made_run(tmp_path / f"{name}{seed}", 40.0, 10**0.5, seed, seed + 0.1 * seed, filling=0.35, **changed)
    assert main(["study", "elastoplastic_variants", str(tmp_path), "--json"]) == 0
    ((section),) = json.loads(capsys.readouterr().out)["sections"]
    found = {(row["removeLooseGrains"], row["initialOverlap"]): row for row in section["rows"]}
    assert sorted(found) == [(0, 1e-3), (1, 1)] and all(row["pairs"] == 2 for row in found.values())
    # The study of the paper's own scene takes the unchanged runs only.
    assert main(["study", "elastoplastic", str(tmp_path), "--json"]) == 0
    said = capsys.readouterr()
    assert said.err.count("left out") == 4
    assert "removeLooseGrains = 1, A24's scene has 0" in said.err
