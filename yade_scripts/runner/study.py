"""A study: the rows of a table, what has become of each, the time left, and what it looks like as text."""

import os
import shutil
import sys
import time
from dataclasses import replace

from analysis.printable import printable
from analysis.runs.status import counts, duration_text
from analysis.runs.status import line as run_line
from yade_scripts.run import checkpoint
from yade_scripts.runner import rows, slurm
from yade_scripts.runner.batch import StudyFolder
from yade_scripts.runner.rows import DONE, FAILED, RUNNING, SPEED, WAITING

LINES = 15  # of a live table
EVERY = 1.0  # s
SHARE = 0.05  # of the time, at most, that goes into making texts


class Study:
    """The rows of a table, their states, and the estimate of the time left."""

    def __init__(self, table, jobs):
        self.name = os.path.splitext(os.path.basename(table))[0]
        self.rows, self.jobs = rows.read(table), jobs
        self.folder = StudyFolder(self.name)
        self._states = [None] * len(self.rows)

    def forget_failures(self):
        """Remove the logs of rows that failed in an earlier call and may be run again."""
        failed = [row for row, state in zip(self.rows, self.states()) if state.kind == FAILED and not rows.refusal(row)]
        self.folder.remove_logs(failed)

    def states(self):
        """[State of each row] now; a row that is done stays so."""
        for number, (row, before) in enumerate(zip(self.rows, self._states)):
            if before is None or before.kind != DONE:
                self._states[number] = rows.state(row, self.folder.log(row))
        return list(self._states)

    def states_with_queue(self, sure=False):
        """states(), with a note where a row is a task of Slurm's queue; [whether it is one, ...]. sure: as
        slurm.queued() has it."""
        states, queued = self.states(), slurm.queued(self.folder, sure)
        tasks = [None if row.error else queued.get((row.name, row.out)) for row in self.rows]
        for number, (state, task_of) in enumerate(zip(states, tasks)):
            if state.kind == WAITING and task_of:
                task, of_slurm = task_of
                note = f"Slurm job {task} {of_slurm.lower()}" + (f", {state.note}" if state.note else "")
                states[number] = replace(state, note=note)
        return states, list(map(bool, tasks))

    def undecided(self, states):
        """'; 3 undecided (...)' of runs that have ended with their outcome open, and so with a checkpoint; or ''."""
        done = [row for row, state in zip(self.rows, states) if state.kind == DONE]
        found = [row for row in done if checkpoint.exists(row.out)]
        if not found:
            return ""
        return f"; {len(found)} undecided (longer: {os.path.basename(found[0].script)} continue=FOLDER duration=...)"

    def announce(self):
        """Print how much there is to do, and the estimate of the time."""
        states = self.states()
        left = [state for state in states if state.kind not in (DONE, FAILED)]
        if not left:
            return
        numbers = [(sum(state.kind == kind for state in states), kind) for kind in (DONE, FAILED)]
        ended = "".join(f"{number} {kind}, " for number, kind in numbers if number)
        resumed = sum(state.progress > 0 for state in left)
        seconds = time_left(self.rows, states, self.jobs)
        million = SPEED / slowness(self.rows, states) / 1e6
        print(
            f"{printable(self.name)}: {len(self.rows)} rows, {ended}{len(left)} to run"
            f"{f', {resumed} of them from checkpoints' if resumed else ''}; "
            f"estimated time {'unknown' if seconds is None else duration_text(seconds)} with {self.jobs} at once, "
            f"at {million:.3g} million contact updates a second a core",
            flush=True,
        )


def slowness(rows, states):
    """The time that the rows which have ended took, over what was expected of them; 1 before one has."""
    ended = [
        (state.seconds, row.expected_seconds)
        for row, state in zip(rows, states)
        if state.kind == DONE and state.seconds and row.expected_seconds
    ]
    return sum(real for real, _ in ended) / sum(expected for _, expected in ended) if ended else 1.0


def seconds_left(row, state, slow):
    """Of one row, by its own pace where it has one; None where nothing is known. slow: slowness()."""
    if state.kind not in (RUNNING, WAITING):
        return 0.0
    if state.left is not None or row.expected_seconds is None:
        return state.left
    return slow * row.expected_seconds * (1 - state.progress)


def time_left(rows, states, jobs):
    """Seconds until every row has come to its end, with `jobs` threads at once and none of them idle; or None."""
    slow = slowness(rows, states)
    left = [seconds_left(row, state, slow) for row, state in zip(rows, states)]
    if None in left:
        return None
    work = sum(seconds * min(row.threads, jobs) for row, seconds in zip(rows, left) if seconds)
    return max(work / jobs, *left)


def headline(name, rows, states, jobs):
    """One line: how many rows are done, running, waiting, failed, and the time left."""
    left = time_left(rows, states, jobs)
    return f"{printable(name)}: {counts(states)}" + ("" if left is None else f"; {duration_text(left)} left")


def full_table(name, rows, states, jobs):
    """Every row, and the headline below."""
    slow = slowness(rows, states)
    lines = [run_line(row.name, state, seconds_left(row, state, slow)) for row, state in zip(rows, states)]
    return "\n".join([*lines, headline(name, rows, states, jobs)])


def live_table(name, rows, states, jobs):
    """The headline, and below it what runs, what failed, and what comes next, in at most LINES lines."""
    order, slow = (RUNNING, FAILED, WAITING), slowness(rows, states)
    shown = [(row, state) for kind in order for row, state in zip(rows, states) if state.kind == kind]
    lines = [run_line(row.name, state, seconds_left(row, state, slow)) for row, state in shown[:LINES]]
    more = [f"  and {len(shown) - LINES} more: --status shows all"] if len(shown) > LINES else []
    return "\n".join([headline(name, rows, states, jobs), *lines, *more])


class Screen:
    """draw(text) replaces what was drawn before; nothing is drawn when the stream is no terminal (.shown)."""

    def __init__(self, stream=sys.stderr):
        self.stream, self.shown = stream, stream.isatty()
        self._lines = 0
        self._next = 0.0

    def draw_if_due(self, text):
        """draw(text()), unless that was done a moment ago."""
        begun = time.monotonic()
        if self.shown and begun >= self._next:
            self.draw(text())
            self._next = begun + max(EVERY, (time.monotonic() - begun) / SHARE)

    def draw(self, text):
        if not self.shown:
            return
        size = shutil.get_terminal_size()
        lines = [line[: size.columns - 1] for line in text.splitlines()[: size.lines - 1]]
        self.close()
        self.stream.write("\n".join(lines) + "\n")
        self.stream.flush()
        self._lines = len(lines)

    def close(self):
        """Remove the drawing."""
        if self._lines:
            self.stream.write(f"\033[{self._lines}A\033[J")
            self.stream.flush()
            self._lines = 0
