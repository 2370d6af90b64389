"""A study: the rows of a table, their states, the time left, and the same as text."""

import os
import shutil
import sys
import time
from dataclasses import replace

from analysis.printable import printable
from analysis.runs.status import DONE, FAILED, RUNNING, WAITING, counts, duration_text
from analysis.runs.status import line as run_line
from yade_scripts.run import checkpoint
from yade_scripts.runner import rows, slurm
from yade_scripts.runner.batch import LOGS, Batch, StudyFolder

LINES = 15  # of a live table
EVERY, SHARE = 1.0, 0.05  # s between texts, and the share of the time that making them may take
POLL = 1.0  # s, for what runs elsewhere
HEAR_SIGNALS = 0.1  # s, while runs are at work


class Study:
    """The rows of a table, their states, and the estimate of the time left with `jobs` threads at once."""

    def __init__(self, table, jobs):
        self.name = os.path.splitext(os.path.basename(table))[0]
        self.rows, self.jobs = rows.read(table), jobs
        self.folder = StudyFolder(os.path.join(LOGS, self.name))
        self._states = [None] * len(self.rows)

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

    def forget_failures(self):
        """Remove the logs of rows that failed in an earlier call and may be run again."""
        failed = [row for row, state in zip(self.rows, self.states()) if state.kind == FAILED and not rows.refusal(row)]
        self.folder.remove_logs(failed)

    def running(self):
        """Run all rows that are left, and wait for those that others run; an iterator that goes on meanwhile. Closing
        it stops the runs, each with a checkpoint."""
        tried = set()
        while True:
            states = self.states()
            waiting = [row for row, state in zip(self.rows, states) if state.kind == WAITING]
            left = [row for row in waiting if row.name not in tried]
            if left:
                tried |= {row.name for row in left}
                with Batch(self.folder, left, self.jobs) as batch:
                    while batch.running():
                        batch.wait(HEAR_SIGNALS)
                        yield
            elif any(state.kind == RUNNING for state in states):
                time.sleep(POLL)
                yield
            else:
                return

    def undecided(self, states):
        """'; 3 undecided (...)' of runs that have ended with their outcome open, and so with a checkpoint; or ''."""
        done = [row for row, state in zip(self.rows, states) if state.kind == DONE]
        found = [row for row in done if checkpoint.exists(row.out)]
        if not found:
            return ""
        return f"; {len(found)} undecided (longer: {os.path.basename(found[0].script)} continue=FOLDER duration=...)"

    def slowness(self, states):
        """The time that the rows which have ended took, over the expected one; 1 before one has."""
        ended = [
            (state.seconds, row.expected_seconds)
            for row, state in zip(self.rows, states)
            if state.kind == DONE and state.seconds and row.expected_seconds
        ]
        return sum(real for real, _ in ended) / sum(expected for _, expected in ended) if ended else 1.0

    def seconds_left(self, states):
        """[Seconds that each row still takes], by its own pace where it has one; None where nothing is known."""
        slow, found = self.slowness(states), []
        for row, state in zip(self.rows, states):
            if state.kind not in (RUNNING, WAITING):
                found.append(0.0)
            elif state.left is not None or row.expected_seconds is None:
                found.append(state.left)
            else:
                found.append(slow * row.expected_seconds * (1 - state.progress))
        return found

    def time_left(self, states):
        """Seconds until every row has come to its end, with no thread idle; or None."""
        left = self.seconds_left(states)
        if None in left:
            return None
        work = sum(seconds * min(row.threads, self.jobs) for row, seconds in zip(self.rows, left) if seconds)
        return max(work / self.jobs, *left)

    def announce(self):
        """Print how much there is to do, and the estimate of the time."""
        states = self.states()
        left = [state for state in states if state.kind not in (DONE, FAILED)]
        if not left:
            return
        numbers = [(sum(state.kind == kind for state in states), kind) for kind in (DONE, FAILED)]
        ended = "".join(f"{number} {kind}, " for number, kind in numbers if number)
        resumed = sum(state.progress > 0 for state in left)
        seconds = self.time_left(states)
        million = rows.SPEED / self.slowness(states) / 1e6
        print(
            f"{printable(self.name)}: {len(self.rows)} rows, {ended}{len(left)} to run"
            f"{f', {resumed} of them from checkpoints' if resumed else ''}; "
            f"estimated time {'unknown' if seconds is None else duration_text(seconds)} with {self.jobs} at once, "
            f"at {million:.3g} million contact updates a second a core",
            flush=True,
        )

    def table(self, states, live=False):
        """Every row, and the headline below; live: the headline, and below it rows that run, failed, and come next,
        in at most LINES lines."""
        left = self.time_left(states)
        headline = f"{printable(self.name)}: {counts(states)}"
        headline += "" if left is None else f"; {duration_text(left)} left"
        shown = list(zip(self.rows, states, self.seconds_left(states)))
        if live:
            shown = [each for kind in (RUNNING, FAILED, WAITING) for each in shown if each[1].kind == kind]
        lines = [run_line(row.name, state, seconds) for row, state, seconds in shown[: LINES if live else None]]
        if not live:
            return "\n".join([*lines, headline])
        more = [f"  and {len(shown) - LINES} more: --status shows all"] if len(shown) > LINES else []
        return "\n".join([headline, *lines, *more])


class Paced:
    """A function that is called at most each second, and for at most SHARE of the time."""

    def __init__(self, function):
        self.function, self._next = function, 0.0

    def __call__(self):
        begun = time.monotonic()
        if begun >= self._next:
            self.function()
            self._next = begun + max(EVERY, (time.monotonic() - begun) / SHARE)


class Screen:
    """draw(text) replaces the text before on a terminal; elsewhere nothing is drawn."""

    def __init__(self, stream=sys.stderr):
        self.stream, self.shown = stream, stream.isatty()
        self._lines = 0

    def draw(self, text):
        if self.shown:
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
