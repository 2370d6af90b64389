"""Where and of what a measurement was taken."""

import os
import platform
import subprocess
from pathlib import Path

HERE = Path(__file__).resolve().parent
TOP = HERE.parents[1]
RESULTS = HERE / "results"


def machine():
    """{cpu, cores, commit}; the commit ends in -changed when the work tree differs from it."""
    about = {key.strip(): value.strip() for key, _, value in (line.partition(":") for line in open("/proc/cpuinfo"))}
    cpu = f"{about.get('model name', platform.processor())} (model {about.get('model', '?')}, {float(about.get('cpu MHz', 'nan')) / 1000:.1f} GHz)"
    commit = subprocess.run(
        ["git", "rev-parse", "--short", "HEAD"], cwd=TOP, capture_output=True, text=True
    ).stdout.strip()
    changed = (
        subprocess.run(
            ["git", "status", "--porcelain", "--", "contact_law", "yade_scripts"],
            cwd=TOP,
            capture_output=True,
            text=True,
        ).stdout.strip()
        != ""
    )
    return {"cpu": cpu, "cores": os.cpu_count(), "commit": commit + ("-changed" if changed else "")}
