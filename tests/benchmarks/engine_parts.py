"""What fraction of its time the engine spends on forces, lists and so on: the harness under perf, one thread, by the names of the functions."""

import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import codes

# The first that a function's name matches counts; what the compiler put into another function counts with that.
PARTS = {
    "lists": r"PairLists|closeGrains|keepLists|sort|reorder|orderGrains|[Nn]eighbour|merge|introselect",
    "forces": r"forces|[Ff]orcePass|bondForces|addOtherForces|drag|slip",
    "eventHandling": r"event|addFirstForces|contactStep|form|place",
    "integration": r"integrate|drift|kick",
}
OTHER = "other"


def fractions(path, together, steps):
    """{part: fraction of the samples} of some small steps of a scene's file; {} where perf cannot sample."""
    if not shutil.which("perf"):
        return {}
    with tempfile.TemporaryDirectory() as folder:
        data, fifo = str(Path(folder) / "perf.data"), str(Path(folder) / "control")
        os.mkfifo(fifo)
        sampler = ["perf", "record", "-q", "-F", "1999", "--delay=-1", "--control", f"fifo:{fifo}", "-o", data]
        try:
            codes.harness(path, sampler, 600, steps=steps, together=together, warm=together, control=fifo)
        except (codes.CodeFailed, subprocess.TimeoutExpired):  # a perf that ended at once leaves the harness waiting
            return {}
        report = ["perf", "report", "-i", data, "--stdio", "--no-children", "--sort", "dso,symbol", "-q"]
        return of_report(subprocess.run(report, capture_output=True, text=True).stdout)


def of_report(report):
    """{part: fraction} of what perf report prints: a fraction, the program or library, the function. {} without a sample of the engine."""
    found = dict.fromkeys([*PARTS, OTHER], 0.0)
    for line in report.splitlines():
        if match := re.match(r"\s*([\d.]+)%\s+(\S+)\s+\[.\]\s+(.+)", line):
            part = next((part for part, pattern in PARTS.items() if re.search(pattern, match[3])), OTHER)
            found[part] += float(match[1])
    whole = sum(found.values())
    return {part: value / whole for part, value in found.items()} if whole else {}
