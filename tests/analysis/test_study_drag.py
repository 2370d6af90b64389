"""The same pairs with and without drag, compared pair by pair."""

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
        assert main(["study", "elastoplastic_drag", str(tmp_path), "--json"]) == 0
    ((row,),) = [section["rows"] for section in json.loads(out.getvalue())["sections"]]
    assert (row["viscoelasticTime"], row["runs"], row["pairs"]) == (3e-12, 3, 2)
    mean, error, chance = row["d_max"]
    assert (
        0.005 < error < mean
        and mean / error == pytest.approx(9.0, rel=0.02)
        and chance == pytest.approx(0.07, abs=0.005)
    )
    assert row["t_max"][0] > 0
