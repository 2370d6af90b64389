"""run_table.py: every row is run by yade-batch, and a row that fails is not overlooked."""

import os
import subprocess

import pytest
from running import PYTHON, RUN_TABLE, TOP, environment, read_json

from yade_scripts.run.closing_line import closing_line, read_closing_line
from yade_scripts.runner import rows

STUDIES = os.path.join(TOP, "yade_scripts", "studies")
TABLES = sorted(name for name in os.listdir(STUDIES) if name.endswith(".table"))


def run_table(folder, *arguments):
    return subprocess.run(
        [PYTHON, RUN_TABLE, *arguments], cwd=folder, capture_output=True, text=True, env=environment(), timeout=120
    )


def test_a_failing_row_gives_a_failing_table(tmp_path):
    (tmp_path / "rows.table").write_text("description radius velocity duration\n" "good 4 10 1e-9\n" "bad  4 -1 =\n")
    done = run_table(tmp_path, "rows.table")
    assert done.returncode == 1
    assert done.stderr == ("run_table.py: runs/logs/rows.3.bad.log: collide.py: velocity = -1: must be > 0 [m/s]\n")
    assert done.stdout.rstrip().endswith("2 rows, 1 failures")
    assert read_json(tmp_path, "runs", "good", "run.json")["outcome"] == "completed"
    assert sorted(os.listdir(tmp_path / "runs")) == ["good", "logs"]


def test_good_rows_give_a_good_table(tmp_path):
    (tmp_path / "rows.table").write_text(
        "radius! velocity material duration seed!\n"
        "4       10       'ice'    5e-10    1\n"
        "=       =        ice      =        2\n"
    )
    done = run_table(tmp_path, "rows.table", "-l", "2-3")
    assert done.returncode == 0, done.stdout + done.stderr
    assert sorted(os.listdir(tmp_path / "runs")) == ["logs", "radius=4,seed=1", "radius=4,seed=2"]


def test_no_table(tmp_path):
    done = run_table(tmp_path, "nothing.table")
    assert done.returncode == 1 and done.stderr == "run_table.py: nothing.table: no such table\n"


def test_a_description_that_is_too_long_for_a_log_runs_nothing(tmp_path):
    (tmp_path / "rows.table").write_text(f"description radius velocity\ngood 4 10\n{'x' * 250} 4 10\n")
    done = run_table(tmp_path, "rows.table")
    assert done.returncode == 1 and done.stdout == ""
    assert done.stderr == (
        "run_table.py: rows.table: line 3: its log's name would have 261 bytes; must be at most 255, so the "
        "description shorter\n"
    )
    assert os.listdir(tmp_path) == ["rows.table"]


@pytest.mark.parametrize("outcome", ["completed", "interrupted", "failed: energy (1 J): (a) b"])
def test_closing_line_is_read_back(outcome):
    log = "Welcome\n" + closing_line("runs/a (1)", outcome, 12.34) + "\nbye\n"
    assert read_closing_line(log) == ("runs/a (1)", outcome)
    assert read_closing_line("Welcome\n") is None


@pytest.mark.parametrize("name", TABLES)
def test_studies_hold_valid_rows(name, monkeypatch):
    """Every cell of every study is a parameter that its kind of run takes."""
    monkeypatch.chdir(TOP)  # to which tables name scripts
    assert [row.error for row in rows.read(os.path.join(STUDIES, name)) if row.error] == []
