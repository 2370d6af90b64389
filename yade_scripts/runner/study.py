"""A study: the rows of a table, what has become of each, the time left, and what it looks like as text."""

import os
import shutil
import sys
import time
from dataclasses import replace
from pathlib import Path

from analysis.printable import printable
from analysis.report.status import counts, duration_text
from analysis.report.status import line as run_line
from yade_scripts.runner import rows, slurm
from yade_scripts.runner.batch import StudyFolder
from yade_scripts.runner.cost import makespan
from yade_scripts.runner.rows import DONE, FAILED, RUNNING, WAITING

LINES = 15  # of a live table
EVERY = 1.0  # s
SHARE = 0.05  # of the time, at most, that goes into making texts


class Study:
    """The rows of a table, their states, and the estimate of what is left."""

    def __init__(self, table, jobs):
        self.name = os.path.splitext(os.path.basename(table))[0]
        self.table, self._text = table, _bytes_of(table)
        self.rows, self.jobs = rows.read(table), jobs
        self.folder = StudyFolder(self.name)
        self._states = {}

    def forget_failures(self):
        """Remove the logs of rows that have failed and may be run again: these failures are none of this call."""
        failed = [row for row, state in zip(self.rows, self.states()) if state.kind == FAILED and not rows.refusal(row)]
        self.folder.remove_logs(failed)
        self._states = {}

    def states(self, changed=None):
        """[State of each row]; looked at only for the rows that may have `changed` (names; None: any) since they were
        last."""
        for row in self.rows:
            before = self._states.get(row.name)
            if before is None or before.kind != DONE and (changed is None or row.name in changed):
                self._states[row.name] = rows.state(row, self.folder.log(row))
        return [self._states[row.name] for row in self.rows]

    def states_with_queue(self, changed=None, sure=False):
        """states(), with a note where a row is a task of Slurm's queue; [whether it is one, ...]. sure: as
        slurm.queued() has it."""
        states, queued = self.states(changed), slurm.queued(self.folder, sure)
        tasks = [None if row.error else queued.get((row.name, row.out)) for row in self.rows]
        for number, (state, task_of) in enumerate(zip(states, tasks)):
            if state.kind == WAITING and task_of:
                task, of_slurm = task_of
                note = f"Slurm job {task} {of_slurm.lower()}" + (f", {state.note}" if state.note else "")
                states[number] = replace(state, note=note)
        return states, list(map(bool, tasks))

    def text(self, drawn_as, changed=None):
        return self.drawn(drawn_as, self.states_with_queue(changed)[0])

    def drawn(self, drawn_as, states):
        """The same of rows in these states."""
        return drawn_as(self.name, self.rows, states, self.folder.cost(self.rows, states), self.jobs)

    def undecided(self, states=None):
        """How many of the runs that have ended are undecided, in words; '' where none is."""
        return rows.undecided(self.rows, self.states() if states is None else states)

    def has_been_edited(self):
        """Whether the table is another one than that which was read."""
        return _bytes_of(self.table) != self._text

    def left(self):
        """Seconds until every row is done or has failed, or None."""
        states = self.states()
        return total_left(states, self.folder.cost(self.rows, states), self.rows, self.jobs)

    def announce(self, stop):
        """Print how much there is to do, and the estimate; measures a piece of a run unless runs have ended."""
        states = self.states()
        left = [row for row, state in zip(self.rows, states) if state.kind not in (DONE, FAILED)]
        if not left:
            return
        screen = Screen()
        screen.draw("a piece of the first run is timed, for the estimate")
        self.folder.measure(left[0], self.rows, states, self.jobs, stop)
        screen.close()
        seconds = self.left()
        again = sum(state.progress > 0 for state in states if state.kind not in (DONE, FAILED))
        estimate = "unknown" if seconds is None else duration_text(seconds)
        print(
            f'{printable(self.name)}: {len(self.rows)} rows, {_counted(states, DONE, FAILED)}{len(left)} to run'
            f'{f", {again} of them from checkpoints" if again else ""}; estimated time {estimate} with '
            f'{self.jobs} at once ({self.folder.basis(self.rows, states)})',
            flush=True,
        )


def _bytes_of(path):
    """A file's bytes, or None."""
    try:
        return Path(path).read_bytes() if os.path.isfile(path) else None
    except OSError:
        return None


def _counted(states, *kinds):
    """'3 done, 1 failed, ', of those that there are."""
    counts = [(sum(state.kind == kind for state in states), kind) for kind in kinds]
    return "".join(f"{count} {kind}, " for count, kind in counts if count)


def headline(name, states, cost, rows, at_once):
    """One line: how many rows are done, running, waiting, failed, and the time left."""
    return f"{printable(name)}: {counts(states)}{_left(total_left(states, cost, rows, at_once))}"


def total_left(states, cost, rows, at_once):
    """Seconds until every row is done or has failed, or None when no cost is known."""
    left = {
        kind: [(seconds_left(state, cost, row), row.threads) for state, row in zip(states, rows) if state.kind == kind]
        for kind in (RUNNING, WAITING)
    }
    if any(time is None for time, _ in left[RUNNING] + left[WAITING]):
        return None
    start = cost.piece.start if cost.piece and left[WAITING] and not left[RUNNING] else 0.0
    return start + makespan(left[RUNNING], left[WAITING], at_once)


def seconds_left(state, cost, row):
    """Of one row: by the estimate, and more and more by its own pace as it runs."""
    if state.kind not in (RUNNING, WAITING):
        return 0.0
    estimate = cost.seconds(row)
    if estimate is None:
        return state.left
    by_estimate = estimate * (1 - state.progress)
    if state.kind == WAITING:
        return by_estimate
    if state.left is None:
        return max(0.0, by_estimate - (state.seconds or 0.0))
    return state.progress * state.left + (1 - state.progress) * by_estimate


def line(row, state, cost):
    """One row of the table."""
    return run_line(row.name, state, seconds_left(state, cost, row))


def full_table(name, rows, states, cost, at_once):
    """Every row, and the headline below."""
    return "\n".join(
        [line(row, state, cost) for row, state in zip(rows, states)] + [headline(name, states, cost, rows, at_once)]
    )


def live_table(name, rows, states, cost, at_once):
    """What runs, what failed, and what comes next, in no more than LINES lines, below the headline."""
    order = (RUNNING, FAILED, WAITING)
    chosen = sorted(
        (pair for pair in zip(rows, states) if pair[1].kind in order), key=lambda pair: order.index(pair[1].kind)
    )
    more = [f"  and {len(chosen) - LINES} more: --status shows all"] if len(chosen) > LINES else []
    return "\n".join(
        [headline(name, states, cost, rows, at_once)] + [line(row, state, cost) for row, state in chosen[:LINES]] + more
    )


def _left(seconds):
    return "" if seconds is None else f"; {duration_text(seconds)} left"


class Screen:
    """draw(text) replaces what was drawn before; nothing happens when the stream is no terminal (.shown)."""

    def __init__(self, stream=sys.stderr):
        self.stream, self.shown = stream, stream.isatty()
        self._lines = 0
        self._next = 0.0

    def draw_if_due(self, text):
        """draw(text()), unless that was done a moment ago; whether it was."""
        begun = time.monotonic()
        if not self.shown or begun < self._next:
            return False
        self.draw(text())
        took = time.monotonic() - begun
        self._next = begun + max(EVERY, took / SHARE)
        return True

    def draw(self, text):
        if not self.shown:
            return
        size = shutil.get_terminal_size()
        lines = [line[: size.columns - 1] for line in text.splitlines()[: size.lines - 1]]
        self._erase()
        self.stream.write("\n".join(lines) + "\n")
        self.stream.flush()
        self._lines = len(lines)

    def close(self):
        """Remove the drawing."""
        if self.shown:
            self._erase()
            self.stream.flush()
            self._lines = 0

    def _erase(self):
        if self._lines:
            self.stream.write(f"\033[{self._lines}A\033[J")
