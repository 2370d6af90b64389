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
    cpu = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo") if line.startswith("model name")), platform.processor())
    commit = subprocess.run(["git", "rev-parse", "--short", "HEAD"], cwd=TOP, capture_output=True, text=True).stdout.strip()
    changed = subprocess.run(["git", "status", "--porcelain", "--", "contact_law", "yade_scripts"], cwd=TOP, capture_output=True, text=True).stdout.strip() != ""
    return {"cpu": cpu, "cores": os.cpu_count(), "commit": commit + ("-changed" if changed else "")}
