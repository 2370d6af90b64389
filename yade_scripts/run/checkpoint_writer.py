"""Writes the checkpoints of a running scene; checkpoint.py reads them."""

import json
import mmap
import os
import time

import numpy as np
from yade.wrapper import Omega

from analysis.runs.format import CHECKPOINT_FOLDER
from yade_scripts.run.atomic_write import sync, write_atomically, write_bytes_atomically
from yade_scripts.run.checkpoint import RECORDER, sums


class CheckpointWriter:
    """Saves the running scene and a recorder's history every `interval` seconds of wall time.

    folder: the RunFolder; run: the dictionary of run.json, with parameters, derived, versions and commit; wall_time():
    seconds that the run has taken, those before earlier interruptions included.
    """

    def __init__(self, folder, run, recorder, wall_time, interval):
        self.run_folder, self.folder = folder, os.path.join(folder.path, CHECKPOINT_FOLDER)
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
        self.run_folder.sync()
        scene = f"scene-{omega.iter}.yade"
        os.makedirs(self.folder, exist_ok=True)
        content, rows = _saved_scene(omega), self.recorder.rows()
        write_bytes_atomically(os.path.join(self.folder, scene), content, lasting=True)
        about = {
            "run": self.run,
            "wallTime": self.wall_time(),
            "scene": scene,
            "iteration": omega.iter,
            "states": self.recorder.states_written,
            "sums": {"scene": sums(content), "rows": sums(rows.tobytes())},
            "columns": list(self.recorder.columns),
        }
        write_atomically(
            os.path.join(self.folder, RECORDER),
            lambda file: np.savez(file, rows=rows, about=json.dumps(about)),
            lasting=True,
        )
        sync(self.run_folder.path)
        for name in os.listdir(self.folder):
            if name not in (scene, RECORDER):
                os.unlink(os.path.join(self.folder, name))
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
