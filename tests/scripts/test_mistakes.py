"""What a command gets wrong at its start, as one types it, and the one line that says so (values of parameters: test_parameters.py)."""

import shlex
import sys

import pytest
from running import PYTHON, SCRIPTS, call, messages

from analysis.__main__ import main as analysis
from yade_scripts import make_packing, study
from yade_scripts.parameters.errors import one_line_errors

TABLES = {
    "commas.table": "packing,grains,velocity\nbcca,20,3\n",
    "column.table": "packing grains velocty\nbcca 20 3\nbcca 20 4\n",
    "cells.table": "packing grains velocity\nbcca 20\n",
    "above.table": "packing grains velocity\n= 20 3\n",
    "twice.table": "velocity! grains velocity\n3 20 3\n",
    "same.table": "packing grains velocity out\nbcca 20 3 runs/a\nbcca 20 4 runs/a\n",
    "names.table": "description velocity\na/1 3\na_1 4\n",
    "folders.table": "velocity out\n3 runs/a\n4 ./runs/a/\n",
    "anew.table": "velocity overwrite\n3 1\n",
    "exec.table": "radius !EXEC\n4 touch${IFS}PWNED;yade\n",
    "text.txt": "hello\n",
    "mine.npz": "hello\n",
    "runs.csv": "a,b\n",
    "no.json": "{}",
    "run.pvd": "<?xml version='1.0'?><VTKFile type='Collection'><Collection/></VTKFile>\n",
    "mine.py": "x = 1\n",
    "typo.py": "x = 1\ny\n",
    "syntax.py": "def (:\n",
}
# what is typed: words of the line, which is all that is said
MISTAKES = {
    "analysis summary empty": "empty: no run folder (run.json) there",
    "analysis summary nowhere": "nowhere: no such folder",
    "analysis summary text.txt": "text.txt: is not a folder",
    "analysis figures empty": "empty/run.json: missing, so this is not a run folder",
    "analysis figures text.txt": "text.txt: is not a folder",
    "analysis view empty": "empty/run.json: missing, so this is not a run folder",
    "analysis film empty": "empty/run.json: missing, so this is not a run folder",
    "analysis film empty --rate 0": "argument --rate: 0: must be from 0.1 to 120",
    **dict.fromkeys(
        [f"analysis film empty --rate {rate}" for rate in ("nan", "fast", "1000")], "must be from 0.1 to 120"
    ),
    "analysis film empty --width 9.5": "argument --width: 9.5: must be a whole number from 160 to 3840",
    "analysis film empty --colour blue": "argument --colour: invalid choice: 'blue' (choose from ",
    "analysis view empty --out a.txt": "a.txt: must end in .html",
    "analysis study mine.py empty": "mine.py: defines no STUDY; must be as analysis/STUDIES.md says",
    "analysis study typo.py empty": "typo.py: NameError at line 2: name 'y' is not defined; must be as analysis/STUDIES.md says",
    "analysis study syntax.py empty": "syntax.py: SyntaxError at line 1: ",
    "analysis film empty --along xy": "argument --along: invalid choice: 'xy' (choose from ",
    "analysis export empty --format ply": "argument --format: invalid choice: 'ply' (choose from ",
    "analysis plot sticking empty": "empty: no run folder (run.json) there",
    "analysis status nowhere": "nowhere: no such folder",
    "analysis study viscos empty": "no study viscos (did you mean viscous?); must be one of ",
    "analysis study viscous empty": "empty: no run folder (run.json) there",
    "analysis study own.py empty": "own.py",
    "analysis study viscous": "study viscous: of which runs? Give run folders, folders of them, or a runs.csv",
    "analysis study viscous nowhere": "nowhere",
    "analysis plot sticking empty --out a.xyz": "a.xyz: must end in .png",
    "analysis outcome --velocity 5 --projectile 2 --target 5 --filling 15": "15: must be a number > 0 and at most 1",
    "analysis study viscous runs.csv": "runs.csv: not as `analysis study` has written it",
    "analysis verify empty": "empty: no run folder (run.json) there",
    "analysis status text.txt": "text.txt: is not a folder",
    "analysis study text.txt empty": "no study text.txt; must be one of ",
    "analysis outcome --velocity -5 --projectile 2 --target 5 --filling .1": "-5: must be a number > 0",
    "analysis summry empty": "invalid choice: 'summry' (choose from ",
    "analysis summary": "the following arguments are required: RUNS",
    "analysis": "the following arguments are required: command",
    "study commas.table": "commas.table: line 1 has commas; names and values must be parted by blanks",
    "study column.table": "column.table: velocty: unknown parameter (did you mean velocity?)",
    "study cells.table": "cells.table: line 2 has 2 cells; must be 3, one for each name",
    "study above.table": "above.table: line 2: = has no row above; must be a value",
    "study twice.table": "twice.table: has the column velocity 2 times; must be once",
    "study same.table": "same.table: lines 2 and 3 both have out = runs/a; must be one",
    "study names.table": "names.table: lines 2 and 3 both have description = a_1; must be one",
    "study folders.table": "folders.table: lines 2 and 3 both have out = runs/a; must be one",
    "study exec.table": "exec.table: the column !EXEC is for yade-batch alone; must be left out, or one of",
    "study anew.table": "anew.table: line 2: overwrite = 1: a study keeps what has ended; must be 0",
    "study same": "same: No such file or directory; must be a table of parameters (did you mean same.table?)",
    "study elastoplastic-dsk": "must be a table of parameters (did you mean elastoplastic-desk.table?)",
    "study latin.table": "latin.table: has bytes that are not UTF-8; must be a table",
    "study text.txt": "text.txt: no rows; must be a line of names, then rows of values",
    "study empty": "empty: is no regular file; must be one",
    "study": "the following arguments are required: TABLE",
    "study cells.table -j 0": "-j = 0: must be 1 or more",
    "make_packing": "0 files given; must be one or two to write, a.npz b.npz (names without =), or --help",
    "make_packing a.npz b.npz c.npz radius=3": "3 files given; must be one or two",
    "make_packing a.npz --seed 3": "--seed: not understood; must be name=value, or --help",
    "make_packing a.npz from=run.pvd": "with their radii, such as state_NNNNNN/grains.vtp of an export",
    "make_packing a.npz from= unit=um": "from = : must be a file",
    "make_packing a.npz packing=bcca grains=10 filling=0.4": "filling = 0.4: given with packing = bcca",
    "make_packing a.npz from=empty unit=um": "empty: is no regular file; must be one",
    "make_packing mine.npz radius=3": "mine.npz: is there, and no packing; must be a new file, or a packing to replace",
    "make_packing a.txt": "a.txt: a packing is saved as .npz; must end in .npz",
    "make_packing a.npz packing=file file=b.npz": "packing = file: must be cpe or bcca or bpca",
    "make_packing a.npz packing=bcca grains=20 sizes=two sizeRatio=2 sizeFraction=0.02": "sizeFraction = 0.02: of 20 grains none, or all; must be",
    "make_packing a.npz filling=0.8": "must be at most 0.7519",
    "make_packing a.npz velocity=3": "velocity: unknown parameter; must be one of from, packing, filling",
    "make_packing a.npz density=900": "density: a packing doesn't depend on it; must be left out",
    "make_packing a.npz surfaceEnergy=1e4 unusual=1": "grainRadius = 1e-07: contacts at rest have a radius of ",
    "make_packing a.npz b.npz from=text.txt": "b.npz: from = text.txt is one aggregate; must be one file",
    "make_packing a.npz ./a.npz radius=3": "./a.npz: given twice; must be two files, one for each aggregate",
    "make_packing a.npz grain=10": "grain: unknown parameter (did you mean grains?)",
    "make_packing a.npz grains": "grains: a packing is saved as .npz",
    "make_packing a.npz from=nowhere.xyz unit=um": "nowhere.xyz: No such file or directory",
    "make_packing a.npz from=text.txt unit=um": "text.txt: of an unknown format; must be npz, csv, xyz, ",
    "make_packing nowhere/a.npz packing=bcca grains=10": "nowhere/a.npz: No such file or directory",
}  # fmt: skip


def make(arguments):
    with one_line_errors("make_packing.py"):
        return make_packing.main(arguments)


COMMANDS = {"analysis": analysis, "study": study.main, "make_packing": make}
# the same of what YADE runs
OF_YADE = {
    "velocity 3": "argument 'velocity': not understood; must be name=value, or --help",
    "--velocity=3": "--velocity: unknown parameter (did you mean velocity?)",
    "table=column.table": "table = column.table: must be FILE:LINE, one row of a table; study.py runs all",
    "table=nowhere.table:2": "table nowhere.table: No such file or directory; must be a table",
    "packing=file file=text.txt": "text.txt: not a packing; must be an .npz that make_packing.py wrote",
    "continue=empty": "continue = empty: empty/run.json: missing",
}


@pytest.fixture
def folder(tmp_path, monkeypatch):
    for name, text in TABLES.items():
        (tmp_path / name).write_text(text)
    (tmp_path / "latin.table").write_bytes(b"grains\n16 # gr\xf6\xdfe\n")
    (tmp_path / "empty").mkdir()
    monkeypatch.chdir(tmp_path)
    yield tmp_path
    assert {path.name for path in tmp_path.iterdir()} == {*TABLES, "latin.table", "empty"}  # nothing was made


@pytest.mark.parametrize("typed", MISTAKES)
def test_mistakes_get_one_line(folder, capsys, monkeypatch, typed):
    command, *arguments = shlex.split(typed)
    monkeypatch.setattr(sys, "argv", [f"{command}.py", *arguments])
    try:
        status = COMMANDS[command](arguments)
    except SystemExit as end:
        status = end.code
    said = capsys.readouterr().err.splitlines()
    of_argparse = bool(said) and said[0].startswith("usage: ")  # which shows the usage first
    assert status == 2 and MISTAKES[typed] in said[-1] and (of_argparse or len(said) == 1), said


@pytest.mark.parametrize("typed", OF_YADE)
def test_mistakes_of_what_yade_runs(folder, typed):
    ended = call(folder, "yade", "-n", "-x", f"{SCRIPTS}/collide.py", *shlex.split(typed))
    (said,) = messages(ended)
    assert ended.returncode == 2 and said.startswith("collide.py: ") and OF_YADE[typed] in said


@pytest.mark.parametrize("script", ["collide.py", "compress.py"])
def test_python_in_place_of_yade(folder, script):
    ended = call(folder, PYTHON, f"{SCRIPTS}/{script}")
    assert ended.returncode == 2 and f"{script}: must be run by YADE: yade -n -x " in ended.stderr
    assert ended.stderr.count("\n") == 1


@pytest.mark.parametrize("script", ["collide.py", "make_packing.py", "study.py", "analysis"])
def test_a_python_without_the_libraries(folder, script):
    command = ["-m", script] if script == "analysis" else [f"{SCRIPTS}/{script}"]
    ended = call(folder, PYTHON, "-S", *command, PYTHONPATH=f"{SCRIPTS}/..")  # -S: nor what Debian installs
    assert ended.returncode == 2 and "has no numpy, " in ended.stderr and ended.stderr.count("\n") == 1
