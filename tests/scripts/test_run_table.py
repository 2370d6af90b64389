"""run_table.py: every row is run by yade-batch, and a row that fails is not overlooked."""

import os

import pytest
from running import PYTHON, RUN_TABLE, call, read_json

from yade_scripts.run.closing_line import closing_line, read_closing_line


def run_table(folder, *arguments):
    return call(folder, PYTHON, RUN_TABLE, *arguments)


def test_a_failing_row_gives_a_failing_table(tmp_path):
    (tmp_path / "rows.table").write_text("description radius velocity duration\n" "good 4 10 1e-9\n" "bad  4 -1 =\n")
    done = run_table(tmp_path, "rows.table")
    assert done.returncode == 1
    assert done.stderr == ("run_table.py: runs/logs/rows.3.bad.log: collide.py: velocity = -1: must be > 0 [m/s]\n")
    assert done.stdout.rstrip().endswith("2 rows, 1 failures")
    assert read_json(tmp_path, "runs", "good", "run.json")["outcome"] == "completed"
    assert sorted(os.listdir(tmp_path / "runs")) == ["good", "logs"]


def test_good_rows_give_a_good_table(tmp_path):
    (tmp_path / "rows.table").write_text("radius! velocity material duration seed!\n4 10 'ice' 5e-10 1\n= = ice = 2\n")
    done = run_table(tmp_path, "rows.table", "-l", "2-3")
    assert done.returncode == 0, done.stdout + done.stderr
    assert sorted(os.listdir(tmp_path / "runs")) == ["logs", "radius=4,seed=1", "radius=4,seed=2"]


TOO_LONG = f"description radius velocity\ngood 4 10\n{'x' * 250} 4 10\n"
USELESS = {TOO_LONG: "line 3: its log's name would have 261 bytes; must be at most 255", "": "no such table"}


@pytest.mark.parametrize("text", USELESS, ids=["too long", "no table"])
def test_a_table_that_cannot_be_run_is_one_line(tmp_path, text):
    if text:
        (tmp_path / "rows.table").write_text(text)
    done = run_table(tmp_path, "rows.table")
    assert (done.returncode, done.stdout, done.stderr.count("\n")) == (1, "", 1)
    assert done.stderr.startswith(f"run_table.py: rows.table: {USELESS[text]}") and not os.path.exists(
        tmp_path / "runs"
    )


@pytest.mark.parametrize("outcome", ["completed", "interrupted", "failed: energy (1 J): (a) b"])
def test_closing_line_is_read_back(outcome):
    log = "Welcome\n" + closing_line("runs/a (1)", outcome, 12.34) + "\nbye\n"
    assert read_closing_line(log) == ("runs/a (1)", outcome)
    assert read_closing_line("Welcome\n") is None
