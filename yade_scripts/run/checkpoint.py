"""Checkpoints, by which a run that was stopped or killed resumes to the same bits, and with which parameters.

The folder checkpoint/ of a run holds scene-STEP.yade (O.save: the bodies and the engine's arrays) and recorder.npz:
the history so far, and whose checkpoint this is, with the sums of the scene and of the states before it. It is
written after the scene, so that at any moment there is one whole checkpoint, or none. The fused engine resumes to the
same bits; YADE's own loop may add up forces in another order after loading, so to rounding."""

import json
import mmap
import os
import sys
import time
from dataclasses import dataclass

import numpy as np

from analysis.printable import shell_line
from analysis.runs.files import RunFolderError, npz, read_arrays, read_bytes, read_json
from analysis.runs.format import CHECKPOINT_FOLDER, ENDED_FILE, RUN_FILE, same
from yade_scripts.parameters import InputError, ParameterError
from yade_scripts.run.parameters import CORES

RECORDER = f"{CHECKPOINT_FOLDER}/recorder.npz"
CONTINUE = "continue"
OWN = "out", "overwrite", "resume"  # parameters that continue=FOLDER sets


def exists(run_folder):
    """Whether a run folder (its path) holds a checkpoint."""
    return os.path.exists(os.path.join(run_folder, RECORDER))


@dataclass(frozen=True)
class Checkpoint:
    """A checkpoint of a run folder."""

    run_folder: str  # its path
    rows: np.ndarray  # (T, columns) of the history
    columns: list  # their names
    run: dict  # as in run.json
    wallTime: float  # spent so far [s]
    scene: str  # name of the scene's file
    interval: int  # small steps between samples
    states: int  # number of states written
    sums: dict  # {file: SHA-256} of scene and states

    @classmethod
    def read(cls, run_folder):
        """The checkpoint in a run folder; scene and states are not read until require(). Raises InputError."""
        try:
            found = read_arrays(os.path.join(run_folder, RECORDER), ["rows"], texts=["about"])
            return cls(run_folder, found["rows"], **json.loads(found["about"]))
        except (RunFolderError, ValueError, TypeError) as error:
            where = f"{run_folder}/{CHECKPOINT_FOLDER}"
            raise InputError(f"{where}: not a checkpoint ({error}); must be removed to start again") from None

    def require(self, difference, made_with, duration, ended):
        """Raise InputError unless it is of the run that is wanted, written by this software (the layout of what YADE
        saves belongs to one build), as it was written, and has time left.

        difference: of its run from the wanted one (difference()), or None; made_with: as script.made_with() gives it;
        duration: that is wanted [s]; ended: whether the run came to its end, so that it must be longer."""
        where = f"{self.run_folder}/{CHECKPOINT_FOLDER}"
        names = ("yade", "contact_law", "the plugin of commit")
        written, present = ({**made["versions"], names[2]: made["commit"]} for made in (self.run, made_with))
        differing = [name for name in names if written[name] != present[name]]
        reasons = [f"written by {name} {written[name]}, not {present[name]}" for name in differing]
        reasons += [f"of a run with {difference}"] if difference else []
        if reasons:
            raise InputError(f"{where}: {reasons[0]}; must be the same, or removed to start again")
        try:
            for name, digits in self.sums.items():
                read_bytes(os.path.join(self.run_folder, name), digits)
        except RunFolderError as error:
            raise InputError(f"{error}; must be as it was written, or {where} removed") from None
        reached = self.rows[-1][self.columns.index("time")] if len(self.rows) else 0.0
        if reached * (1 + 1e-9 * (1 if ended else -1)) > duration:
            reached = f"the run in {self.run_folder} has come to {reached:.6g} s"
            raise InputError(f"duration = {duration:.6g} s: {reached}; must be longer")


class CheckpointWriter:
    """Saves the running scene and a recorder's history every `interval` seconds of wall time.

    folder: the RunFolder; run: the dictionary of run.json; wall_time(): seconds that the run has taken so far."""

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
        about = {  # the fields of Checkpoint
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
    """The running scene as O.save writes it, in memory: to a full disk O.save would write a part without an error."""
    handle = os.memfd_create("scene")
    try:
        omega.save(f"/proc/self/fd/{handle}", True)
        return mmap.mmap(handle, 0, access=mmap.ACCESS_READ)
    finally:
        os.close(handle)


# ---- which run a folder holds, and with which parameters it goes on: without YADE ----


def difference(kind, wanted, run, but=()):
    """The first parameter in which a run is not what is wanted, 'name = this, not that', or None.

    A parameter that the run doesn't know (an older one) stands under 'derived', or had the value that its Column names.
    A run may be longer than is wanted. A step that is still to be chosen is that of any run that chose it for the same
    tolerance.

    kind: run.kind.Kind; wanted: parameters of that kind; run: as in run.json; but: names that are not compared."""
    there = run.get("kind", "collision")  # format 1 had collisions only
    if there != kind.name:
        return f"kind = {there}, not {kind.name}"
    expected = {**wanted.as_dict(), **kind.expected(wanted, run)}
    columns, held = kind.parameters.columns(), run.get("parameters", {})
    step_is_open = isinstance(wanted.stepFraction, str) and held.get("tolerance") is not None
    left_out = {"stepFraction" if step_is_open else "tolerance", *but}
    for name, column in columns.items():
        if not column.of_consequence or name in left_out:
            continue
        older = column.default if column.before is None else column.before
        value, found = expected[name], held.get(name, run.get("derived", {}).get(name, older))
        longer = name == "duration" and None not in (found, value) and found > value
        if not (same(value, found) or longer):
            return f"{name} = {_text(found)}, not {_text(value)}"
    return None


def _text(value):
    if value is None:
        return "the default"
    return f"{value:.12g}" if isinstance(value, float) else str(value)


def continued(kind, texts):
    """The Kind's parameters of the run in the folder texts["continue"], which resumes.

    texts: {name: text}; what else is given in them must be a duration, or of no consequence. Raises ParameterError."""
    folder, given = texts[CONTINUE], {name: text for name, text in texts.items() if name != CONTINUE}
    columns = kind.parameters.columns()
    for name in given:
        if name in columns and (name in OWN or columns[name].of_consequence and name != "duration"):
            raise ParameterError(f"{name}: given with {CONTINUE} = {folder}, whose own it is; must be left out")
    found = kind.parameters.parse(given)  # only for its checks
    try:
        run = read_json(os.path.join(folder, RUN_FILE))
        held = run["parameters"]
    except (RunFolderError, KeyError, TypeError) as error:
        raise ParameterError(f"{CONTINUE} = {folder}: {error}; must be the folder of a run") from None
    if run.get("kind") != kind.name or set(held) != set(columns):
        must = f"must be a {kind.name} of this version"
        raise ParameterError(f"{CONTINUE} = {folder}: a run of another kind or version; {must}")
    if os.path.exists(os.path.join(folder, ENDED_FILE)) and not exists(folder):
        must = "must be one that was stopped, or is undecided"
        raise ParameterError(f"{CONTINUE} = {folder}: the run has ended, decided; {must}")
    threads = held["threads"] and min(held["threads"], CORES)  # of another machine
    held |= {"threads": threads, **{name: getattr(found, name) for name in given}}
    return kind.parameters(**{**held, "out": folder, "resume": 1, "overwrite": 0})


def command(folder, **changed):
    """The command that continues the run in a folder, as this process was called."""
    words = ["yade", "-n", "-x", sys.argv[0], f"{CONTINUE}={folder}"]
    return shell_line(words + [f"{name}={value:g}" for name, value in changed.items()])
