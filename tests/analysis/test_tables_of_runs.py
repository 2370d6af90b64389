"""Tables of runs as files that were edited elsewhere."""

import pandas
import pytest

from analysis.runs.table import Column, TableError, read_table, table_text

COLUMNS = (Column("velocity", "m/s", "impact velocity"), Column("seed", "", "seed", kind="i"))


@pytest.fixture
def text():
    table = pandas.DataFrame([{"run": "a", "velocity": 0.1, "seed": 1}, {"run": "b", "velocity": 1 / 3, "seed": 2}])
    return table_text(table, COLUMNS, {"study": "own", "runs": 2})


@pytest.fixture
def old(text):
    """One of a version that wrote no sums."""
    return "# {" + text[text.index('"study"') :]


@pytest.mark.parametrize("encoding", ["utf-8", "utf-8-sig"])
def test_what_was_written_is_read_back(tmp_path, text, encoding):
    (tmp_path / "runs.csv").write_text(text, encoding=encoding)
    table, head = read_table(tmp_path / "runs.csv", COLUMNS)
    assert (
        head == {"study": "own", "runs": 2}
        and list(table["velocity"]) == [0.1, 1 / 3]
        and list(table["seed"]) == [1, 2]
    )


@pytest.mark.parametrize(
    "change, message",
    [
        (lambda text: text.replace("seed\n", "velocity\n"), "has the column velocity 2 times; must be once"),
        (lambda text: text.replace('"own"', "[" * 100_000), "its first line is nested too deeply"),
    ],
    ids=["twice", "nested"],
)
def test_files_that_are_no_table_are_one_line(tmp_path, old, change, message):
    (tmp_path / "runs.csv").write_text(change(old))
    with pytest.raises(TableError, match=message) as error:
        read_table(tmp_path / "runs.csv", COLUMNS)
    assert "\n" not in str(error.value)
