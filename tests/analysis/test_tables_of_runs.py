"""Tables of runs as files that were edited elsewhere."""

import pandas
import pytest
from refused import refused

from analysis.runs.table import Column, TableError, make_table, read_table, table_text

COLUMNS = (Column("velocity", "m/s", "impact velocity"), Column("seed", "", "seed", kind="i"))


@pytest.fixture
def text():
    table = pandas.DataFrame([{"run": "a", "velocity": 0.1, "seed": 1}, {"run": "b", "velocity": 1 / 3, "seed": 2}])
    return table_text(table, COLUMNS, {"study": "own", "runs": 2})


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
@pytest.mark.parametrize("version", ["this", "0.5"])
def test_what_was_written_is_read_back(tmp_path, text, encoding, version):
    """Versions 0.5 and 0.6 put the text's sum into its head."""
    if version == "0.5":
        text = text.replace("# {", f'# {{"sha256": "{64 * "0"}", ', 1)
    (tmp_path / "runs.csv").write_text(text, encoding=encoding)
    table, head = read_table(tmp_path / "runs.csv", COLUMNS)
    assert head == {"study": "own", "runs": 2}
    assert list(table["velocity"]) == [0.1, 1 / 3] and list(table["seed"]) == [1, 2]


def test_files_that_are_no_table_are_one_line(tmp_path, text):
    file = tmp_path / "runs.csv"
    for before, after, message in (
        ("seed\n", "velocity\n", "has the column velocity 2 times; must be once"),
        ('"own"', "[" * 100_000, "not a table of runs"),
    ):
        file.write_text(text.replace(before, after))
        with refused(TableError, message):
            read_table(file, COLUMNS)


def test_names_of_any_characters_are_read_back(tmp_path):
    names = ["# s3", "a\u2028b", "c\x85d", "e\udcfff"]
    table = make_table((tmp_path / name, {"velocity": 1.0, "seed": k}) for k, name in enumerate(names))
    (tmp_path / "runs.csv").write_text(table_text(table, COLUMNS, {}), encoding="utf-8")
    again, _ = read_table(tmp_path / "runs.csv", COLUMNS)
    assert list(again.run) == list(table.run) and list(again.seed) == [0, 1, 2, 3] and again.run[0] == "# s3"
