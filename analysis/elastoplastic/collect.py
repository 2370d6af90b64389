"""From the paths of a command line to the run folders of A24's scene that have ended, with a note on each
other."""

from dataclasses import dataclass
from pathlib import Path

from ..run_folder import RunFolderError, open_run

LEVELS = 2
# A24's scene: head-on collisions of CPE aggregates, without drag and bonds.
SCENE = {"packing": "cpe", "impact": 0.0, "viscoelasticTime": 0.0, "neck": 0.0, "planar": 0, "material": "ice"}
_SIZES = ("filling", "radius", "velocity", "seed")


@dataclass(frozen=True)
class Collection:
    """runs (RunFolder, ended, of A24's scene, one of each parameter set), notes (str, one a run left out for
    a good reason) and problems (str, one a path or run that could not be read)."""

    runs: tuple
    notes: tuple
    problems: tuple


def collect(paths):
    """Collection of the run folders at the paths, or in folders at most LEVELS below them."""
    runs, notes, problems, taken = [], [], [], {}
    for path, error in _folders(paths):
        if error:
            problems.append(error)
            continue
        # A run that goes on has perhaps no history yet: it is no broken one.
        if not (path / "ended").is_file():
            notes.append(f"{path}: has not ended, left out")
            continue
        try:
            run = open_run(path)
        except RunFolderError as failure:
            problems.append(str(failure))
            continue
        reason = _foreign(run) or _twin(run, taken)
        if reason:
            notes.append(f"{path}: {reason}, left out")
        else:
            runs.append(run)
    return Collection(tuple(runs), tuple(notes), tuple(problems))


def _folders(paths):
    """(run folder, None) or (None, what is wrong) for every path."""
    for path in map(Path, paths):
        if (path / "run.json").exists():
            yield path, None
            continue
        if not path.is_dir():
            yield None, f"{path}: " + ("is not a folder" if path.exists() else "no such folder")
            continue
        found = []
        for level in range(1, LEVELS + 1):
            found += [file.parent for file in path.glob("*/" * level + "run.json")]
        if not found:
            yield None, f"{path}: no run folder (run.json) there, nor in folders up to {LEVELS} levels below"
        for folder in sorted(found):
            yield folder, None


def _foreign(run):
    """Why a run is no run of A24's scene; None if it is one."""
    for name in _SIZES:
        value = run.parameters.get(name)
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            return f"its parameter {name} is {value!r}, not a number"
    for name, wanted in SCENE.items():
        if run.parameters.get(name, wanted) != wanted:
            return f"{name} = {run.parameters[name]}, A24's scene has {wanted}"
    return None


def _twin(run, taken):
    """Says which earlier run has the same parameters: counted twice it would make errors too small."""
    key = tuple(round(float(run.parameters[name]), 6) for name in _SIZES)
    if key in taken:
        return f"the same filling, radius, velocity and seed as {taken[key]}"
    taken[key] = run.path
    return None
