"""What has become of a run, from its folder alone: of any machine.

running.py tells whether it is under way. A run of a version before 0.4.0 has no heartbeat: on another machine it is taken
for running as long as it writes its history, every ten seconds or so; the clocks must agree to a minute then."""

import os
import time
from dataclasses import dataclass

from .files import RunFolderError, read_arrays
from .folder import read_record
from .format import CHECKPOINT_FOLDER, ENDED_FILE, HEARTBEAT_FILE, HISTORY_FILE, RUN_FILE, STATES_FOLDER
from .running import place

DONE, RUNNING, WAITING, FAILED = "done", "running", "waiting", "failed"
KINDS = (DONE, RUNNING, WAITING, FAILED)
SILENCE = 180.0  # s without a write after which a run without a heartbeat is taken for stopped
EARLY = 0.02  # progress below which a pace tells nothing
FAILURE = "failed"  # how the outcome of a failed run begins, in run.json


@dataclass(frozen=True)
class State:
    """kind: DONE, ...; progress: 0 to 1; seconds: wall time spent; left: seconds by the run's own pace, if known; host: the
    machine on which it is running, if known."""

    kind: str
    progress: float = 0.0
    seconds: float = None
    left: float = None
    note: str = ""
    host: str = None


def state(folder, now=None):
    """State of the run in a folder (path); now: seconds since 1970. Running is what running.place() says; without a
    heartbeat also what wrote within SILENCE seconds and has not said that it stopped. Waiting is what was stopped or killed:
    time left is then by the pace it had."""
    now = time.time() if now is None else now
    where = place(folder)  # first: a run that ends now has its mark before it gives up its heartbeat
    run = run_of(folder)
    outcome = str(run.get("outcome", ""))
    if os.path.exists(os.path.join(folder, ENDED_FILE)):
        if not run:
            return State(FAILED, note=f"ended, but {damage(folder)}")
        return State(DONE, 1.0, _spent(folder, run))
    if where:
        return running(folder, run, where, now)
    progress = progress_of(folder, run)
    if outcome.startswith(FAILURE):
        return State(FAILED, progress, _spent(folder, run), note=outcome)
    without = not os.path.exists(os.path.join(folder, HEARTBEAT_FILE))
    if without and now - newest_write(folder) < SILENCE and outcome in ("", "running"):
        return running(folder, run, None, now)
    spent = _spent(folder, run)
    left = spent * (1 - progress) / progress if progress >= EARLY else None
    how = "stopped" if outcome == "interrupted" else "stopped without a word"
    return State(WAITING, progress, spent, left, f"{how}, {_resumes(folder)}")


def running(folder, run, where=None, now=None):
    """State of a run that is under way; where: its running.Place, if known. Its pace is that of the wall time and the
    progress at the last writing of the history."""
    now = time.time() if now is None else now
    progress = progress_of(folder, run)
    known = {} if where is None else {"host": where.host, "note": "" if where.here else str(where)}
    begun, written = (changed(os.path.join(folder, name)) for name in (RUN_FILE, HISTORY_FILE))
    if begun < 0:
        return State(RUNNING, progress, **known)
    spent, since = _spent(folder, run), max(0.0, now - max(begun, written))
    paced = written > begun and progress >= EARLY
    left = max(0.0, spent * (1 - progress) / progress - since) if paced else None
    return State(RUNNING, progress, spent + since, left, **known)


def progress_of(folder, run):
    """How far a run is by its history, 0 to 1; 0 where that cannot be told. run: its run.json."""
    try:
        reached = float(read_arrays(os.path.join(folder, HISTORY_FILE), ("time",))["time"][-1]) / end_time(run)
    except (RunFolderError, KeyError, IndexError, TypeError, ZeroDivisionError):
        return 0.0
    return min(1.0, max(0.0, reached))


def end_time(run):
    """Time [s] at which a run (its run.json) is at its planned end; KeyError or TypeError where it doesn't say."""
    return run["derived"]["steps"] * run["derived"]["timeStep"]


def run_of(folder):
    """A run folder's run.json, or {} when there is none that can be read."""
    try:
        run, _ = read_record(folder)
    except RunFolderError:
        return {}
    return run if isinstance(run, dict) else {}


def damage(folder):
    """What is wrong with a run folder's run.json, for which run_of() gives {}; one line."""
    try:
        read_record(folder)
    except RunFolderError as error:
        return str(error)
    return f"{os.path.join(folder, RUN_FILE)}: not the record of a run"


def newest_write(folder):
    """When something was last written in a run folder [s since 1970]; -1 when it isn't there."""
    inside = (RUN_FILE, HISTORY_FILE, STATES_FOLDER, CHECKPOINT_FOLDER)
    return max(changed(os.path.join(folder, name)) for name in inside)


def changed(path):
    """When a file or folder was written [s since 1970]; -1 when it isn't there."""
    try:
        return os.stat(path).st_mtime
    except OSError:
        return -1.0


def _spent(folder, run):
    """Wall time [s] until the last writing of the history, that of earlier starts included."""
    earlier = run.get("wallTime")
    earlier = float(earlier) if isinstance(earlier, (int, float)) else 0.0
    if run.get("outcome") != "running":
        return earlier
    begun, written = changed(os.path.join(folder, RUN_FILE)), changed(os.path.join(folder, HISTORY_FILE))
    return earlier + max(0.0, written - begun)


def _resumes(folder):
    there = os.path.isdir(os.path.join(folder, CHECKPOINT_FOLDER))
    return "has a checkpoint" if there else "starts again"
