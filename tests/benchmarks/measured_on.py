"""On which machine and commit a measurement was taken, and whether the machine was quiet."""

import os
import platform
import subprocess
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
TOP = HERE.parents[1]


def machine():
    """{cpu, cores, commit}; the commit ends in -changed when the work tree differs from it."""
    about = {key.strip(): value.strip() for key, _, value in (line.partition(":") for line in open("/proc/cpuinfo"))}
    clock = float(about.get("cpu MHz", "nan")) / 1000
    cpu = f"{about.get('model name', platform.processor())} (model {about.get('model', '?')}, {clock:.1f} GHz)"
    changed = _git("status", "--porcelain", "--", "contact_law", "yade_scripts") != ""
    commit = _git("rev-parse", "--short", "HEAD") + ("-changed" if changed else "")
    return {"cpu": cpu, "cores": os.cpu_count(), "commit": commit}


def _git(*arguments):
    return subprocess.run(["git", *arguments], cwd=TOP, capture_output=True, text=True).stdout.strip()


def fraction_of_others(seconds=1.0):
    """Fraction of all processors' time [0, 1] that other programs use, while this one only waits."""
    before = _busy()
    time.sleep(seconds)
    return max(0.0, (_busy() - before) / (seconds * os.cpu_count()))


def _busy():
    """Processor seconds used since the machine started: user, nice, system, irq, softirq, steal (proc(5))."""
    ticks = open("/proc/stat").readline().split()[1:]
    return sum(int(ticks[k]) for k in (0, 1, 2, 5, 6, 7)) / os.sysconf("SC_CLK_TCK")
