"""What the documents say: every command is one that its parser takes, README's script and the first tutorial run as written, files and numbers
of tables are there."""

import json
import re
import shlex
import subprocess
from pathlib import Path

import pytest
from running import PYTHON, TOP, call
from scenes import *

from analysis.__main__ import _parser
from yade_scripts import study
from yade_scripts.experiments import collision, compression
from yade_scripts.make_packing import MadeParameters
from yade_scripts.packings.cut import CutParameters
from yade_scripts.packings.imported import ImportParameters
from yade_scripts.parameters import ParameterError
from yade_scripts.run.arguments import from_arguments, gather
from yade_scripts.runner import cost, rows

TOP = Path(TOP)
BYTES_A_GRAIN = 130  # of a state
DOCUMENTS = [TOP / name for name in "README.md analysis/STUDIES.md yade_scripts/RUNS.md contact_law/SCRIPTS.md".split()]
PAGES = DOCUMENTS + sorted((TOP / "docs").glob("*.md")) + sorted((TOP / "docs").glob("*.ipynb"))
PROGRAM = (
    r"(?:yade -n -x|/usr/bin/python3|python3) (yade_scripts/\w+\.py|-m analysis|-m yade_scripts\.make_packing)(?: |$)"
)


def text_of(page):
    if page.suffix == ".md":
        return page.read_text()
    cells = json.loads(page.read_text())["cells"]
    return "\n".join("".join(cell["source"]) for cell in cells)


def commands(text):
    """(program, [arguments]) of each in a page: lines of their own, and in backquotes."""
    lines = re.findall(rf"(?:^    |^!|`){PROGRAM}([^`\n]*)", text, re.M)
    return [(program, shlex.split(rest, comments=True)) for program, rest in lines]


def take(program, arguments):
    """Has the program's own parser take the arguments; raises what it raises. Capital letters stand for names of the reader's own."""
    if "--help" in arguments or len(arguments) < 2:  # is named, not called
        return
    if program == "-m analysis":
        _parser().parse_args(arguments)
    elif program.endswith("study.py"):
        study.parse_arguments(arguments)
    elif "make_packing" in program:
        texts = from_arguments([argument for argument in arguments if "=" in argument])
        source = texts.pop("from", "")
        kind = CutParameters if "states" in source else ImportParameters if source else MadeParameters
        kind.parse(texts)
    else:
        kind = compression.KIND if "compress" in program else collision.KIND
        texts, row = gather(arguments, kind)
        texts.pop("continue", None)
        kind.parse(texts, row)


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.name)
def test_commands_are_taken(page, monkeypatch):
    monkeypatch.chdir(TOP)
    for program, arguments in commands(text_of(page)):
        try:
            take(program, arguments)
        except (SystemExit, ParameterError) as error:
            pytest.fail(f"{program} {shlex.join(arguments)}: {error}")


def test_there_are_commands_to_take():
    found = [command for page in PAGES for command in commands(text_of(page))]
    assert len(found) > 30 and {program for program, _ in found} >= {"-m analysis", "yade_scripts/collide.py"}


def test_values_in_the_text_are_parameters():
    """`name=value` in RUNS.md: those of a run, of make_packing.py, or of study.py's table."""
    for words in re.findall(r"`(\w+=[^`(\s]+(?: \w+=[^`(\s]+)*)`", (TOP / "yade_scripts/RUNS.md").read_text()):
        names = {word.partition("=")[0] for word in words.split()}
        kinds = (collision.KIND.parameters, compression.KIND.parameters, ImportParameters)
        assert names == {"continue"} or any(names <= set(kind.columns()) for kind in kinds), words


@pytest.mark.parametrize(
    "notebook, ask, answer",
    [
        ("first_collision", "runs.outcome[0]", "sticking"),
        ("atlas", "runs.outcome[bands.cat.codes == 0].unique()", "['sticking']"),
    ],
)
def test_notebooks(tmp_path, notebook, ask, answer):
    """In plain Python."""
    cells = json.loads((TOP / f"docs/{notebook}.ipynb").read_text())["cells"]
    code = "\n".join("".join(cell["source"]) for cell in cells if cell["cell_type"] == "code")
    done = call(tmp_path, PYTHON, "-c", f"{code}\nprint({ask})", PYTHONPATH=str(TOP), MPLBACKEND="agg")
    assert done.returncode == 0 and done.stdout.splitlines()[-1] == answer, done.stderr


@pytest.mark.in_yade
def test_the_script_and_the_fused_line():
    """The README's engines and the fused engine in their place, each with two grains that meet."""
    readme = DOCUMENTS[0].read_text()
    block = re.search(r"```python\n(import contact_law.*?)```", readme, re.S).group(1)
    fused = re.search(r"`(O\.engines = \[JKRWadaEngine.*?\])`", readme).group(1)
    connection = []
    for engines, together in ((block, 1), (f"{block}\nO.dt *= 50\n{fused}", 50)):
        O.reset()
        names = dict(globals())
        exec(engines, names)
        for x, v in ((0, 1), (2.01e-7, -1)):
            grain((x, 0, 0), 1e-7, names["ice"], (v, 0, 0))
        O.run(1000 // together, True)
        connection.append(O.energy["connection"])
    assert connection[0] > 0 and abs(connection[1] / connection[0] - 1) < 0.02


def test_the_commands_are_there():
    known = subprocess.run(["make", "-pRrq", ":"], cwd=TOP, capture_output=True, text=True).stdout
    for document in DOCUMENTS:
        text = document.read_text().replace("study-NAME", "study-viscous").replace("NAME", "viscous")
        for target in re.findall(r"(?:^    |`)make ([a-z]+(?:-[a-z0-9]+)*)", text, re.M):
            assert re.search(rf"^{target}:", known, re.M), f"{document.name}: {target}"
        for path in re.findall(r"(?<![\w/])(?:yade_scripts|contact_law|analysis|tests)/[\w./-]*\w/?", text):
            assert (TOP / path.rstrip("/")).exists(), f"{document.name}: {path}"
        for link in re.findall(r"\]\((?!https?:|#)([^)]+)\)", text):
            assert (document.parent / link.partition("#")[0]).exists(), f"{document.name}: {link}"


def test_the_readmes_speeds_are_the_papers():
    """Of README's rows; those of the paper are filled in from what was measured."""
    cells = r"^\| .*?\| ([\d.]+ to [\d.]+) \|"
    readme, paper = (
        re.findall(cells, (TOP / name).read_text(), re.M) for name in ("README.md", "analysis/gallery/paper.md")
    )
    assert len(readme) == 4 and readme == paper[:4]


def test_the_table_of_ones_own_study_runs_where_its_analysis_looks(tmp_path):
    text = (TOP / "analysis/STUDIES.md").read_text()
    table = tmp_path / "sticking.table"
    table.write_text(re.search(r"```\n(description.*?)```", text, re.DOTALL)[1])
    folder = re.search(r"study sticking\.py (\S+)", text)[1]
    assert [row.out for row in rows.read(str(table))] == [
        f"{folder}/{name}" for name in "v1-s1 v1-s2 v10-s1 v10-s2".split()
    ]


def test_the_table_of_studies_is_that_of_their_tables(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # where no aggregate has been grown, whose file would tell more than its row
    study, seen = None, set()
    for line in (TOP / "analysis/STUDIES.md").read_text().splitlines():
        cells = [cell.strip() for cell in line.split("|")[1:-1]]
        if len(cells) != 8 or cells[2] not in ("first", "desk", "full", "own", "beyond", "decide", "prediction"):
            continue
        study = cells[0].strip("`") or study
        found = rows.read(str(TOP / f"yade_scripts/studies/{study}-{cells[2]}.table"))
        assert int(cells[3]) == len(found), line
        assert float(cells[4]) == pytest.approx(sum(map(cost.contact_updates, found)), rel=0.05), line
        grains = sum(row.estimate.grains * row.parameters.states for row in found)
        assert float(cells[7].split()[0]) == pytest.approx(grains * BYTES_A_GRAIN * 1e-9, rel=0.2), line
        seen.add((study, cells[2]))
    assert len(seen) == 14
