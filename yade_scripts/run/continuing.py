"""continue=FOLDER: a run that was stopped, or ended before its outcome was decided, goes on with its own parameters. Needs no YADE."""

import os
import sys

from analysis.printable import shell_line
from analysis.runs.files import RunFolderError, read_json
from analysis.runs.format import ENDED_FILE, RUN_FILE
from yade_scripts.parameters import ParameterError
from yade_scripts.run import checkpoint
from yade_scripts.run.parameters import CORES

CONTINUE = "continue"
MAY_CHANGE = ("duration",)  # beside what is of no consequence
OWN = "out", "overwrite", "resume"


def parameters(kind, texts):
    """The Kind's parameters of the run in the folder texts["continue"], with resume=1 and with what else is given in texts, {name: text}:
    a duration, and what is of no consequence. Raises ParameterError."""
    folder, given = texts[CONTINUE], {name: text for name, text in texts.items() if name != CONTINUE}
    columns = kind.parameters.columns()
    for name in given:
        if name in columns and (name in OWN or columns[name].of_consequence and name not in MAY_CHANGE):
            raise ParameterError(f"{name}: given with {CONTINUE} = {folder}, whose own it is; must be left out")
    found = kind.parameters.parse(given)  # only for its checks
    held = _held(kind, folder)
    if held["threads"]:
        held["threads"] = min(held["threads"], CORES)  # of another machine
    held |= {name: getattr(found, name) for name in given}
    return kind.parameters(**{**held, "out": folder, "resume": 1, "overwrite": 0})


def _held(kind, folder):
    """The parameters in a folder's run.json, of this kind."""
    try:
        run = read_json(os.path.join(folder, RUN_FILE))
        held = run["parameters"]
    except (RunFolderError, OSError, KeyError, TypeError) as error:
        raise ParameterError(f"{CONTINUE} = {folder}: {error}; must be the folder of a run") from None
    if run.get("kind") != kind.name or set(held) != set(kind.parameters.columns()):
        raise ParameterError(
            f"{CONTINUE} = {folder}: a run of another kind or version; must be a {kind.name} of this version"
        )
    if os.path.exists(os.path.join(folder, ENDED_FILE)) and not checkpoint.exists(folder):
        raise ParameterError(
            f"{CONTINUE} = {folder}: the run has ended, decided; must be one that was stopped, or is undecided"
        )
    return held


def command(folder, **changed):
    """The command that continues the run in a folder, as this process was called."""
    words = ["yade", "-n", "-x", sys.argv[0], f"{CONTINUE}={folder}"]
    return shell_line(words + [f"{name}={value:g}" for name, value in changed.items()])
