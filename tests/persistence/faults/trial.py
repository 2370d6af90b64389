"""What is done to a command at each of its file-system calls, and what must hold afterwards."""

import shutil
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from faults.commands import COLLIDE, OTHER, OVERWRITE, PROGRAMS, RECORDER, RESUME, RUN, ended_runs
from faults.forks import DISK_FULL, END_BEFORE, END_HALFWAY

from analysis.atlas.columns import COLUMNS
from analysis.atlas.query import RUNS_FILE
from analysis.runs.files import is_unfinished
from analysis.runs.table import read_table, table_text

ACTIONS = {"ends before": END_BEFORE, "ends halfway": END_HALFWAY, "disk full from": DISK_FULL}
STOPPED = 143
ENDED_RUN = {"ended", "history.npz", "run.json", "states"}
# A study of one's own, as analysis/STUDIES.md has it, and a table for the runner: what commands read beside runs.
OWN = """
from analysis.studies.comparison import Row
from analysis.studies.estimates import ending
from analysis.studies.figures import curves
from analysis.studies.study import collision_study

sticking = lambda runs: ending(runs, "sticking")
rows = lambda runs: [Row("sticking", sticking(runs))]
figures = lambda runs: [("sticking", "What sticks.", curves(runs, sticking, "velocity", log="x"))]
STUDY = collision_study("T", "Q?", ("velocity", "seed"), rows, figures)
"""
TABLE = "description {}\na {}\n".format(*(" ".join(words) for words in zip(*(cell.split("=") for cell in RUN))))


@dataclass(frozen=True)
class Case:
    """One fault: at which call of which command, and what was wrong afterwards (nothing: [])."""

    command: str
    fault: str
    call: str
    wrong: list


class Trial:
    """One Command in a folder of its own. forks: faults.forks.Forks; calls: its calls without a fault; whole: what is written then."""

    def __init__(self, forks, command, folder):
        self._forks, self.command, self.folder = forks, command, Path(folder)
        self._out, self._kept = self.folder / command.watched, self.folder / "before"
        for name, more in (("run", ()), ("other", OTHER)):
            assert forks.run(RUN + more, self.folder / name).status == 0
        (self.folder / "own.py").write_text(OWN)
        (self.folder / "t.table").write_text(TABLE)
        (self.folder / "bin").mkdir()
        for name, line in PROGRAMS.items():
            (self.folder / "bin" / name).write_text(f"#!/bin/sh\n{line}\n")
            (self.folder / "bin" / name).chmod(0o755)
        if command.program != COLLIDE:
            self._out.mkdir()
        if command.watched == "atlas":
            _part_of_the_atlas(self._out)
        if command.before is not None:
            calls = self._made(command.before)
            if command.checkpoints:
                shutil.rmtree(self._out)
                self._call(command.before, _checkpoints(calls)[command.checkpoints - 1] + 1, END_BEFORE)
        if self._out.exists():
            shutil.copytree(self._out, self._kept, symlinks=True)
        self._before = command.content(self._out)
        self.calls = self._made(command.arguments)
        self.whole = command.content(self._out)

    def _made(self, arguments):
        """The calls without a fault."""
        done = self._call(arguments)
        assert done.status == 0, done.lines
        return done.calls

    def _call(self, arguments, *fault):
        return self._forks.call(self.command.program, arguments, self._out, *fault)

    def _put_back(self, kept):
        """The files as they were."""
        shutil.rmtree(self._out, ignore_errors=True)
        (self.folder / "bin/sbatch.called").unlink(missing_ok=True)
        if kept.exists():
            shutil.copytree(kept, self._out, symlinks=True)

    def cases(self, every=None, offset=0):
        """Case of each fault at every so many calls (None: as the command says); halfway only in writes."""
        for call in self.calls[offset :: every or self.command.every]:
            for fault in ACTIONS:
                if ACTIONS[fault] != END_HALFWAY or call.name in ("write", "sendfile"):
                    yield self.case(call, fault)

    def stops(self, checkpoint, every=1):
        """Case of SIGTERM before each call of one checkpoint of a run, and SIGKILL at each call from there on to the next
        checkpoint's end (or at every so many of these pairs)."""
        first, last = (_checkpoints(self.calls)[number] for number in (checkpoint - 1, checkpoint))
        pairs = [(stop, number) for stop in range(first + 1, last + 1) for number in range(stop, last + 25)]
        for stop, number in pairs[::every]:
            yield self.case(self.calls[number - 1], "ends before", stop)

    def case(self, call, fault, stop=0):
        """Case of a fault at a Call; stop: SIGTERM before the call of that number."""
        self._put_back(self._kept)
        rows = max(1, checkpoint_rows(self._out) if RESUME in self.command.arguments else 0)
        done = self._call(self.command.arguments, call.number, ACTIONS[fault], stop)
        found, wrong = self.command.content(self._out), []
        half = [path for path in found if found[path] not in (self._before.get(path), self.whole.get(path))]
        wrong += [f"half of {len(half)} files, such as {half[0]}"] if half else []
        if ACTIONS[fault] == DISK_FULL:
            wrong += wrong_on_a_full_disk(done)
            wrong += ["exit status 0, but not all is there"] if done.status == 0 and found != self.whole else []
        elif done.status != -9 and not (stop and done.status == STOPPED):  # stopped before that call
            wrong.append(f"exit status {done.status}: {done.lines}")
        written = len(_checkpoints(done.calls[: call.number - 1]))
        if written and not found and checkpoint_rows(self._out) < rows + written:
            wrong.append(f"checkpoint of {checkpoint_rows(self._out)} rows, there was one of {rows + written}")
        if self._out.exists():
            shutil.copytree(self._out, self.folder / "faulted", symlinks=True)
        for arguments in self.command.again or [self.command.arguments]:
            self._put_back(self.folder / "faulted")
            wrong += self._wrong_again(arguments, found)
        shutil.rmtree(self.folder / "faulted", ignore_errors=True)
        return Case(self.command.name, fault, f"{call}, SIGTERM before {stop}" if stop else str(call), wrong)

    def _wrong_again(self, arguments, found):
        """What is wrong when the command is called again with these arguments; found: what was whole."""
        again = self._call(arguments)
        while any("is being run by another process" in line for line in again.lines):  # the killed one's workers
            again = self._call(arguments)
        content = self.command.content(self._out)
        if found and self.command.content is ended_runs and OVERWRITE not in arguments and again.status == 2:
            return [] if content == found else [f"again: changes what it refuses: {again.lines[-1:]}"]
        wrong = []
        if content != self.whole or again.status and found != self.whole:
            wrong.append(f"again: exit status {again.status}: {again.lines[-1:]}")
        names = {path.name for path in self._out.iterdir()}
        left = [path.name for path in self._out.rglob("*") if is_unfinished(path.name)]
        left += names - ENDED_RUN if "ended" in names else []
        return wrong + ([f"again: leaves {left}"] if left else [])


def _checkpoints(calls):
    """Numbers of the calls by which checkpoints are there."""
    return [call.number for call in calls if call.name == "rename" and call.path == RECORDER]


def _part_of_the_atlas(folder):
    """A twelfth of its table of runs: the model takes a minute of each call."""
    table, head = read_table(RUNS_FILE, COLUMNS)
    (folder / "runs.csv").write_text(table_text(table[::12], COLUMNS, head))


def checkpoint_rows(run):
    """Number of rows in a run folder's checkpoint; 0 without one."""
    if not (run / RECORDER).exists():
        return 0
    with np.load(run / RECORDER) as archive:
        return len(archive["rows"])


def wrong_on_a_full_disk(done):
    """What is wrong unless a program said so in one line and its status, or had nothing left to write."""
    full = [line for line in done.lines if "No space left on device" in line and not line.startswith("run folder: ")]
    if done.status == 0 and not full:
        return []
    untidy = [line for line in done.lines if line.startswith("Traceback")]
    right = done.status in (1, 2) and len(full) == 1 and not untidy
    return [] if right else [f"exit status {done.status}, {len(full)} lines: {done.lines[-1:]}"]


def power_loss(calls):
    """What a power loss could take although it must not, in words (nothing: []), from the calls of a run.

    Of files that were written, and names that were made, without an fsync since, nothing may be counted on. So all must
    be on the disk before `ended` gets its name, scene and states before recorder.npz gets its, and recorder.npz before
    an older scene goes. A heartbeat says nothing of a run that a power loss has ended.
    """
    content, names, wrong = set(), set(), []  # without fsync
    for call in (call for call in calls if "heartbeat" not in call.path):
        folder, _, file = call.path.rpartition("/")
        if call.name == "write":
            content.add(call.path)
        elif call.name == "fsync":
            content.discard(call.path)
            names = {name for name in names if (name.rpartition("/")[0] or ".") != call.path}
        elif call.name == "rename":
            temporary = {path for path in content if path.startswith(f"{folder}/.{file}.".lstrip("/"))}
            own = {call.path} if temporary else set()
            content = content - temporary | own
            if call.path in ("ended", RECORDER):
                wrong += [f"{path} at the renaming of {call.path}" for path in sorted(content | names - {call.path})]
            names.add(call.path)
        elif call.name == "unlink":
            content.discard(call.path)
        if call.name == "unlink" and file.startswith("scene-"):
            wrong += [f"{path} at the removal of {call.path}" for path in sorted(content | names) if path == RECORDER]
    return wrong
