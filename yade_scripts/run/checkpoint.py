"""Checkpoints: what a run needs to resume to the same bits after it was stopped or killed.

The folder checkpoint/ of a run holds scene-STEP.yade (O.save: the bodies and the engine's arrays) and recorder.npz (the
history so far, and whose checkpoint this is). recorder.npz names the scene it belongs to, with its size and SHA-256, and
is written after it, so that at any moment there is one whole checkpoint, or none. Before a run resumes, and before
anything of its folder is removed, the checkpoint is checked: the scene, the rows, the states that were written before.
The fused engine resumes to the same bits; YADE's own loop may add up forces in another order after loading, so to
rounding.
"""

import hashlib
import json
import os

import numpy as np

from analysis.runs.files import RunFolderError, read_arrays, sum_of
from analysis.runs.folder import read_record, read_state, sum_in
from analysis.runs.format import CHECKPOINT_FOLDER, STATES_FOLDER, state_file
from yade_scripts.parameters.errors import InputError
from yade_scripts.run.agreement import difference

RECORDER = "recorder.npz"


class CheckpointError(InputError):
    """A checkpoint that can't be used; the message is one line: what, where, what it must be."""


def exists(run_folder):
    """Whether a run folder (its path) holds a checkpoint."""
    return os.path.exists(os.path.join(run_folder, CHECKPOINT_FOLDER, RECORDER))


class Checkpoint:
    """A checkpoint read from a run folder's path.

    .rows (T, columns) of the history, .columns their names, .run as in run.json, .wallTime [s] spent so far, .iteration
    (O.iter), .interval (small steps between samples), .states (number of states written), .scene the file of the scene. Raises CheckpointError when it can't be
    read; what it says is not compared with the other files until require_whole().
    """

    def __init__(self, run_folder):
        self.run_folder = run_folder
        self.folder = os.path.join(run_folder, CHECKPOINT_FOLDER)
        try:
            found = read_arrays(os.path.join(self.folder, RECORDER), ["rows"], texts=["about"])
            self.rows, about = found["rows"], json.loads(found["about"])
            self.run, self.wallTime = about["run"], about["wallTime"]
            self.columns = about.get("columns", [])
            self.scene = os.path.join(self.folder, about["scene"])
            os.stat(self.scene)
            # None: of a version that did not write them, which require_agreement() refuses.
            names = ("iteration", "interval", "states", "sums")
            self.iteration, self.interval, self.states, self._sums = map(about.get, names)
        except (RunFolderError, OSError, ValueError, KeyError, TypeError, AttributeError) as error:
            raise CheckpointError(
                f'{self.folder}: not a checkpoint ({" ".join(str(error).split())}); '
                "must be removed to start the run again"
            ) from None

    def require_agreement(self, kind, parameters, made_with):
        """Raise CheckpointError unless it is of a run with these parameters, and was written by this software.

        made_with: as report.made_with() gives it. The layout of what YADE saves belongs to one build.
        """
        for name, version in (("YADE", "yade"), ("contact_law", "contact_law")):
            written, present = self.run["versions"][version], made_with["versions"][version]
            if written != present:
                self._refuse(f"written by {name} {written}, not {present}")
        if self.run["commit"] != made_with["commit"]:
            self._refuse(f'written by the plugin of commit {self.run["commit"]}, not {made_with["commit"]}')
        differs = difference(kind, parameters, self.run, but=("duration",))
        if differs:
            self._refuse(f"of a run with {differs}")
        history = kind.format.history
        if self.columns != [q.name for q in history if not q.optional or q.name in self.columns]:
            self._refuse("of a history with other columns")

    def require_time_left(self, duration, ended):
        """Raise CheckpointError when the run has come further than the duration [s], or, one that has ended, as far."""
        reached = self.rows[-1][self.columns.index("time")] if len(self.rows) else 0.0
        if reached * (1 + 1e-9 * (1 if ended else -1)) > duration:
            raise CheckpointError(
                f"duration = {duration:.6g} s: the run in {self.run_folder} has come to {reached:.6g} s; must be longer"
            )

    def require_whole(self, kind_format, schedule, fused):
        """Raise CheckpointError unless scene, rows and the states before it are what was written.

        kind_format: analysis.runs.format.RunKind of the states; schedule: of the run; fused: whether an O.step is all
        steps between two samples. Reads the scene and the states once.
        """
        expected = schedule.samples_after(self.iteration or 0, fused)
        if self.rows.shape != (expected, len(self.columns)):
            self._damaged(f"{RECORDER}: rows have the shape {self.rows.shape}", f"({expected}, {len(self.columns)})")
        for name, found in (("rows", sums(self.rows.tobytes())), ("scene", _sums_of_file(self.scene))):
            written = (self._sums or {}).get(name)
            if found != written:
                file = RECORDER if name == "rows" else os.path.basename(self.scene)
                self._damaged(f"{file}: {_text(found)}", f"{_text(written)}, as written")
        for number in range(self.states):
            self._require_state(kind_format, f"{STATES_FOLDER}/{state_file(number)}")

    def load_scene(self):
        """Put the saved scene in the place of YADE's present one."""
        from yade.wrapper import Omega

        Omega().load(self.scene)

    def _require_state(self, kind_format, name):
        file = os.path.join(self.run_folder, name)
        try:
            _, sums = read_record(self.run_folder)
            time = read_state(file, kind_format, sha256=sum_in(sums, self.run_folder, name)).time
        except RunFolderError as error:
            raise CheckpointError(f"{error}; must be in order to resume, or {self.folder} removed") from None
        if not np.isclose(self.rows[:, self.columns.index("time")], time, rtol=1e-12, atol=0).any():
            raise CheckpointError(f"{file}: of {time:g} s; must be of a time of the history up to the checkpoint")

    def _damaged(self, found, wanted):
        raise CheckpointError(f"{self.folder}/{found}; must be {wanted}, or the checkpoint removed to start again")

    def _refuse(self, reason):
        raise CheckpointError(f"{self.folder}: {reason}; must be the same, or removed to start the run again")


def sums(content):
    """[number of bytes, SHA-256] of a buffer."""
    view = memoryview(content).cast("B")
    return [len(view), hashlib.sha256(view).hexdigest()]


def _sums_of_file(path):
    return [os.path.getsize(path), sum_of(path)]


def _text(found):
    return f"{found[0]} bytes, SHA-256 {found[1][:12]}" if found else "no sums"
