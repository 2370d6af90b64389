"""What fraction of its time the engine spends on forces, lists and so on: the harness under perf, one thread, by the names of the functions."""

import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import paper_scenes

# The first that a function's name matches counts; a function that the compiler put into another one counts with that.
PARTS = {
    "lists": r"PairLists|closeGrains|keepLists|sort|reorder|orderGrains|[Nn]eighbour|merge|introselect",
    "forces": r"forces|[Ff]orcePass|bondForces|addOtherForces|drag|slip",
    "events": r"event|addFirstForces|contactStep|form|place",
    "integration": r"integrate|drift|kick",
}
OTHER = "other"


def part_of(function):
    """Name of the part that a function belongs to."""
    return next((part for part, pattern in PARTS.items() if re.search(pattern, function)), OTHER)


def fractions(scene, together, steps):
    """{part: fraction of the samples} of some small steps of a scene's file, or None where perf cannot sample."""
    if not shutil.which("perf"):
        return None
    with tempfile.TemporaryDirectory() as folder:
        data, fifo = str(Path(folder) / "perf.data"), str(Path(folder) / "control")
        os.mkfifo(fifo)
        sampler = ["perf", "record", "-q", "-F", "1999", "--delay=-1", "--control", f"fifo:{fifo}", "-o", data]
        run = [str(paper_scenes.HARNESS), str(scene), f"steps={steps}", f"together={together}", f"warm={together}"]
        if _run(*sampler, *run, f"control={fifo}") is None:
            return None
        report = _run("perf", "report", "-i", data, "--stdio", "--no-children", "--sort", "dso,symbol", "-q")
    return None if report is None else parts_of_report(report)


def _run(*command):
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=600)
    except subprocess.TimeoutExpired:  # a perf that ended at once leaves the harness waiting for its reader
        return None
    return done.stdout if done.returncode == 0 else None


def parts_of_report(report):
    """{part: fraction} of what perf report prints: a fraction, the program or library, the function. None without a sample of the engine."""
    found = dict.fromkeys([*PARTS, OTHER], 0.0)
    for line in report.splitlines():
        match = re.match(r"\s*([\d.]+)%\s+(\S+)\s+\[.\]\s+(.+)", line)
        if match:
            found[part_of(match[3])] += float(match[1])
    whole = sum(found.values())
    return {part: value / whole for part, value in found.items()} if whole else None
