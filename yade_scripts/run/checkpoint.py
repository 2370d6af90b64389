"""Checkpoints: what a run needs to resume to the same bits after it was stopped or killed.

The folder checkpoint/ of a run holds scene-STEP.yade (O.save: the bodies and the engine's arrays) and recorder.npz (the
history so far, and whose checkpoint this is). recorder.npz names the scene it belongs to and is written after it, so
that at any moment there is one whole checkpoint, or none. The fused engine resumes to the same bits; YADE's own loop may
add up forces in another order after loading, so to rounding.
"""

import json
import os
import shutil
import time
import zipfile

import numpy as np

from analysis.runs.format import CHECKPOINT_FOLDER
from yade_scripts.parameters.errors import InputError
from yade_scripts.run.agreement import difference
from yade_scripts.run.atomic_write import write_atomically

RECORDER = "recorder.npz"


class CheckpointError(InputError):
    """A checkpoint that can't be used; the message is one line: what, where, what it must be."""


def exists(run_folder):
    """Whether a run folder (its path) holds a checkpoint."""
    return os.path.exists(os.path.join(run_folder, CHECKPOINT_FOLDER, RECORDER))


def remove(run_folder):
    """Remove a run folder's checkpoint: recorder.npz first, without which the rest is none."""
    if exists(run_folder):
        os.unlink(os.path.join(run_folder, CHECKPOINT_FOLDER, RECORDER))
    shutil.rmtree(os.path.join(run_folder, CHECKPOINT_FOLDER), ignore_errors=True)


class Checkpoint:
    """A checkpoint read from a run folder's path.

    .rows (T, columns) of the history, .columns their names, .run as in run.json, .wallTime [s] spent so far, .scene the
    file of the scene. Raises CheckpointError when it can't be read.
    """

    def __init__(self, run_folder):
        self.folder = os.path.join(run_folder, CHECKPOINT_FOLDER)
        try:
            with np.load(os.path.join(self.folder, RECORDER)) as file:
                self.rows, about = file["rows"], json.loads(str(file["about"]))
            self.run, self.wallTime = about["run"], about["wallTime"]
            self.columns = about.get("columns", [])
            self.scene = os.path.join(self.folder, about["scene"])
            os.stat(self.scene)
        except (OSError, KeyError, ValueError, zipfile.BadZipFile) as error:
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
        differs = difference(kind, parameters, self.run)
        if differs:
            self._refuse(f"of a run with {differs}")
        history = kind.format.history
        if self.columns != [q.name for q in history if not q.optional or q.name in self.columns]:
            self._refuse("of a history with other columns")

    def load_scene(self):
        """Put the saved scene in the place of YADE's present one."""
        from yade.wrapper import Omega

        Omega().load(self.scene)

    def _refuse(self, reason):
        raise CheckpointError(f"{self.folder}: {reason}; must be the same, or removed to start the run again")


class Writer:
    """Saves the running scene and a recorder's history every `interval` seconds of wall time.

    run: the dictionary of run.json, with parameters, derived, versions and commit; wall_time(): seconds that
    the run has taken, those before earlier interruptions included.
    """

    def __init__(self, run_folder, run, recorder, wall_time, interval):
        self.folder = os.path.join(run_folder, CHECKPOINT_FOLDER)
        self.run, self.recorder, self.wall_time, self.interval = run, recorder, wall_time, interval
        self._next = time.monotonic() + interval

    def save_if_due(self):
        if time.monotonic() >= self._next:
            self.save()

    def save(self):
        """Write a checkpoint; the one before is there until the new one is whole."""
        from yade.wrapper import Omega

        omega = Omega()
        scene = f"scene-{omega.iter}.yade"
        os.makedirs(self.folder, exist_ok=True)
        omega.save(os.path.join(self.folder, scene), True)
        about = {"run": self.run, "wallTime": self.wall_time(), "scene": scene, "columns": list(self.recorder.columns)}
        write_atomically(
            os.path.join(self.folder, RECORDER),
            lambda file: np.savez(file, rows=self.recorder.rows(), about=json.dumps(about)),
        )
        for name in os.listdir(self.folder):
            if name not in (scene, RECORDER):
                os.unlink(os.path.join(self.folder, name))
        self._next = time.monotonic() + self.interval
