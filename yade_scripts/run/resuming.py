"""Which run a folder holds: whether it is the one that is wanted, and with which parameters it goes on. Needs no
YADE."""

import os
import sys

from analysis.printable import shell_line
from analysis.runs.files import RunFolderError, read_json
from analysis.runs.format import ENDED_FILE, RUN_FILE, same
from yade_scripts.parameters import ParameterError
from yade_scripts.run import checkpoint
from yade_scripts.run.parameters import CORES

CONTINUE = "continue"
MAY_CHANGE = ("duration",)  # with continue=FOLDER, beside what is of no consequence
OWN = "out", "overwrite", "resume"


def difference(kind, wanted, run, but=()):
    """The first parameter in which a run is not what is wanted.

    A parameter that the run doesn't know (an older one) had its default, or stands under 'derived'. A run that was
    continued has a longer duration than is wanted, and is what is wanted all the same. A step that is still to be
    chosen is that of any run that chose it for the same tolerance; a number is compared as such, whether or not it
    was chosen.

    Parameters
    ----------
    kind : run.kind.Kind
        The kind wanted.
    wanted : its parameters
    run : dict
        As in run.json, with 'parameters' and 'derived'.
    but : names that are not compared

    Returns
    -------
    str or None
        'name = this, not that'
    """
    there = run.get("kind", "collision")  # format 1 had collisions only
    if there != kind.name:
        return f"kind = {there}, not {kind.name}"
    expected = {**wanted.as_dict(), **kind.expected(wanted, run)}
    columns, held = kind.parameters.columns(), run.get("parameters", {})
    step_is_open = isinstance(wanted.stepFraction, str) and held.get("tolerance") is not None
    left_out = {"stepFraction" if step_is_open else "tolerance", *but}
    for name, column in columns.items():
        if not column.of_consequence or name in left_out:
            continue
        value, found = expected[name], held.get(name, run.get("derived", {}).get(name, column.default))
        longer = name == "duration" and None not in (found, value) and found > value
        if not (same(value, found) or longer):
            return f"{name} = {_text(found)}, not {_text(value)}"
    return None


def _text(value):
    if value is None:
        return "the default"
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def continued(kind, texts):
    """The Kind's parameters of the run in the folder texts["continue"], which resumes.

    texts: {name: text}; what else is given in them must be a duration, or of no consequence. Raises ParameterError."""
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
    except (RunFolderError, KeyError, TypeError) as error:
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
