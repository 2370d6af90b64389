"""From the paths of a command line to run folders, and where runs come from."""

import os
from collections import Counter
from glob import glob, has_magic
from pathlib import Path

from .format import ENDED_FILE, RUN_FILE

MARKS = RUN_FILE, ENDED_FILE  # of a run folder
LEVELS = 2


def run_folders(paths):
    """[(Path, None)] of the run folders at paths, in folders at most LEVELS below them, or of a pattern ("runs/**") in
    those that it matches, each once; (None, what is wrong) of others. Of several paths (runs/*) some may hold none."""
    found, known, empty = [], set(), []
    for path in paths:
        pattern = has_magic(str(path)) and not os.path.exists(path)
        places = filter(Path.is_dir, map(Path, glob(str(path), recursive=True))) if pattern else [Path(path)]
        try:
            folders = [folder for place in sorted(places) for folder in _inside(place)]
        except PermissionError as error:
            found.append((None, f"{error.filename}: {error.strerror}"))
            continue
        for folder in folders:
            if folder.resolve() not in known:
                known.add(folder.resolve())
                found.append((folder, None))
        if not folders and os.path.exists(path):
            there = f"no run folder ({RUN_FILE}) there, nor in folders up to {LEVELS} levels below"
            empty.append((None, f"{path}: {there}"))
        elif not folders:
            found.append((None, f"{path}: " + ("no run folder matches" if pattern else "no such folder")))
    return found or empty


def _inside(path):
    """Run folders at a path: itself, or those below it, sorted; one that has ended is one without its run.json, too."""
    if any((path / mark).exists() for mark in MARKS):
        return [path]
    levels = ("*/" * level for level in range(1, LEVELS + 1))
    return sorted({file.parent for level in levels for mark in MARKS for file in path.glob(level + mark)})


_COUNTED = {"commits": "commit", "machines": "machine", "versions": "versions", "stepFractions": "step [t0]"}


def provenance(runs):
    """What made the runs (RunFolder): dict of runs (their number), commits, machines, versions and stepFractions [t0]
    (each {text: number of runs}), steps (their sum, as if there were no shorter ones) and hours (of wall time)."""
    return joined(map(_origin, runs))


def _origin(run):
    record, hardware = run.record, run.record.get("hardware") or {}
    commit, *changed = str(record.get("commit", "unknown")).split("-", 1)  # -changed where its files were others
    step, shorter = str(run.parameters.get("stepFraction", "unknown")), run.parameters.get("impactStepFraction")
    texts = {
        "commits": "-".join([commit[:12], *changed]),
        "machines": f"{hardware.get('cpu') or 'unknown processor'}, {hardware.get('cores', '?')} cores",
        "versions": ", ".join(f"{name} {text}" for name, text in (record.get("versions") or {}).items()),
        "stepFractions": step if shorter is None else f"{step} (impact: {shorter})",
    }
    spent = {"steps": int(run.derived.get("steps") or 0), "hours": float(record.get("wallTime") or 0.0) / 3600.0}
    return {"runs": 1, **{key: {text: 1} for key, text in texts.items()}, **spent}


def joined(origins):
    """The same of all the runs of several such dicts."""
    counts, sums = {key: Counter() for key in _COUNTED}, Counter()
    for origin in origins:
        sums.update({key: origin[key] for key in ("runs", "steps", "hours")})
        for key, count in counts.items():
            count.update(origin[key])
    most_first = {key: dict(count.most_common()) for key, count in counts.items()}
    return {"runs": sums["runs"], **most_first, "steps": sums["steps"], "hours": round(sums["hours"], 2)}


def provenance_lines(origin):
    """The same as lines of text."""
    yield f"{origin['runs']} runs; with those replaced {origin['steps']} steps, {origin['hours']:g} h of run time"
    for key, text in _COUNTED.items():
        yield f"{text}: " + "; ".join(f"{name} ({number} runs)" for name, number in origin[key].items())
