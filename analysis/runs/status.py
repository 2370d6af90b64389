"""What has become of a run of any machine, from its folder alone, also as a line of text; and whether its files are as
the run has left them."""

import os
import time
from dataclasses import dataclass
from pathlib import Path

from tqdm import tqdm

from ..printable import printable
from .files import RunFolderError, read_arrays, read_bytes
from .folder import read_ended, read_record, state_files
from .format import CHECKPOINT_FOLDER, ENDED_FILE, HISTORY_FILE, RUN_FILE
from .lock import under_way

DONE, RUNNING, WAITING, FAILED = "done", "running", "waiting", "failed"
KINDS = (DONE, RUNNING, WAITING, FAILED)
EARLY = 0.02  # progress below which a pace says nothing
FAILURE = "failed"  # how the status of a failed run begins, in run.json
NO_SUMS = "has no sums (of a version before 0.5.0): damage that leaves it readable is not noticed"


@dataclass(frozen=True)
class State:
    """What has become of a run."""

    kind: str  # DONE, RUNNING, WAITING (it was stopped, killed or has not begun) or FAILED
    progress: float = 0.0  # 0 to 1
    seconds: float | None = None  # wall time spent
    left: float | None = None  # wall time left by the run's own pace [s]
    note: str = ""
    host: str | None = None  # the machine on which it is running
    refused: bool = False  # a row of a study that FAILED and must not be run as it stands


def state(folder):
    """State of the run in a folder (path)."""
    lock = under_way(folder)  # first: a run that ends now has its mark before it gives up its lock
    run = run_of(folder)
    status = status_of(run)
    if os.path.exists(os.path.join(folder, ENDED_FILE)):
        problems = _wrong(read_record, folder)
        return State(FAILED, note=f"ended, but {problems[0]}") if problems else State(DONE, 1.0, _spent(folder, run))
    if lock:
        return running(folder, run, lock)
    progress, spent = progress_of(folder, run), _spent(folder, run)
    if status.startswith(FAILURE):
        return State(FAILED, progress, spent, note=status)
    left = spent * (1 - progress) / progress if progress >= EARLY else None
    how = "stopped" if status == "interrupted" else "stopped without a word"
    checkpoint = os.path.isdir(os.path.join(folder, CHECKPOINT_FOLDER))
    return State(WAITING, progress, spent, left, f"{how}, {'has a checkpoint' if checkpoint else 'starts again'}")


def running(folder, run, lock):
    """State of a run that is under way. Its pace is that of the wall time and the progress when the history was last
    written.

    run: its run.json (dict); lock: its lock.Lock."""
    progress, where = progress_of(folder, run), {"host": lock.host, "note": "" if lock.is_here else str(lock)}
    begun, written = (changed(os.path.join(folder, name)) for name in (RUN_FILE, HISTORY_FILE))
    if begun < 0:
        return State(RUNNING, progress, **where)
    spent, since = _spent(folder, run), max(0.0, time.time() - max(begun, written))
    paced = written > begun and progress >= EARLY
    left = max(0.0, spent * (1 - progress) / progress - since) if paced else None
    return State(RUNNING, progress, spent + since, left, **where)


def progress_of(folder, run):
    """How far a run is by its history, 0 to 1; 0 where that cannot be read. run: its run.json."""
    try:
        reached = float(read_arrays(os.path.join(folder, HISTORY_FILE), ("time",))["time"][-1]) / end_time(run)
    except (RunFolderError, KeyError, IndexError, TypeError, ZeroDivisionError):
        return 0.0
    return min(1.0, max(0.0, reached))


def end_time(run):
    """Time [s] at which a run (its run.json) is at its planned end; KeyError or TypeError where it doesn't say."""
    return run["derived"]["steps"] * run["derived"]["timeStep"]


def status_of(run):
    """The status in a run's run.json (dict), which stood under `outcome` until format 5."""
    return str(run.get("status") or run.get("outcome") or "")


def run_of(folder):
    """A run folder's run.json, or {} when there is none that can be read."""
    try:
        run, _ = read_record(folder)
    except RunFolderError:
        return {}
    return run if isinstance(run, dict) else {}


def changed(path):
    """When a file or folder was written [s since 1970]; -1 when it isn't there."""
    try:
        return os.stat(path).st_mtime
    except OSError:
        return -1.0


def _spent(folder, run):
    """Wall time [s] until the history was last written, that of earlier starts included."""
    earlier = run.get("wallTime")
    earlier = float(earlier) if isinstance(earlier, (int, float)) else 0.0
    if status_of(run) != "running":
        return earlier
    begun, written = changed(os.path.join(folder, RUN_FILE)), changed(os.path.join(folder, HISTORY_FILE))
    return earlier + max(0.0, written - begun)


def verify_run(folder):
    """([what differs from the sums that the run has left], [what else there is to say]) of a run folder (path), in
    lines."""
    folder = Path(folder)
    try:
        sums = read_ended(folder)
    except RunFolderError as error:
        return [str(error)], []
    if sums is None:
        if status_of(run_of(folder)) == "completed":
            return [f"{folder / ENDED_FILE}: missing, though the run is completed"], []
        return [], ["has no sums before it has ended"]
    if not sums:
        problems = _wrong(read_record, folder)
        return problems, [] if problems else [NO_SUMS]
    checks = [_wrong(read_bytes, folder / name, digits) for name, digits in sorted(sums.items())]
    problems = sum([*checks, _wrong(state_files, folder, sums)], [])
    return problems, [] if problems else [f"{len(sums)} files, as the run has left them"]


def _wrong(check, *of):
    """[what check(*of) finds wrong]."""
    try:
        check(*of)
    except RunFolderError as error:
        return [str(error)]
    return []


# As text.

WIDTH = 20  # of a bar


def duration_text(seconds):
    """02:03 or 1:02:03 for a number of seconds."""
    return tqdm.format_interval(seconds)


def counts(states):
    """How many are done, running, waiting and failed, in words."""
    return ", ".join(f"{sum(state.kind == kind for state in states)} {kind}" for kind in KINDS)


def line(name, state, left=None):
    """One run: its state, name, bar, time left [s] (None: unknown) and note."""
    text, note = f"  {state.kind:8s} {printable(name):24s}", printable(state.note)
    if state.kind == FAILED:
        return f"{text} {note}"
    if state.kind == DONE:
        return f"{text} {duration_text(state.seconds or 0):>8s}"
    filled = int(WIDTH * state.progress)
    bar = f' [{"#" * filled}{"." * (WIDTH - filled)}] {100 * state.progress:5.1f} %' if state.kind == RUNNING else ""
    return text + bar + ("" if left is None else f" {duration_text(left):>8s} left") + (f"  {note}" if note else "")


def total(states):
    """How many there are of each kind, and the time left."""
    text = f"{len(states)} runs: {counts(states)}"
    for kind, sum_up, what in (
        (RUNNING, max, "left until the last running one ends"),
        (WAITING, sum, "for the waiting ones, one after another"),
    ):
        left = [own.left for own in states if own.kind == kind]
        if left:
            text += "; " + ("unknown time" if None in left else duration_text(sum_up(left))) + f" {what}"
    return text
