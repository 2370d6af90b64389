"""Runs the scripts as a user does."""

import json
import os
import subprocess

import numpy as np

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
COLLIDE = os.path.join(TOP, "yade_scripts", "collide.py")
RUN_TABLE = os.path.join(TOP, "yade_scripts", "run_table.py")
PYTHON = "/usr/bin/python3"  # the one that YADE runs in
TINY = ("radius=4", "velocity=30", "duration=15e-9")  # 2 x 26 grains that meet after some 7 ns


def environment(**more):
    """This process's, without what would choose a table's row."""
    return {name: value for name, value in os.environ.items() if name != "YADE_BATCH"} | more


def collide(folder, *arguments, **more):
    """yade -n -x collide.py arguments, in a folder; the finished process."""
    return subprocess.run(
        ["yade", "-n", "-x", COLLIDE, *arguments],
        cwd=folder,
        capture_output=True,
        text=True,
        env=environment(**more),
        timeout=60,
    )


def collided(folder, *arguments):
    """The same of a run that must come to its end."""
    done = collide(folder, *arguments)
    assert done.returncode == 0, done.stderr
    return done


def messages(process):
    """What was written to stderr but for the two lines that YADE itself writes at each start."""
    return [
        line for line in process.stderr.splitlines() if not line.startswith(("TCP python prompt on", "Running script"))
    ]


def read_json(*path):
    with open(os.path.join(*path)) as file:
        return json.load(file)


def read_arrays(*path):
    with np.load(os.path.join(*path), allow_pickle=False) as file:
        return dict(file)
