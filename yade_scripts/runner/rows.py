"""The rows of a study, and what has become of each, from its run folder and its log."""

import os
import re
import signal
from dataclasses import dataclass
from functools import cached_property

from analysis.runs.format import ENDED_FILE, RUN_FILE
from analysis.runs.running import place
from analysis.runs.status import DONE, FAILED, RUNNING, WAITING, State, changed, end_time, run_of  # noqa: F401
from analysis.runs.status import running as running_state
from yade_scripts.parameters import ParameterError
from yade_scripts.run import checkpoint, table
from yade_scripts.run.agreement import difference
from yade_scripts.run.file_name import file_name
from yade_scripts.run.kind import Kind, NoKind, kind_of
from yade_scripts.run.parameters import RunParameters
from yade_scripts.runner.batch_command import DEFAULT_SCRIPT, failure

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))


@dataclass(frozen=True)
class StudyRow:
    """A row of a table: its kind of run and parameters (None where they are wrong), or the error of these."""

    name: str
    cells: dict
    script: str
    kind: Kind = None
    parameters: RunParameters = None
    error: str = None

    @property
    def out(self):
        """The run folder."""
        return self.parameters.out

    @cached_property
    def estimate(self):
        """run.kind.Estimate of its run."""
        return self.kind.estimate(self.parameters)


def read(path):
    """[StudyRow] of a table; raises TableError, also when two rows would write to one folder or one log.

    The column !SCRIPT names the script of a row's kind of run, as for yade-batch; without it rows are collisions.
    """
    rows, lines, kinds = [], {}, {}
    for row in table.read(path):
        name = file_name(row.description)
        script, kind, parameters, error = find_script(row.cells.get("!SCRIPT", DEFAULT_SCRIPT)), None, None, None
        try:
            kind = kinds[script] = kinds.get(script) or kind_of(script)
            parameters = kind.parse(row.parameters, row.description)
        except (ParameterError, NoKind) as problem:
            error = f"line {row.line} of {path}: {problem}"
        for key in {f"description = {row.description}", f"out = {parameters.out if parameters else name}"}:
            if key in lines:
                raise table.TableError(f"{path}: lines {lines[key]} and {row.line} both have {key}; must be one")
            lines[key] = row.line
        rows.append(StudyRow(name, row.cells, script, kind, parameters, error))
    return rows


def write(path, rows):
    """Write rows as a table for yade-batch, and for jobs of Slurm, whose runs resume in the same folders."""
    table.write(
        path,
        [
            {
                "description": row.name,
                **row.cells,
                "out": row.out,
                "resume": 1,
                "!SCRIPT": row.script,
                "!THREADS": threads(row),
            }
            for row in rows
        ],
    )


def threads(row):
    """Processors that a row's run takes."""
    return row.parameters.threads or 1


def find_script(name):
    """The script that a table names: seen from the folder that one stands in, or else from the top of this suite."""
    own = os.path.join(TOP, name)
    return own if not os.path.isfile(name) and os.path.isfile(own) else name


def state(row, log, since=0.0):
    """What has become of a row. log: the file that its output goes to; failures before `since` don't count."""
    if row.error:
        return State(FAILED, note=row.error)
    folder = row.out
    where = place(folder)  # first: a run that ends now has its mark before it gives up the lock and its heartbeat
    run = run_of(folder)
    if os.path.exists(os.path.join(folder, ENDED_FILE)):
        return _ended(row, run)
    if where:
        return running_state(folder, run, where)
    outcome = run.get("outcome", "")
    note, progress = _stopped(folder, run)
    problem = _failure(log) if changed(log) >= since else None
    if problem:
        return State(FAILED, progress, note=problem + (f" ({note})" if note else ""))
    if outcome.startswith("failed") and changed(os.path.join(folder, RUN_FILE)) >= since:
        return State(FAILED, progress, note=f"{folder}: {outcome}")
    return State(WAITING, progress, run.get("wallTime"), note=note)


def _ended(row, run):
    if not run:
        return State(FAILED, note=f"{row.out}: holds an ended run without a readable {RUN_FILE}; must be removed")
    differs = difference(row.kind, row.parameters, run)
    if differs:
        note = f"{row.out}: holds an ended run with {differs}; must be the same, or removed to run the row"
        return State(FAILED, note=note)
    return State(DONE, 1.0, run.get("wallTime"))


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
    reached = rows[-1][0] / end_time(run) if len(rows) else 0.0
    return f"checkpoint at {100 * reached:.0f} %", reached


def _failure(log):
    """Why the job of a log failed; None when it did not, or yade-batch hasn't seen its end."""
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
