"""Every command that the documents say is one: its parser takes it, and the first tutorial runs as written."""

import json
import re
import shlex
from pathlib import Path

import pytest
from running import PYTHON, TOP, call

from analysis.__main__ import _parser
from yade_scripts import study
from yade_scripts.experiments import collision, compression
from yade_scripts.make_packing import MadeParameters
from yade_scripts.packings.cut import CutParameters
from yade_scripts.packings.imported import ImportParameters
from yade_scripts.parameters import ParameterError
from yade_scripts.run.arguments import from_arguments, gather

TOP = Path(TOP)
PAGES = [TOP / name for name in ("README.md", "analysis/STUDIES.md", "yade_scripts/RUNS.md", "contact_law/SCRIPTS.md")]
PAGES += sorted((TOP / "docs").glob("*.md")) + sorted((TOP / "docs").glob("*.ipynb"))
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
        texts, row = gather(arguments)
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
