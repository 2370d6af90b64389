"""Mistakes of a command line get one line, exit status 2, and nothing is made (values: test_parameters.py)."""

import shlex
import sys

import pytest
from running import PYTHON, SCRIPTS, call

from analysis.__main__ import main as analysis
from yade_scripts import make_packing, study
from yade_scripts.parameters import one_line_errors

TABLES = {
    "commas.table": "packing,grains,velocity\nbcca,20,3\n",
    "column.table": "packing grains velocty\nbcca 20 3\nbcca 20 4\n",
    "cells.table": "packing grains velocity\nbcca 20\n",
    "folders.table": "velocity out\n3 runs/a\n4 ./runs/a/\n",
    "exec.table": "radius !EXEC\n4 touch${IFS}PWNED;yade\n",
    "text.txt": "hello\n",
    "mine.npz": "hello\n",
    "runs.csv": "a,b\n",
}
# what is typed: words of the line on stderr
MISTAKES = {
    "analysis summary empty": "empty: no run folder (run.json) there",
    "analysis study viscos empty": "no study viscos (did you mean viscous?)",
    "analysis study viscous runs.csv": "runs.csv: not a table of runs",
    "analysis outcome --velocity -5 --projectile 2 --target 5 --filling .1": "-5: must be a number > 0",
    "analysis summry empty": "invalid choice: 'summry'",
    "study commas.table": "commas.table: line 1 has commas",
    "study column.table": "column.table: velocty: unknown parameter (did you mean velocity?)",
    "study cells.table": "cells.table: line 2 has 2 cells; must be 3",
    "study folders.table": "folders.table: lines 2 and 3 both have out = runs/a",
    "study exec.table": "exec.table: the column !EXEC is for yade-batch alone",
    "study elastoplastic-dsk": "(did you mean elastoplastic-desk?)",
    "make_packing mine.npz radius=3": "mine.npz: is there, and no packing",
    "make_packing a.npz filling=0.8": "must be at most 0.7519",
    "make_packing a.npz from=nowhere.xyz unit=um": "nowhere.xyz: No such file or directory",
}


def make(arguments):
    with one_line_errors("make_packing.py"):
        return make_packing.main(arguments)


COMMANDS = {"analysis": analysis, "study": study.main, "make_packing": make}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for name, text in TABLES.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "empty").mkdir()
    monkeypatch.chdir(tmp_path)
    yield tmp_path
    assert {path.name for path in tmp_path.iterdir()} == {*TABLES, "empty"}  # nothing was made


@pytest.mark.parametrize("typed", MISTAKES)
def test_mistakes_get_one_line(folder, capsys, monkeypatch, typed):
    command, *arguments = shlex.split(typed)
    monkeypatch.setattr(sys, "argv", [f"{command}.py", *arguments])
    try:
        status = COMMANDS[command](arguments)
    except SystemExit as end:
        status = end.code
    lines = capsys.readouterr().err.splitlines()
    of_argparse = bool(lines) and lines[0].startswith("usage: ")  # which shows the usage first
    assert status == 2 and MISTAKES[typed] in lines[-1] and (of_argparse or len(lines) == 1), lines


def test_python_in_place_of_yade_and_a_python_without_the_libraries(folder):
    ended = call(folder, PYTHON, f"{SCRIPTS}/collide.py")
    assert ended.returncode == 2 and "collide.py: must be run by YADE: yade -n -x " in ended.stderr
    ended = call(folder, PYTHON, "-S", f"{SCRIPTS}/study.py")  # -S: without what Debian installs
    assert ended.returncode == 2 and "has no numpy, " in ended.stderr and ended.stderr.count("\n") == 1
