"""The rows of a study, and the state of each, from its run folder and its log."""

import os
import re
import signal
from dataclasses import dataclass, replace
from functools import cached_property

from analysis.runs import status
from analysis.runs.format import ENDED_FILE, SAME, same
from analysis.runs.lock import under_way
from analysis.runs.status import DONE, FAILED, WAITING, State
from yade_scripts.experiments import collision, compression
from yade_scripts.parameters import InputError, NotANumber, ParameterError, UnknownParameter, evaluate
from yade_scripts.run import checkpoint, table
from yade_scripts.run.kind import Kind
from yade_scripts.run.parameters import RunParameters, file_name

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPTS = os.path.join(TOP, "yade_scripts")
KINDS = {"collide.py": collision.KIND, "compress.py": compression.KIND}  # of the scripts in SCRIPTS
THREADS = ("!THREADS", "!OMP_NUM_THREADS")
OF_YADE_BATCH = ("!SCRIPT", *THREADS)  # its columns that have a meaning here, too
SPEED = 80e6  # contact updates a second of the fused engine on one core, of docs/measurements.md
BESIDE = 150  # contacts that take as long as what else a step costs, and its part of a sample: 10 to 1,000 grains
SLOWER = 30  # the same engine's speed over that of YADE's own loop
STOPPED = (128 + signal.SIGINT, 128 + signal.SIGTERM)  # exit statuses of a run that was stopped


@dataclass(frozen=True)
class StudyRow:
    """A row of a table; where it is wrong, parameters is None and error has the reason.

    With a script of a user's own kind is None, and the parameters are those of every kind."""

    name: str
    cells: dict
    script: str
    kind: Kind = None
    parameters: RunParameters = None
    error: str = None
    threads_of_yade: int = None
    longer: float = None  # duration [s] to which the run goes on if it has ended undecided

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
        """[NAME=VALUE] with which its script runs, or goes on with what is there."""
        if self.longer and _lengthened(self, status.run_of(self.out)):
            return [f"{checkpoint.CONTINUE}={self.out}", f"duration={self.longer!r}"]
        return [f"{name}={text}" for name, text in {**table.own(self.cells), "out": self.out, "resume": 1}.items()]

    @cached_property
    def expected_seconds(self):
        """Seconds of its run: steps times contacts, and BESIDE, at SPEED; None for a kind of a user's own."""
        if self.kind is None:
            return None
        estimate = self.kind.estimate(self.parameters)
        slower = SLOWER if self.parameters.engine == "functors" else 1
        return slower * estimate.steps * (estimate.contacts + BESIDE) / SPEED / self.threads


def read(path, longer=None):
    """[StudyRow] of a table; raises InputError, also when two rows would write to one folder or one log. longer: as of
    StudyRow."""
    rows, lines = [], {}
    for row in table.read(path):
        for name in row.cells:
            if name[0] == "!" and name not in OF_YADE_BATCH:
                must = f"must be left out, or one of {', '.join(OF_YADE_BATCH)}"
                raise InputError(f"{path}: the column {name} is for yade-batch alone; {must}")
        if row.cells.get("overwrite", "0") != "0":
            given = f"overwrite = {row.cells['overwrite']}"
            raise InputError(f"{path}: line {row.line}: {given}: a study keeps what has ended; must be 0")
        found = replace(_row(path, row), longer=longer)
        folder = os.path.normpath(found.out) if found.parameters else found.name
        for key in (f"description = {found.name}", f"out = {folder}"):
            if key in lines:
                raise InputError(f"{path}: lines {lines[key]} and {row.line} both have {key}; must be one")
            lines[key] = row.line
        rows.append(found)
    return rows


def _row(path, row):
    """StudyRow of a table.Row; raises InputError for a column that is no parameter."""
    name = row.cells.get("!SCRIPT", "yade_scripts/collide.py")
    script = os.path.join(TOP, name) if os.path.isfile(os.path.join(TOP, name)) else name  # of this suite, or one's own
    folder, file = os.path.split(os.path.realpath(script))
    kind = KINDS.get(file) if folder == os.path.realpath(SCRIPTS) else None
    found = StudyRow(file_name(row.description), row.cells, script, kind)
    try:
        if not os.path.isfile(script):
            raise ParameterError(f"{name}: no such script")
        if kind:
            parameters = kind.parse(table.own(row.cells), row.description)
        else:
            known = {name: cell for name, cell in row.cells.items() if name in ("out", "threads")}
            parameters = RunParameters.parse(known, row.description)
        return replace(found, parameters=parameters, threads_of_yade=_threads_of_yade(row.cells, parameters))
    except UnknownParameter as problem:  # a column's, of all rows
        of = os.path.basename(script) + (": a column !SCRIPT names another" if "!SCRIPT" not in row.cells else "")
        raise InputError(f"{path}: {problem}, of {of}") from None
    except ParameterError as problem:
        return replace(found, error=f"line {row.line} of {path}: {problem}")


def _threads_of_yade(cells, parameters):
    """The threads in yade-batch's columns, or None; ParameterError where they and `threads` differ."""
    column, found = RunParameters.columns()["threads"], parameters.threads
    for name in (name for name in THREADS if name in cells):
        given = replace(column, name=name).value(cells[name])
        if found not in (None, given):
            raise ParameterError(f"{name} = {given}: threads are {found}; must be the same")
        found = given
    return found


# ---- the state of a row ----


def state(row, log):
    """State of a row; log: the file that its output goes to."""
    refused = lambda note: State(FAILED, note=note, refused=True)
    if row.error:
        return refused(row.error)
    folder, lock = row.out, under_way(row.out)  # the lock first: a run that ends now has its mark before it gives it up
    run = status.run_of(folder)
    differs = _difference(row, run) if run else None
    # one that ended undecided, where the row's duration, or that to which such runs go on, is longer
    longer_row = differs and row.kind and checkpoint.exists(folder) and not _difference(row, run, but=("duration",))
    goes_on = longer_row or (_lengthened(row, run) and run["timeReached"] < row.longer * (1 - 1e-3))
    if os.path.exists(os.path.join(folder, ENDED_FILE)) and not goes_on:
        if not run:
            return refused(f"{status.damage(folder)}; must be restored, or {folder} removed to run the row")
        if differs:
            return refused(f"{folder}: holds an ended run with {differs}; must be the same, or removed to run the row")
        if row.longer and run.get("outcome") == "undecided" and not checkpoint.exists(folder):
            return refused(
                f"{folder}: undecided, of a device, which leaves no checkpoint; must be removed to run longer"
            )
        return State(DONE, 1.0, run.get("wallTime"))
    if lock and not lock.can_be_followed:
        return refused(f"{folder}: is run {lock}; must have ended there, or {folder}/lock be removed")
    if lock:
        return status.running(folder, run, lock)
    note, progress = _stopped(folder, run)
    if problem := failure(log, folder):
        return State(FAILED, progress, note=problem + (f" ({note})" if note else ""))
    return State(WAITING, progress, run.get("wallTime"), note=note)


def _lengthened(row, run):
    """Whether a run is, or was before it was stopped, one that ended undecided, to be gone on with to row.longer."""
    if not (row.longer and row.kind and run and checkpoint.exists(row.out)):
        return False
    own = {**row.parameters.as_dict(), **row.kind.expected(row.parameters, run)}["duration"]
    ended = os.path.exists(os.path.join(row.out, ENDED_FILE))
    return ended or (run["parameters"].get("duration") or 0.0) > own * (1 + SAME)


def _difference(row, run, but=()):
    """checkpoint.difference() of a run from a row; of a kind of a user's own in what the row gives."""
    if row.kind:
        return checkpoint.difference(row.kind, row.parameters, run, but)
    columns = RunParameters.columns()
    for name, text in table.own(row.cells).items():
        held = run.get("parameters", {}).get(name, text)
        try:
            wanted = evaluate(text)
        except NotANumber:
            wanted = text.strip("'\"")
        if (name not in columns or columns[name].of_consequence) and not same(held, wanted):
            return f"{name} = {held}, not {text}"
    return None


def _stopped(folder, run):
    """(a note about a run that didn't come to its end, how far its checkpoint is)."""
    if not run:
        return "", 0.0
    if not checkpoint.exists(folder):
        return ("starts again", 0.0) if status.status_of(run) in ("running", "interrupted") else ("", 0.0)
    try:
        rows = checkpoint.Checkpoint.read(folder).rows
    except InputError:
        return "", 0.0
    reached = rows[-1][0] / status.end_time(run) if len(rows) else 0.0
    return f"checkpoint at {100 * reached:.0f} %", reached


# ---- the log of a row's run: all that it printed, and how it ended, in the words of yade-batch ----


def summary(code):
    """The end of a log, by an exit status as a shell has it; nothing for a run that was stopped."""
    return "" if code in STOPPED else f"\nJOB SUMMARY\nstatus  : {code << 8} ({'FAILED' if code else 'OK'})\n"


def failure(log, folder):
    """Why the run of a log and a run folder (paths) failed, in one line, or None."""
    try:
        with open(log, errors="replace") as file:
            text, _, end = file.read().partition("JOB SUMMARY")
    except OSError:
        return None
    found = re.search(r"^status  : (\d+)", end, re.MULTILINE)
    code = int(found.group(1)) >> 8 if found else 0
    if code == 0 or code in STOPPED:
        return None
    if code > 128:
        return f"killed by signal {code - 128}"
    lines = re.findall(r"^[\w.-]+\.py: (.*)$", text, re.MULTILINE)
    if lines:
        return f"{folder}: {lines[-1]}"
    printed = [line.strip() for line in text.splitlines() if line.strip()]
    return f"{folder}: {printed[-1] if printed else 'did not come to its end'} (all of it in {log})"
