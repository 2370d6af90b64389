"""Runs the scripts as a user does."""

import json
import os
import signal
import subprocess
import tempfile
import time
from pathlib import Path

import numpy as np
from yade_server import YadeServer

from yade_scripts.runner.worker import LOADED

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
SCRIPTS = os.path.join(TOP, "yade_scripts")
STUDIES = os.path.join(SCRIPTS, "studies")
COLLIDE, COMPRESS, STUDY = (os.path.join(SCRIPTS, name) for name in ("collide.py", "compress.py", "study.py"))
PYTHON = "/usr/bin/python3"  # the one that YADE runs in
TINY = ("radius=4", "velocity=30", "duration=15e-9")  # 2 x 26 grains that meet after some 7 ns


def environment(**more):
    """This process's, without what would choose a table's row."""
    return {name: value for name, value in os.environ.items() if name != "YADE_BATCH"} | more


def hear_ctrl_c():
    """As in a terminal: what a shell starts in the background ignores Ctrl-C, and so would the tests' processes."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def start(folder, *command, **options):
    """A process in a folder that writes to pipes."""
    pipes = dict(stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, env=environment(), preexec_fn=hear_ctrl_c)
    return subprocess.Popen(command, cwd=folder, **{**pipes, **options})


def call(folder, *command, **more):
    """The same, finished: what subprocess.run returns. more: of its environment."""
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, env=environment(**more), timeout=120)


# As in a row of a study: YADE and what runs need are loaded once.
OF_RUNS = YadeServer(LOADED, environment())


def forked(folder, script, *arguments, server=OF_RUNS):
    """The same of `yade -n -x script arguments`, but in a fork of a YADE that has started; SERVER's has loaded nothing
    else."""
    with tempfile.TemporaryDirectory() as output:
        status = server.run(script, folder, 120, arguments, output)
        printed = [(Path(output) / name).read_text() for name in ("stdout", "stderr")]
    return subprocess.CompletedProcess((script, *arguments), status, *printed)


def collide(folder, *arguments):
    return forked(folder, COLLIDE, *arguments)


def completed(folder, *arguments, script=COLLIDE):
    """(run.json, history) of a run, in the folder run, that comes to its end and has nothing to say. The folder is
    made if need be."""
    os.makedirs(folder, exist_ok=True)
    done = forked(folder, script, *arguments, "out=run")
    assert done.returncode == 0 and messages(done) == [], done.stderr
    return read_json(folder, "run", "run.json"), read_arrays(folder, "run", "history.npz")


def study(folder, *arguments):
    return call(folder, PYTHON, STUDY, *arguments)


def make_packing(folder, *arguments):
    return call(folder, PYTHON, os.path.join(SCRIPTS, "make_packing.py"), *arguments)


def messages(process):
    """What was written to stderr but for the two lines that YADE itself writes at each start."""
    return [
        line for line in process.stderr.splitlines() if not line.startswith(("TCP python prompt on", "Running script"))
    ]


def refusal(process):
    """The one line with which a process ended for a wrong parameter."""
    lines = messages(process)
    assert process.returncode == 2 and len(lines) == 1, (process.returncode, lines)
    return lines[0]


def wait_for(condition, seconds=60):
    deadline = time.monotonic() + seconds
    while not condition():
        assert time.monotonic() < deadline, "waited in vain"
        time.sleep(0.002)


def process_writing(folder):
    """The process that holds a run folder's lock."""
    inode = str(os.stat(folder).st_ino)
    with open("/proc/locks") as locks:
        held = (lock.split() for lock in locks if "->" not in lock)
        return next((int(lock[4]) for lock in held if lock[5].endswith(":" + inode)), None)


def stop_midway(folder, arguments, number=signal.SIGKILL, script=COLLIDE, after=0.0):
    """The process of a run, in the folder run, that was sent a signal `after` seconds after its first checkpoint,
    before its end."""
    process = start(folder, "yade", "-n", "-x", script, *arguments, "out=run")
    checkpoint = folder / "run" / "checkpoint" / "recorder.npz"
    wait_for(lambda: checkpoint.exists() or process.poll() is not None)
    time.sleep(after)
    process.send_signal(number)
    process.output, process.errors = process.communicate(timeout=60)
    assert checkpoint.exists() and not (folder / "run" / "ended").exists(), process.errors
    return process


def arrays(folder):
    """{file: {name: array}} of a run folder."""
    names = ["history.npz"] + [os.path.join("states", name) for name in sorted(os.listdir(folder / "states"))]
    return {name: read_arrays(folder, name) for name in names}


def states(folder):
    """[{name: array}] of a run folder's states, in their order."""
    return [read_arrays(folder, "states", name) for name in sorted(os.listdir(folder / "states"))]


def same_bits(one, other):
    """Whether two run folders hold the same files with the same arrays."""
    one, other = arrays(one), arrays(other)
    return one.keys() == other.keys() and all(
        one[name].keys() == other[name].keys()
        and all(one[name][key].tobytes() == other[name][key].tobytes() for key in one[name])
        for name in one
    )


def read_json(*path):
    with open(os.path.join(*path)) as file:
        return json.load(file)


def read_arrays(*path):
    with np.load(os.path.join(*path), allow_pickle=False) as file:
        return dict(file)
