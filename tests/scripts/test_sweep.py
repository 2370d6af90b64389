"""Runs from Python: a sweep is checked, run, resumed and returned as a table; README's question as a user would ask
it."""

import re
from pathlib import Path

import numpy as np
import pandas
import pytest
from running import PYTHON, TOP, call, collide, refusal

import analysis
from analysis.runs.folder import UNLESS
from analysis.runs.format import PARAMETER_UNITS, PARAMETER_WORDS
from yade_scripts import collide as from_python
from yade_scripts.experiments import collision, compression
from yade_scripts.parameters import InputError, ParameterError
from yade_scripts.runner.sweep import RunsFailed

QUESTION = re.search(r"```python\n(from yade_scripts.*?)```", (Path(TOP) / "README.md").read_text(), re.S).group(1)
SMALL = {"[1, 3, 10, 30]": "[1, 30]", "range(6)": "range(2)", "grains=500": "grains=16"}


def python(folder, text):
    return call(folder, PYTHON, "-c", text, PYTHONPATH=TOP)


def test_the_question_of_the_readme(tmp_path):
    """As printed, with small aggregates; asked again nothing is run, asked for more only what is missing."""
    question = QUESTION
    assert len(question.splitlines()) <= 15
    for large, small in SMALL.items():
        assert large in question
        question = question.replace(large, small)
    first = python(tmp_path, question)
    assert first.returncode == 0 and first.stderr == "", first.stderr
    assert "4 rows, 4 to run; estimated time" in first.stdout and "rows x 7 columns" in first.stdout
    assert (tmp_path / "sticking.png").read_bytes().startswith(b"\x89PNG")
    ended = {file: file.stat().st_mtime_ns for file in tmp_path.glob("runs/*/ended")}
    more = python(tmp_path, question.replace("[1, 30]", "[1, 10, 30]"))
    assert "6 rows, 4 done, 2 to run" in more.stdout, more.stderr
    assert len(ended) == 4 and all(file.stat().st_mtime_ns == time for file, time in ended.items())


def test_a_mistake_gets_the_line_of_the_script_and_nothing_is_run(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(ParameterError) as wrong:
        from_python(velocity=[3, -1], grains=[16, 32])
    assert refusal(collide(tmp_path, "velocity=-1")) == f"collide.py: {wrong.value}"
    nullable = pandas.array([3, None], dtype="Float64")
    for missing in ([3, None], np.ma.masked_array([3.0, 4.0], [0, 1]), np.ma.masked, pandas.NA, nullable):
        with pytest.raises(ParameterError, match="^velocity"):
            from_python(velocity=missing)
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_fails_is_named_and_undecided_ones_are_counted(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    with pytest.raises(RunsFailed, match=r"^collide-.*v3000.*: the run broke down at t = "):
        from_python("own", jobs=1, radius=5, velocity=[10, 3000], unusual=1, duration=10e-9, stepFraction=0.4)
    assert len(list(tmp_path.glob("own/*/ended"))) == 1
    assert "\n2 runs; 1 undecided" in capsys.readouterr().out
    monkeypatch.setenv("PATH", "")
    with pytest.raises(InputError, match="^yade: no such command on PATH; must be"):
        from_python(radius=5, velocity=3)


def test_a_table_of_outcomes_counts_the_pairs_that_never_met(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    pairs = dict(packing="bcca", grains=24, projectileGrains=6, impact="random", seed=range(8), states=2)
    runs = from_python(jobs=1, velocity=[5, 20], duration=2e-6, endWhenApart=1, **pairs)
    missed = (runs.outcome == "never met").sum()
    table = analysis.outcome_table(runs)
    of = lambda name: table.column(name)[:, 0, 0]  # of grains and mass ratio both nodes are alike
    there = of("inside") == 1
    assert missed >= 2 and (runs.outcome != "undecided").all()
    assert (of("runs") / of("p_touching"))[there].sum() == pytest.approx(16)


def test_units_and_words_of_parameters_are_the_scripts_own():
    columns = {**collision.KIND.parameters.columns(), **compression.KIND.parameters.columns()}
    assert {name: column.unit for name, column in columns.items() if column.unit} == PARAMETER_UNITS
    assert {name for name, column in columns.items() if column.kind is str} - {"out"} == set(PARAMETER_WORDS)
    assert {name: columns[name].default for name in UNLESS} == UNLESS
