"""The rows of a study, and what has become of each, from its run folder and its log."""

import os
import types
from contextlib import suppress
from dataclasses import dataclass, replace
from functools import cached_property

from analysis.runs.format import ENDED_FILE, RUN_FILE
from analysis.runs.running import place
from analysis.runs.status import DONE, FAILED, RUNNING, WAITING, State, damage, end_time, run_of  # noqa: F401
from analysis.runs.status import running as running_state
from yade_scripts.parameters import ParameterError, UnknownParameter
from yade_scripts.run import checkpoint, table
from yade_scripts.run.agreement import difference
from yade_scripts.run.file_name import file_name
from yade_scripts.run.kind import Kind, NoKind, kind_of
from yade_scripts.run.parameters import RunParameters
from yade_scripts.runner.cost import setup_seconds, stepping_seconds
from yade_scripts.runner.log import failure

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPTS = os.path.join(TOP, "yade_scripts")
DEFAULT_SCRIPT = os.path.join(SCRIPTS, "collide.py")
THREADS = ("!THREADS", "!OMP_NUM_THREADS")
OF_YADE_BATCH = ("!SCRIPT", *THREADS)  # its columns that have a meaning here, too


@dataclass(frozen=True)
class StudyRow:
    """A row of a table: its kind of run and parameters (None where they are wrong), or the error of these. Where a script was not
    to be run, kind is None and the parameters are those of every kind."""

    name: str
    cells: dict
    script: str
    kind: Kind = None
    parameters: RunParameters = None
    error: str = None
    threads_of_yade: int = None

    @property
    def out(self):
        """The run folder."""
        return self.parameters.out

    @property
    def threads(self):
        """Processors that the run takes."""
        return self.threads_of_yade or self.parameters.threads or 1

    @property
    def arguments(self):
        """{name: text} that its script is given: the row's, in the run folder, which resumes if it was stopped."""
        own = {name: text for name, text in self.cells.items() if name[0] != "!"}
        return {**own, "out": self.out, "resume": 1}

    @cached_property
    def estimate(self):
        """run.kind.Estimate of its run."""
        return self.kind.estimate(self.parameters)

    @cached_property
    def typical(self):
        """(seconds of setting it up, seconds of its steps) of a usual processor."""
        return setup_seconds(self), stepping_seconds(self)


def read(path, run_scripts=True):
    """[StudyRow] of a table; raises TableError, also when two rows would write to one folder or one log.

    The column !SCRIPT names the script of a row's kind of run, as for yade-batch; without it rows are collisions. run_scripts: whether
    scripts of others than this suite may be imported, which tell their kinds of run.
    """
    rows, lines, kinds = [], {}, {}
    for row in table.read(path):
        _require_columns(path, row)
        name = file_name(row.description)
        script, kind, parameters, threads, error = find_script(row.cells.get("!SCRIPT", DEFAULT_SCRIPT)), *[None] * 4
        try:
            if run_scripts or os.path.dirname(os.path.realpath(script)) == os.path.realpath(SCRIPTS):
                kind = kinds[script] = kinds.get(script) or kind_of(script)
                parameters = kind.parse(row.parameters, row.description)
            else:
                known = {name: cell for name, cell in row.cells.items() if name in ("out", "threads")}
                parameters = RunParameters.parse(known, row.description)
            threads = _threads_of_yade(row.cells, parameters)
        except UnknownParameter as problem:  # a column's, of all rows
            of = os.path.basename(script) + (": a column !SCRIPT names another" if "!SCRIPT" not in row.cells else "")
            raise table.TableError(f"{path}: {problem}, of {of}") from None
        except (ParameterError, NoKind) as problem:
            parameters, error = None, f"line {row.line} of {path}: {problem}"
        for key in (f"description = {name}", f"out = {os.path.normpath(parameters.out) if parameters else name}"):
            if key in lines:
                raise table.TableError(f"{path}: lines {lines[key]} and {row.line} both have {key}; must be one")
            lines[key] = row.line
        rows.append(StudyRow(name, row.cells, script, kind, parameters, error, threads))
    return rows


def write(path, rows):
    """Write rows as a table whose runs resume in the same folders; [FILE:LINE] of each, by which its script finds it."""
    own = lambda row: {"description": row.name, "out": row.out}
    table.write(path, [{**own(row), **row.cells, "resume": 1, "!THREADS": row.threads} for row in rows])
    return [f"{path}:{row.line}" for row in table.read(path)]


def find_script(name):
    """The script that a table names: seen from the folder that one stands in, or else from the top of this suite."""
    own = os.path.join(TOP, name)
    return own if not os.path.isfile(name) and os.path.isfile(own) else name


def traces(row, log):
    """{file: when and where it was written} of what tells of a row's failure, for state(); of no clock but the files' own."""
    found = {}
    for file in () if row.error else (log, os.path.join(row.out, RUN_FILE)):
        with suppress(OSError):
            about = os.stat(file)
            found[file] = about.st_mtime_ns, about.st_ino
    return found


def state(row, log, before=types.MappingProxyType({})):
    """What has become of a row. log: the file that its output goes to; failures of which traces() were there `before` don't count."""
    if row.error:
        return State(FAILED, note=row.error)
    folder = row.out
    where = place(folder)  # first: a run that ends now has its mark before it gives up the lock and its heartbeat
    run = run_of(folder)
    if os.path.exists(os.path.join(folder, ENDED_FILE)) and not _goes_on(row, run):
        return _ended(row, run)
    if where:
        return running_state(folder, run, where)
    outcome = run.get("outcome", "")
    note, progress = _stopped(folder, run)
    now = traces(row, log)
    new = {file for file in now if now[file] != before.get(file)}
    problem = failure(log, folder) if log in new else None
    if problem:
        return State(FAILED, progress, note=problem + (f" ({note})" if note else ""))
    if outcome.startswith("failed") and os.path.join(folder, RUN_FILE) in new:
        return State(FAILED, progress, note=f"{folder}: {outcome}")
    return State(WAITING, progress, run.get("wallTime"), note=note)


def _ended(row, run):
    if not run:
        return State(FAILED, note=f"{damage(row.out)}; must be restored, or {row.out} removed to run the row")
    differs = row.kind and difference(row.kind, row.parameters, run)
    if differs:
        note = f"{row.out}: holds an ended run with {differs}; must be the same, or removed to run the row"
        return State(FAILED, note=note)
    return State(DONE, 1.0, run.get("wallTime"))


def _goes_on(row, run):
    """Whether a run that ended undecided, with a checkpoint, is the row's but for its duration, of which the row asks for more."""
    if not (row.kind and run and checkpoint.exists(row.out)):
        return False
    found = [difference(row.kind, row.parameters, run, but) for but in ((), ("duration",))]
    return found[0] is not None and found[1] is None


def undecided(rows, states):
    """'; 3 undecided (...)' of rows whose runs have ended with their outcome open, and so with a checkpoint; or ''."""
    found = [row for row, state in zip(rows, states) if state.kind == DONE and checkpoint.exists(row.out)]
    if not found:
        return ""
    return f"; {len(found)} undecided (longer: {os.path.basename(found[0].script)} continue=FOLDER duration=...)"


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


def _require_columns(path, row):
    others = [name for name in row.cells if name[0] == "!" and name not in OF_YADE_BATCH]
    if others:
        must = f"must be left out, or one of {', '.join(OF_YADE_BATCH)}"
        raise table.TableError(f"{path}: the column {others[0]} is for yade-batch alone; {must}")
    if row.cells.get("overwrite", "0") != "0":
        raise table.TableError(
            f"{path}: line {row.line}: overwrite = {row.cells['overwrite']}: a study keeps what has ended; must be 0"
        )


def _threads_of_yade(cells, parameters):
    """Of yade-batch's columns, or None; ParameterError where they and `threads` say different things."""
    column, found = RunParameters.columns()["threads"], parameters.threads
    for name in (name for name in THREADS if name in cells):
        given = replace(column, name=name).value(cells[name])
        if found not in (None, given):
            raise ParameterError(f"{name} = {given}: threads are {found}; must be the same")
        found = given
    return found
