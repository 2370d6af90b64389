"""Checkpoints: what a run needs to resume to the same bits after it was stopped or killed.

The folder checkpoint/ of a run holds scene-STEP.yade (O.save: the bodies and the engine's arrays) and recorder.npz:
the history so far, and whose checkpoint this is, with the sums of the scene and of the states before it. It is
written after the scene, so that at any moment there is one whole checkpoint, or none. The fused engine resumes to the
same bits; YADE's own loop may add up forces in another order after loading, so to rounding."""

import json
import mmap
import os
import time

from analysis.runs.files import RunFolderError, npz, read_arrays, read_bytes
from analysis.runs.format import CHECKPOINT_FOLDER
from yade_scripts.parameters.errors import InputError

RECORDER = f"{CHECKPOINT_FOLDER}/recorder.npz"


class CheckpointError(InputError):
    """A checkpoint that can't be used; the message is one line: what, where, what it must be."""


def exists(run_folder):
    """Whether a run folder (its path) holds a checkpoint."""
    return os.path.exists(os.path.join(run_folder, RECORDER))


class Checkpoint:
    """A checkpoint read from a run folder's path.

    .rows (T, columns) of the history, .columns their names, .run as in run.json, .wallTime [s] spent so far,
    .interval (small steps between samples), .states (number of states written), .sums {file: SHA-256} of scene and
    states, .scene the name of the scene's file. Raises CheckpointError when it can't be read; scene and states are
    not read until require_whole()."""

    def __init__(self, run_folder):
        self.run_folder, self.folder = run_folder, os.path.join(run_folder, CHECKPOINT_FOLDER)
        try:
            found = read_arrays(os.path.join(run_folder, RECORDER), ["rows"], texts=["about"])
            about = json.loads(found["about"])
            self.rows, self.columns = found["rows"], about.get("columns")
            self.run, self.wallTime, self.interval = about.get("run"), about.get("wallTime"), about.get("interval")
            self.scene, self.states, self.sums = about.get("scene"), about.get("states"), about.get("sums")
        except (RunFolderError, ValueError, AttributeError) as error:
            raise CheckpointError(
                f"{self.folder}: not a checkpoint ({error}); must be removed to start the run again"
            ) from None

    def require_agreement(self, difference, made_with):
        """Raise CheckpointError unless it was written by this software, and is of the run that is wanted.

        difference: of its run from the wanted one (resuming.difference()), or None; made_with: as report.made_with()
        gives it. The layout of what YADE saves belongs to one build."""
        for name, version in (("YADE", "yade"), ("contact_law", "contact_law")):
            written, present = self.run["versions"][version], made_with["versions"][version]
            if written != present:
                self._refuse(f"written by {name} {written}, not {present}")
        if self.run["commit"] != made_with["commit"]:
            self._refuse(f'written by the plugin of commit {self.run["commit"]}, not {made_with["commit"]}')
        if difference:
            self._refuse(f"of a run with {difference}")

    def require_time_left(self, duration, ended):
        """Raise CheckpointError when the run has come further than the duration [s], or, one that has ended, as far."""
        reached = self.rows[-1][self.columns.index("time")] if len(self.rows) else 0.0
        if reached * (1 + 1e-9 * (1 if ended else -1)) > duration:
            raise CheckpointError(
                f"duration = {duration:.6g} s: the run in {self.run_folder} has come to {reached:.6g} s; must be longer"
            )

    def require_whole(self):
        """Raise CheckpointError unless the scene and the states before it are what was written."""
        try:
            for name, digits in self.sums.items():
                read_bytes(os.path.join(self.run_folder, name), digits)
        except RunFolderError as error:
            raise CheckpointError(f"{error}; must be as it was written, or {self.folder} removed") from None

    def load_scene(self):
        """Put the saved scene in the place of YADE's present one."""
        from yade.wrapper import Omega

        Omega().load(os.path.join(self.run_folder, self.scene))

    def _refuse(self, reason):
        raise CheckpointError(f"{self.folder}: {reason}; must be the same, or removed to start the run again")


class CheckpointWriter:
    """Saves the running scene and a recorder's history every `interval` seconds of wall time.

    folder: the RunFolder; run: the dictionary of run.json, with parameters, derived, versions and commit; wall_time():
    seconds that the run has taken, those before earlier interruptions included.
    """

    def __init__(self, folder, run, recorder, wall_time, interval):
        self.folder = folder
        self.run, self.recorder, self.wall_time, self.interval = run, recorder, wall_time, interval
        self._next = time.monotonic() + interval
        self._saved = None  # iteration of the last one

    def save_if_due(self):
        if time.monotonic() >= self._next:
            self.save()

    def save(self):
        """Write a checkpoint, unless this moment's is there; the one before stays until the new one is on the disk."""
        from yade.wrapper import Omega

        omega = Omega()
        if self._saved == omega.iter:
            return
        scene = f"{CHECKPOINT_FOLDER}/scene-{omega.iter}.yade"
        self.folder.write(scene, _saved_scene(omega))
        about = {
            "run": self.run,
            "wallTime": self.wall_time(),
            "scene": scene,
            "interval": self.recorder.schedule.interval,
            "states": self.recorder.states_written,
            "sums": {name: digits for name, digits in self.folder.sums.items() if name == scene or "states/" in name},
            "columns": list(self.recorder.columns),
        }
        self.folder.write(RECORDER, npz(rows=self.recorder.rows(), about=json.dumps(about)))
        self.folder.remove_checkpoint(but=(scene, RECORDER))
        self._saved = omega.iter
        self._next = time.monotonic() + self.interval


def _saved_scene(omega):
    """The running scene as O.save writes it, in memory: to a full disk O.save would write a part and say nothing."""
    handle = os.memfd_create("scene")
    try:
        omega.save(f"/proc/self/fd/{handle}", True)
        return mmap.mmap(handle, 0, access=mmap.ACCESS_READ)
    finally:
        os.close(handle)
