"""From the paths of a command line to run folders, tables of runs, and what is wrong with the others."""

import os
from dataclasses import dataclass
from glob import glob, has_magic
from pathlib import Path

from .files import RunFolderError
from .folder import open_run
from .format import COLLISION, ENDED_FILE, HISTORY_FILE, RUN_FILE, STATES_FOLDER
from .table import ENDING

MARKS = RUN_FILE, ENDED_FILE  # of a run folder
LOST = f"holds what a run has left, and neither {' nor '.join(MARKS)}; must have both"
LEVELS = 2


@dataclass(frozen=True)
class Scene:
    """Which runs belong together: its name (as in "A24's scene"), the parameters that every run has (`values`), those
    that must be numbers (`numbers`), what else a study measures that tells runs apart (`measured`: names of its columns;
    two runs with the same numbers of both are the same run) and the kind of run."""

    name: str
    values: dict
    numbers: tuple
    kind: str = COLLISION.name
    measured: tuple = ()

    @property
    def key(self):
        """Columns whose numbers two runs must not share."""
        return self.numbers + self.measured

    def why_not(self, run):
        """Why a RunFolder is no run of this scene; None if it is one."""
        if run.kind.name != self.kind:
            return f"it is a run of the kind {run.kind.name}, {self.name} is {self.kind}"
        for name in self.numbers:
            value = run.settled.get(name)
            if isinstance(value, bool) or not isinstance(value, (int, float)):
                return f"its parameter {name} is {value!r}, not a number"
        for name, wanted in self.values.items():
            if run.parameters.get(name, wanted) != wanted:
                return f"{name} = {run.parameters[name]}, {self.name} has {wanted}"
        return None


@dataclass(frozen=True)
class Collection:
    """runs (RunFolder, ended, of the scene), tables (Path of each file with runs of an earlier analysis), notes (str, one
    a run left out for a good reason) and problems (str, one a path or run that could not be read)."""

    runs: tuple
    tables: tuple
    notes: tuple
    problems: tuple


def collect(paths, scene):
    """Collection of the run folders at the paths, or in folders at most LEVELS below them, and of tables (.csv)."""
    runs, tables, notes, problems = [], [], [], []
    for path, error in _folders(paths):
        if error:
            problems.append(error)
        elif path.suffix == ENDING and path.is_file():
            tables.append(path)
        elif not (path / ENDED_FILE).is_file():
            # A run that is under way has perhaps no history yet: it is no broken one.
            notes.append(f"{path}: has not ended, left out")
        else:
            try:
                run = open_run(path)
            except RunFolderError as failure:
                problems.append(str(failure))
                continue
            reason = scene.why_not(run)
            if reason:
                notes.append(f"{path}: {reason}, left out")
            else:
                runs.append(run)
    return Collection(tuple(runs), tuple(tables), tuple(notes), tuple(problems))


def _folders(paths):
    """(run folder or table, None) or (None, what is wrong) for every path."""
    for path in map(Path, paths):
        if path.suffix == ENDING and path.is_file():
            yield path, None
        else:
            yield from run_folders([path])


def run_folders(paths):
    """[(Path of a run folder, None) or (None, what is wrong)] of every path: the path itself, or folders at most LEVELS below
    it; of a pattern ("runs/**") the same of all folders that it matches. Each folder comes once. Of several paths (runs/*) some
    may hold no runs (runs/logs)."""
    found, seen, empty = [], set(), []
    for path in paths:
        pattern = has_magic(str(path)) and not os.path.exists(path)
        places = filter(Path.is_dir, map(Path, glob(str(path), recursive=True))) if pattern else [Path(path)]
        try:
            folders = [folder for place in sorted(places) for folder in _inside(place)]
        except PermissionError as error:
            found.append((None, f"{error.filename}: {error.strerror}"))
            continue
        new = [folder for folder in dict.fromkeys(folders) if folder.resolve() not in seen]
        seen.update(folder.resolve() for folder in folders)
        found += [(folder, None) for folder in new]
        if not folders and os.path.exists(path):
            empty.append((None, f"{path}: {_nothing(Path(path))}"))
        elif not folders:
            found.append((None, f"{path}: " + ("no run folder matches" if pattern else "no such folder")))
    return found or empty


def _inside(path):
    """Run folders at a path: itself, or those below it, sorted; one that has ended is one without its run.json, too."""
    if _is_marked(path):
        return [path]
    levels = ("*/" * level for level in range(1, LEVELS + 1))
    return sorted({file.parent for level in levels for mark in MARKS for file in path.glob(level + mark)})


def _is_marked(path):
    return any((path / mark).exists() for mark in MARKS)


def is_lost(path):
    """Whether a folder holds what a run has left, and neither of MARKS."""
    return any((path / left).exists() for left in (HISTORY_FILE, STATES_FOLDER)) and not _is_marked(path)


def _nothing(path):
    if not path.is_dir():
        return "is not a folder"
    return f"no run folder ({RUN_FILE}) there, nor in folders up to {LEVELS} levels below"
