"""The rows of a study, and what has become of each, from its run folder and its log."""

import os
import re
import signal
from dataclasses import dataclass, replace
from functools import cached_property

from analysis.runs.format import ENDED_FILE, same
from analysis.runs.lock import under_way
from analysis.runs.status import DONE, FAILED, RUNNING, WAITING, State, damage, end_time, run_of  # noqa: F401
from analysis.runs.status import running as running_state
from yade_scripts.experiments import collision, compression
from yade_scripts.parameters import ParameterError, UnknownParameter
from yade_scripts.parameters.arithmetic import NotANumber, evaluate
from yade_scripts.run import checkpoint, table
from yade_scripts.run.kind import Kind
from yade_scripts.run.parameters import RunParameters, file_name
from yade_scripts.run.report import outcome_in
from yade_scripts.run.resuming import difference

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPTS = os.path.join(TOP, "yade_scripts")
KINDS = {"collide.py": collision.KIND, "compress.py": compression.KIND}  # of the scripts in SCRIPTS
DEFAULT_SCRIPT = os.path.join(SCRIPTS, "collide.py")
THREADS = ("!THREADS", "!OMP_NUM_THREADS")
OF_YADE_BATCH = ("!SCRIPT", *THREADS)  # its columns that have a meaning here, too
SPEED = 80e6  # contact updates a second of the fused engine on one core, of docs/measurements.md
SLOWER = 30  # the same engine's speed over that of YADE's own loop
STOPPED = (128 + signal.SIGINT, 128 + signal.SIGTERM)  # exit statuses of a run that was stopped


@dataclass(frozen=True)
class StudyRow:
    """A row of a table.

    kind and parameters are of the script in KINDS; with a script of a user's own kind is None, and the parameters are
    those of every kind. Where they are wrong, parameters is None and error says why."""

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
    def own_cells(self):
        """The cells without yade-batch's own."""
        return {name: text for name, text in self.cells.items() if name[0] != "!"}

    @property
    def arguments(self):
        """{name: text} for its script: the row's, in the run folder, which resumes if it was stopped."""
        return {**self.own_cells, "out": self.out, "resume": 1}

    @cached_property
    def expected_seconds(self):
        """Seconds that its run should take: steps times contacts at SPEED; None for a kind of a user's own."""
        if self.kind is None:
            return None
        estimate = self.kind.estimate(self.parameters)
        slower = SLOWER if self.parameters.engine == "functors" else 1
        return slower * estimate.steps * estimate.contacts / SPEED / self.threads


def read(path):
    """[StudyRow] of a table; raises TableError, also when two rows would write to one folder or one log.

    Rows without !SCRIPT are collisions."""
    rows, lines = [], {}
    for row in table.read(path):
        _require_columns(path, row)
        name, script = file_name(row.description), find_script(row.cells.get("!SCRIPT", DEFAULT_SCRIPT))
        kind, parameters, threads, error = kind_of(script), None, None, None
        try:
            if not os.path.isfile(script):
                raise ParameterError(f"{script}: no such script")
            if kind:
                parameters = kind.parse(row.parameters, row.description)
            else:
                known = {name: cell for name, cell in row.cells.items() if name in ("out", "threads")}
                parameters = RunParameters.parse(known, row.description)
            threads = _threads_of_yade(row.cells, parameters)
        except UnknownParameter as problem:  # a column's, of all rows
            of = os.path.basename(script) + (": a column !SCRIPT names another" if "!SCRIPT" not in row.cells else "")
            raise table.TableError(f"{path}: {problem}, of {of}") from None
        except ParameterError as problem:
            parameters, error = None, f"line {row.line} of {path}: {problem}"
        for key in (f"description = {name}", f"out = {os.path.normpath(parameters.out) if parameters else name}"):
            if key in lines:
                raise table.TableError(f"{path}: lines {lines[key]} and {row.line} both have {key}; must be one")
            lines[key] = row.line
        rows.append(StudyRow(name, row.cells, script, kind, parameters, error, threads))
    return rows


def write(path, rows):
    """Write rows as a table whose runs resume in the same folders."""
    own = lambda row: {"description": row.name, "out": row.out}
    table.write(path, [{**own(row), **row.cells, "resume": 1, "!THREADS": row.threads} for row in rows])


def find_script(name):
    """The script that a table names: below the folder that one stands in, or else below the top of this suite."""
    own = os.path.join(TOP, name)
    return own if not os.path.isfile(name) and os.path.isfile(own) else name


def kind_of(script):
    """The Kind of a script (path), None of one of a user's own."""
    folder, name = os.path.split(os.path.realpath(script))
    return KINDS.get(name) if folder == os.path.realpath(SCRIPTS) else None


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
    """Of yade-batch's columns, or None; ParameterError where they and `threads` differ."""
    column, found = RunParameters.columns()["threads"], parameters.threads
    for name in (name for name in THREADS if name in cells):
        given = replace(column, name=name).value(cells[name])
        if found not in (None, given):
            raise ParameterError(f"{name} = {given}: threads are {found}; must be the same")
        found = given
    return found


# What has become of a row.


def refusal(row):
    """Why a row must not be run, in one line; None where it may, or has ended, or runs."""
    found = _settled(row)
    return found.note if found and found.kind == FAILED else None


def state(row, log):
    """What has become of a row; log: the file that its output goes to. One that must not be run is FAILED, too."""
    found = _settled(row)
    if found:
        return found
    run = run_of(row.out)
    note, progress = _stopped(row.out, run)
    problem = failure(log, row.out)
    if problem:
        return State(FAILED, progress, note=problem + (f" ({note})" if note else ""))
    return State(WAITING, progress, run.get("wallTime"), note=note)


def _settled(row):
    """State of a row that is wrong, has ended, or is under way; None of one that may be run."""
    if row.error:
        return State(FAILED, note=row.error)
    folder, lock = row.out, under_way(row.out)  # the lock first: a run that ends now has its mark before it gives it up
    run = run_of(folder)
    if os.path.exists(os.path.join(folder, ENDED_FILE)) and not _goes_on(row, run):
        return _ended(row, run)
    if lock and not lock.can_be_followed:
        return State(FAILED, note=f"{folder}: is run {lock}; must have ended there, or {folder}/lock be removed")
    return running_state(folder, run, lock) if lock else None


def _ended(row, run):
    if not run:
        return State(FAILED, note=f"{damage(row.out)}; must be restored, or {row.out} removed to run the row")
    differs = _difference(row, run)
    if differs:
        note = f"{row.out}: holds an ended run with {differs}; must be the same, or removed to run the row"
        return State(FAILED, note=note)
    return State(DONE, 1.0, run.get("wallTime"))


def _difference(row, run):
    """resuming.difference() of a run from a row; of a kind of a user's own in what the row gives."""
    if row.kind:
        return difference(row.kind, row.parameters, run)
    for name, text in row.own_cells.items():
        held = run.get("parameters", {}).get(name, text)
        try:
            wanted = evaluate(text)
        except NotANumber:
            wanted = text.strip("'\"")
        if name not in ("description", *_OF_NO_CONSEQUENCE) and not same(held, wanted):
            return f"{name} = {held}, not {text}"
    return None


_OF_NO_CONSEQUENCE = [name for name, column in RunParameters.columns().items() if not column.of_consequence]


def _goes_on(row, run):
    """Whether a run that ended undecided, with a checkpoint, is the row's but for its duration, which is longer in the
    row."""
    if not (row.kind and run and checkpoint.exists(row.out)):
        return False
    found = [difference(row.kind, row.parameters, run, but) for but in ((), ("duration",))]
    return found[0] is not None and found[1] is None


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


# The log of a row's run: all that it printed, and how it ended, in the words of yade-batch.


def summary(status):
    """What a log ends with; nothing for a run that was stopped, which has not failed. status: of the run, as a shell
    has it."""
    return "" if status in STOPPED else f"\nJOB SUMMARY\nstatus  : {status << 8} ({'FAILED' if status else 'OK'})\n"


def failure(log, folder):
    """Why the run of a log and a run folder (paths) failed, in one line; None when it did not, was stopped, or is
    under way."""
    try:
        with open(log, errors="replace") as file:
            text, _, end = file.read().partition("JOB SUMMARY")
    except OSError:
        return None
    status = re.search(r"^status  : (\d+)", end, re.MULTILINE)
    if not status:
        return None
    code = int(status.group(1)) >> 8
    if code > 128 and code not in STOPPED:
        return f"killed by signal {code - 128}"
    outcome = outcome_in(text)
    if outcome is None:
        message = re.findall(r"^[\w.-]+\.py: .*$", text, re.MULTILINE)
        return message[-1] if message else "the script did not come to its end"
    return None if outcome == "completed" else f"{folder}: {outcome}"
