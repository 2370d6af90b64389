"""Tables of the runs that test the gallery's claims, and the packings measured without running them."""

import math
import os

import numpy as np
import pytest

from analysis.runs.table import read_table
from analysis.studies.elastoplastic import prediction
from analysis.studies.elastoplastic.measure import COLUMNS
from yade_scripts.studies import elastoplastic_packings, elastoplastic_referee

STUDIES = os.path.dirname(elastoplastic_referee.__file__)
RUNS = prediction.GALLERY / "runs.csv"


def rows(name):
    """Cells {column: text} of a table's rows."""
    with open(os.path.join(STUDIES, name), encoding="utf-8") as file:
        lines = [line.split() for line in file if line.strip() and not line.startswith("#")]
    return [dict(zip(lines[0], line)) for line in lines[1:]]


def test_committed_tables_are_what_the_generator_writes(tmp_path):
    elastoplastic_referee.write_tables(tmp_path)
    assert sorted(os.listdir(tmp_path)) == sorted(elastoplastic_referee.TABLES)
    for name in os.listdir(tmp_path):
        with open(os.path.join(STUDIES, name), encoding="utf-8") as file:
            assert file.read() == (tmp_path / name).read_text(encoding="utf-8"), f"{name}: run elastoplastic_referee.py"


def test_predicted_pairs_are_in_no_other_table():
    """At the velocity that was predicted; elsewhere they may recur."""
    key = ("filling", "radius", "velocity", "seed")
    new = {tuple(row[name] for name in key) for row in rows("elastoplastic-prediction.table")}
    predicted = {
        (f"{f:g}", f"{each.radius}", f"10**(0.1*{round(10 * math.log10(each.velocity))})", str(seed))
        for each in prediction.SETS
        for f in prediction.FILLINGS
        for seed in each.seeds
    }
    assert new == predicted and len(new) == 50
    # all that A24 ran, pairs that are predicted here among them; it has not been run
    paper = "elastoplastic-full.table"
    others = {n for n in os.listdir(STUDIES) if n.endswith(".table")} - {"elastoplastic-prediction.table", paper}
    for name in others:
        assert not new & {tuple(row.get(k) for k in key) for row in rows(name)}
    written = [row for each in prediction.SETS for row in prediction.read(each.path).itertuples()]
    pairs = {(f"{row.filling:g}", f"{row.radius / 1e-7:g}", str(row.seed)) for row in written}
    assert pairs == {(filling, radius, seed) for filling, radius, _, seed in new} and len(pairs) == len(written)


def test_rows_have_folders_of_their_own():
    folders = [row["out"] for name in elastoplastic_referee.TABLES for row in rows(name)]
    assert len(folders) == len(set(folders))


def test_core_hours_are_those_of_the_runs_that_were_measured():
    """The 172 rows of elastoplastic-desk.table took 6.55 h."""
    hours = 0.0
    for row in rows("elastoplastic-desk.table"):
        radius, duration = float(row["radius"]), row["duration"]
        short = duration == "*" or duration.startswith("64.6")
        hours += elastoplastic_referee.core_hours(
            float(row["filling"]), radius, 12.5e-9 * radius if short else float(duration)
        )
    assert hours == pytest.approx(6.55, rel=0.05)


def test_packings_made_again_are_those_of_the_runs():
    """d(0) of a run, which is in the table, from its packings; and what is measured of them."""
    table, _ = read_table(RUNS, COLUMNS)
    for row in table[table.radius < 4.5e-6].drop_duplicates(["filling"]).itertuples():
        offset, values = elastoplastic_packings.before_contact(
            row.filling, row.radius, row.grain_radius, row.overlap, row.seed
        )
        assert offset == pytest.approx(row.offset, abs=1e-9 * row.grain_radius)
        for name, value in values.items():
            assert getattr(row, name) == pytest.approx(value, rel=1e-9)
    with pytest.raises(SystemExit, match="must be one of predictions.csv, predictions_slow.csv, predictions_large.csv"):
        elastoplastic_packings.main(["predict", str(RUNS), "other.csv"])
    assert not table[["zone_filling", "loose_grains"]].isna().any().any()


def test_filling_a_table_stops_where_the_packings_are_others(tmp_path):
    text = RUNS.read_text()
    names = next(line for line in text.splitlines() if line.startswith("run,")).split(",")
    body = [line for line in text.splitlines() if not line.startswith("#")]
    cells = body[1].split(",")
    cells[names.index("zone_filling")] = ""
    cells[names.index("offset")] = repr(float(cells[names.index("offset")]) + 1e-9)
    (tmp_path / "runs.csv").write_text(text.replace(body[1], ",".join(cells)))
    with pytest.raises(SystemExit, match="its packings are not those of"):
        elastoplastic_packings.fill(tmp_path / "runs.csv")
    cells[names.index("offset")] = body[1].split(",")[names.index("offset")]
    (tmp_path / "runs.csv").write_text(text.replace(body[1], ",".join(cells)))
    assert elastoplastic_packings.fill(tmp_path / "runs.csv") == 1
    filled, _ = read_table(tmp_path / "runs.csv", COLUMNS)
    again, _ = read_table(RUNS, COLUMNS)
    assert np.allclose(filled.zone_filling, again.zone_filling, rtol=1e-9)
