"""Runs from Python: one call makes the rows of a sweep, runs what is missing, and returns their table.

Needs yade on PATH, not to be called within YADE."""

import hashlib
import os
from itertools import product

import numpy as np

from analysis.report.rows import table as table_of_runs
from analysis.runs.status import DONE
from yade_scripts.experiments import collision, compression
from yade_scripts.parameters import SWITCH, ParameterError
from yade_scripts.run import on_device, table
from yade_scripts.run.parameters import CORES
from yade_scripts.runner.study import Study

OURS = ("out", "overwrite", "resume")  # parameters that a sweep sets
NAMED = 3  # failures that an exception names


class RunsFailed(RuntimeError):
    """Runs of a sweep that failed; the message names them, and why. The others have run, and stay."""


def collide(folder="runs", jobs=None, longer=None, device=None, **parameters):
    """Run collisions: one for every combination of the values of the parameters.

        runs = collide(velocity=[1, 3, 10, 30], seed=range(6), packing="bcca", grains=500, material="silicate")

    Parameters
    ----------
    folder : str or Path
        Where the run folders go, named after their parameters; those that are there are resumed, or taken as they are
        when they have ended. The rows stand in a table there, which study.py runs and shows (--status), too.
    jobs : int, optional
        Threads at once (one for each core).
    longer : float, optional
        Duration [s] to which runs that ended undecided go on.
    device : {"gpu", "processor"}, optional
        Where runs go that can run there (study.py --device).
    **parameters
        As `collide.py --help` lists them; a list, range or array stands for several values, None, alone, for the
        default.

    Returns
    -------
    DataFrame
        analysis.table() of the runs.

    Raises
    ------
    ParameterError
        For a wrong name or value, before anything runs: a ValueError with the line that collide.py has.
    RunsFailed
        When a run failed; the others have run. Ctrl-C stops the runs, each with a checkpoint.
    """
    return _sweep(collision.KIND, "collide.py", parameters, folder, jobs, longer, device)


def compress(folder="runs", jobs=None, **parameters):
    """Run static compressions; everything as collide(), with the parameters of compress.py."""
    return _sweep(compression.KIND, "compress.py", parameters, folder, jobs)


def _sweep(kind, script, parameters, folder, jobs, longer=None, device=None):
    jobs, folder = CORES if jobs is None else jobs, os.fspath(folder)
    if jobs < 1:
        raise ParameterError(f"jobs = {jobs}: must be a whole number, 1 or more")
    rows = _rows(kind, script, parameters, folder)
    name = hashlib.sha256(repr(rows).encode()).hexdigest()[:8]
    file = os.path.join(folder, f"{kind.name}-{name}.table")
    os.makedirs(folder, exist_ok=True)
    table.write(file, rows, f"{len(rows)} runs, from Python: {kind.name}")
    study, library = Study(file, jobs, longer), on_device.library_of(device) if device else None
    study.folder.lock()
    try:
        states = study.run(library=library)
    finally:
        os.close(study.folder.held)
    if undecided := study.undecided(states):
        print(f"{len(rows)} runs{undecided}")
    wrong = [f"{row.name}: {state.note}" for row, state in zip(study.rows, states) if state.kind != DONE]
    if wrong:
        more = f", and {len(wrong) - NAMED} more" if len(wrong) > NAMED else ""
        raise RunsFailed("; ".join(wrong[:NAMED]) + more)
    return table_of_runs([row["out"] for row in rows])


def _rows(kind, script, parameters, folder):
    """[{column: text}] of a table, checked."""
    for name in OURS:
        if name in parameters:
            raise ParameterError(f"{name}: is the sweep's own; must be left out (folder is where the runs go)")
    rows, folder, columns = {}, _text("folder", folder), kind.parameters.columns()
    for values in product(*map(_listed, parameters, parameters.values())):
        given = {name: value for name, value in zip(parameters, values) if value is not None}
        cells = {name: _text(name, value, columns.get(name)) for name, value in given.items()}
        out = os.path.basename(kind.parse(cells).out)
        if out in rows:
            words = " ".join(map("=".join, cells.items()))
            raise ParameterError(f"{words}: given twice (run folder {out}); must be given once")
        place = {"out": os.path.join(folder, out), "!SCRIPT": f"yade_scripts/{script}"}
        rows[out] = {"description": out, **cells, **place}
    return list(rows.values())


def _listed(name, value):
    """The values of a parameter as a list of Python's own."""
    missing = np.ma.is_masked(value)
    value = value.tolist() if hasattr(value, "tolist") else value
    several = isinstance(value, (list, tuple, range, set))
    values = list(value) if several else [value]
    if not values:
        raise ParameterError(f"{name}: has no value; must be one or several")
    if missing or (several and any(each is None or np.ma.is_masked(each) for each in values)):
        raise ParameterError(f"{name}: has a missing value; must be given, or None alone for the default")
    return values


def _text(name, value, column=None):
    """A value as the cell of a table; True and False stand for 1 and 0 where the parameter's column is a switch."""
    text = str(int(value)) if isinstance(value, bool) and column and column.check is SWITCH else str(value)
    if text in ("", "=", "*") or not table.quoted(text):
        found = " ".join(text.split())
        raise ParameterError(f"{name} = {found}: holds what the cell of a table can't; must be a number or a word")
    return text
