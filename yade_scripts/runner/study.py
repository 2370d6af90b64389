"""A study: the rows of a table, their states, the time left, and the same as text."""

import os
import sys
import time
from contextlib import closing
from dataclasses import replace

from analysis.printable import printable
from analysis.progress import bar
from analysis.runs.status import DONE, FAILED, RUNNING, WAITING, counts, duration_text
from analysis.runs.status import line as run_line
from yade_scripts.experiments.collision import CollisionParameters
from yade_scripts.run import checkpoint, on_device
from yade_scripts.runner import rows, slurm
from yade_scripts.runner.batch import LOGS, Batch, StudyFolder

EVERY, SHARE = 1.0, 0.05  # s between looks at all rows for the bar, and the share of the time that they may take
POLL = 1.0  # s, for what runs elsewhere
HEAR_SIGNALS = 0.1  # s, while runs are at work


class Study:
    """The rows of a table, their states, and the estimate of the time left with `jobs` threads at once; longer: the
    duration [s] to which runs that ended undecided go on."""

    def __init__(self, table, jobs, longer=None):
        self.name = os.path.splitext(os.path.basename(table))[0]
        self.rows, self.jobs = rows.read(table, longer), jobs
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

    def run(self, stop=None, library=None):
        """Run what is left, with a bar meanwhile, and wait for what others run; the states at the end.

        stop: script.StopSignals. After a signal, or an exception such as KeyboardInterrupt, the runs are stopped, each
        with a checkpoint. library: run.ensemble.Library of a device, on which the rows run first that it can run."""
        failed = [row for row, state in zip(self.rows, self.states()) if state.kind == FAILED and not state.refused]
        self.folder.remove_logs(failed)  # they are tried again
        self._announce()
        if library:
            self._run_on(library, stop)
            if stop and stop.received:
                return self.states()
        due = 0.0
        with bar(len(self.rows), "runs") as shown, closing(self._running()) as running:
            for _ in running:
                if stop and stop.received:
                    shown.close()
                    print("stopping; the runs write their checkpoints", file=sys.stderr, flush=True)
                    break
                begun = time.monotonic()
                if begun >= due and not shown.disable:
                    self._show(shown)
                    due = time.monotonic() + max(EVERY, (time.monotonic() - begun) / SHARE)
        return self.states()

    def _run_on(self, library, stop):
        """Run the rows that a device can run on it; each has a log, as runs of workers have."""
        able = lambda row: isinstance(row.parameters, CollisionParameters) and not checkpoint.exists(row.out)
        states = zip(self.rows, self.states())
        waiting = [row for row, state in states if state.kind == WAITING and able(row)]
        fitting = [row for row in waiting if not on_device.why_not(row.parameters, library)]
        self.folder.remove_logs(fitting)
        with bar(len(fitting), f"on {library.device}") as shown:
            failed = on_device.run([row.parameters for row in fitting], library, stop, shown.update)
        for number, problem in failed.items():
            with open(self.folder.log(fitting[number]), "a") as log:
                log.write(f"{os.path.basename(fitting[number].script)}: {problem}\n{rows.summary(1)}")
        if others := len(self.rows) - len(fitting):
            print(f"{len(fitting)} rows on {library.device}; {others} are done, or not for it", flush=True)

    def _running(self):
        """Runs all rows; an iterator that goes on meanwhile, and stops the runs when it is closed."""
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

    def _show(self, shown):
        """Have a bar show how far the rows are."""
        states = self.states()
        left = self.time_left(states)
        left = "time left unknown" if left is None else f"{duration_text(left)} left"
        shown.set_postfix_str(f"{counts(states)}, {left}", refresh=False)
        shown.update(sum(state.progress for state in states) - shown.n)

    def undecided(self, states):
        """'; 3 undecided (...)' of runs that have ended with their outcome open, and so with a checkpoint; or ''."""
        done = [row for row, state in zip(self.rows, states) if state.kind == DONE]
        found = [row for row in done if checkpoint.exists(row.out)]
        if not found:
            return ""
        return f"; {len(found)} undecided (study.py TABLE --longer SECONDS goes on with them)"

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

    def _announce(self):
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

    def table(self, states):
        """A line for each row, and one for all."""
        left = self.time_left(states)
        lines = [run_line(row.name, *of) for row, *of in zip(self.rows, states, self.seconds_left(states))]
        last = f"{printable(self.name)}: {counts(states)}" + ("" if left is None else f"; {duration_text(left)} left")
        return "\n".join([*lines, last])
