"""The rows of a study, and what has become of each, from its run folder and its log."""

import json
import os
import re
import signal
import time
import zipfile
from dataclasses import dataclass

import numpy as np

from yade_scripts import checkpoint, run_folder, table
from yade_scripts.agreement import difference
from yade_scripts.parameters import ParameterError, parse
from yade_scripts.run_table import failure

DONE, RUNNING, WAITING, FAILED = "done", "running", "waiting", "failed"


@dataclass(frozen=True)
class StudyRow:
    """A row of a table as parameters, or the error of its parameters."""

    name: str
    cells: dict
    values: dict
    error: str = None


@dataclass(frozen=True)
class State:
    """kind: DONE, ...; progress: 0 to 1; seconds: wall time spent; left: seconds by the run's own pace, if known."""

    kind: str
    progress: float = 0.0
    seconds: float = None
    left: float = None
    note: str = ""


def read(path):
    """[StudyRow] of a table; raises TableError, also when two rows would write to one folder or one log."""
    rows, lines = [], {}
    for row in table.read(path):
        name = re.sub(r"[^\w.,=+-]", "_", row.description)
        try:
            values = parse({column: cell for column, cell in row.cells.items() if column[0] != "!"}, row.description)
            error = None
        except ParameterError as problem:
            values, error = None, f"line {row.line} of {path}: {problem}"
        for key in {f"description = {row.description}", f'out = {values["out"] if values else name}'}:
            if key in lines:
                raise table.TableError(f"{path}: lines {lines[key]} and {row.line} both have {key}; allowed: one")
            lines[key] = row.line
        rows.append(StudyRow(name, row.cells, values, error))
    return rows


def state(row, log, since=0.0):
    """What has become of a row. log: the file that its output goes to; failures before `since` don't count."""
    if row.error:
        return State(FAILED, note=row.error)
    folder = row.values["out"]
    run = run_of(folder)
    if os.path.exists(os.path.join(folder, "ended")):
        return _ended(row, run)
    if run_folder.being_written(folder):
        return _running(folder, run)
    outcome = run.get("outcome", "")
    note, progress = _stopped(folder, run)
    problem = _failure(log) if _changed(log) >= since else None
    if problem:
        return State(FAILED, progress, note=problem + (f" ({note})" if note else ""))
    if outcome.startswith("failed") and _changed(os.path.join(folder, "run.json")) >= since:
        return State(FAILED, progress, note=f"{folder}: {outcome}")
    return State(WAITING, progress, run.get("wallTime"), note=note)


def _ended(row, run):
    differs = difference(row.values, run)
    if differs:
        return State(
            FAILED,
            note=f'{row.values["out"]}: holds an ended run with {differs}; allowed: the same, or '
            'take that folder away',
        )
    return State(DONE, 1.0, run.get("wallTime"))


def _running(folder, run):
    """Its pace is that of the wall time and the progress at the last writing of the history."""
    progress = _progress(folder, run)
    begun, written = _changed(os.path.join(folder, "run.json")), _changed(os.path.join(folder, "history.npz"))
    if not written > begun or progress < 0.02:
        return State(RUNNING, progress)
    spent, since = run.get("wallTime", 0.0) + written - begun, time.time() - written
    return State(RUNNING, progress, spent + since, max(0.0, spent * (1 - progress) / progress - since))


def _stopped(folder, run):
    """(what to say of a run that didn't come to its end, how far its checkpoint is)."""
    if not run:
        return "", 0.0
    if not checkpoint.exists(folder):
        return ("starts again", 0.0) if run.get("outcome") in ("running", "interrupted") else ("", 0.0)
    try:
        rows = checkpoint.Checkpoint(folder).rows
    except checkpoint.CheckpointError:
        return "", 0.0
    reached = rows[-1][0] / _end(run) if len(rows) else 0.0
    return f"checkpoint at {100 * reached:.0f} %", reached


def _progress(folder, run):
    try:
        with np.load(os.path.join(folder, "history.npz")) as history:
            return float(history["time"][-1]) / _end(run)
    except (OSError, KeyError, IndexError, ValueError, zipfile.BadZipFile):
        return 0.0


def _end(run):
    return run["derived"]["steps"] * run["derived"]["timeStep"]


def run_of(folder):
    """A run folder's run.json, or {} when there is none."""
    try:
        with open(os.path.join(folder, "run.json")) as file:
            return json.load(file)
    except (OSError, ValueError):
        return {}


def _changed(path):
    """When a file was written [s since 1970]; -1 when it isn't there."""
    try:
        return os.stat(path).st_mtime
    except OSError:
        return -1.0


def _failure(log):
    """What went wrong with the job of a log; None when nothing did, or yade-batch hasn't seen its end."""
    try:
        with open(log, errors="replace") as file:
            summary = file.read().partition("JOB SUMMARY")[2]
    except OSError:
        return None
    if not summary:
        return None
    status = re.search(r"^status  : (\d+)", summary, re.MULTILINE)
    code = int(status.group(1)) >> 8 if status else 0  # of the shell: 128 and more for a signal
    if code > 128 and code - 128 not in (signal.SIGINT, signal.SIGTERM):
        return f"killed by signal {code - 128}"
    problem = failure(log)
    return problem and problem.removeprefix(f"{log}: ")
