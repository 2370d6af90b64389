"""A study: the rows of a table, what has become of each, and the time left."""

import os
from dataclasses import replace
from pathlib import Path

from analysis.printable import printable
from yade_scripts.runner import rows, slurm, view
from yade_scripts.runner.batch import StudyFolder
from yade_scripts.runner.rows import DONE, FAILED, WAITING
from yade_scripts.runner.screen import Screen


class Study:
    """The rows of a table, their states, and the estimate of what is left."""

    def __init__(self, table, jobs, run_scripts):
        self.name = os.path.splitext(os.path.basename(table))[0]
        self.table, self._text = table, _bytes_of(table)
        self.rows, self.jobs = rows.read(table, run_scripts), jobs
        self.folder = StudyFolder(self.name)
        self._before = {}
        self._states = {}

    def forget_failures(self):
        """From now on only those that follow count."""
        self._before = {
            file: when for row in self.rows for file, when in rows.traces(row, self.folder.log(row)).items()
        }

    def states(self, changed=None):
        """[State of each row]; looked at only for the rows that may have `changed` (names; None: any) since they were last."""
        for row in self.rows:
            before = self._states.get(row.name)
            if before is None or before.kind != DONE and (changed is None or row.name in changed):
                self._states[row.name] = rows.state(row, self.folder.log(row), self._before)
        return [self._states[row.name] for row in self.rows]

    def states_with_queue(self, changed=None, sure=False):
        """states(), with a note where a row is a task of Slurm's queue; [whether it is one, ...]. sure: as slurm.queued() has it."""
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
        return view.total_left(states, self.folder.cost(self.rows, states), self.rows, self.jobs)

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
        estimate = "unknown" if seconds is None else view.duration_text(seconds)
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
