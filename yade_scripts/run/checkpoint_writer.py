"""Writes the checkpoints of a running scene; checkpoint.py reads them."""

import json
import mmap
import os
import time

from yade.wrapper import Omega

from analysis.runs.files import npz, sync
from analysis.runs.format import CHECKPOINT_FOLDER
from yade_scripts.run.checkpoint import sums
from yade_scripts.run.written import RECORDER


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
        omega = Omega()
        if self._saved == omega.iter:
            return
        os.makedirs(os.path.join(self.folder.path, CHECKPOINT_FOLDER), exist_ok=True)
        scene, content, rows = f"scene-{omega.iter}.yade", _saved_scene(omega), self.recorder.rows()
        self.folder.write(f"{CHECKPOINT_FOLDER}/{scene}", content)
        about = {
            "run": self.run,
            "wallTime": self.wall_time(),
            "scene": scene,
            "iteration": omega.iter,
            "interval": self.recorder.schedule.interval,
            "states": self.recorder.states_written,
            "sums": {"scene": sums(content), "rows": sums(rows.tobytes())},
            "columns": list(self.recorder.columns),
        }
        self.folder.write(RECORDER, npz(rows=rows, about=json.dumps(about)))
        sync(self.folder.path)
        self.folder.remove_checkpoint(but=(f"{CHECKPOINT_FOLDER}/{scene}", RECORDER))
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
