"""Programs in forks of a YADE that are killed, or find the disk full, at a chosen call that changes their files.

A fork runs this file as a script: sys.argv[1] is JSON, as Forks.call() writes it."""

import errno
import json
import os
import runpy
import signal
import sys
import tempfile
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import count
from pathlib import Path

TOP = os.path.dirname(
    os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0] if __name__ == "__main__" else __file__)))
)
KILLED, DISK_FULL = "killed", "disk full"
OF_PICTURES = ("analysis.figures.draw", "analysis.export.viewer")
COLLIDE = "yade_scripts/collide.py"
RECORDER = "checkpoint/recorder.npz"
# Six steps of a few grains that fly past each other, so that the end is decided; a checkpoint after each, four states.
RUN = ("radius=2", "velocity=30", "impact=1", "duration=1e-10", "states=4", "threads=1", "checkpointInterval=1e-9")
OTHER = ("seed=2",)  # of a run that was in the folder before


@dataclass(frozen=True)
class Call:
    """A call of os that changes files: its number from 1, the function's name, the path from the folder."""

    number: int
    name: str
    path: str


@dataclass(frozen=True)
class Ended:
    """How a program ended: exit status (minus the number of a signal), lines of its output, the calls that it made."""

    status: int
    lines: list
    calls: list


class Forks:
    """A YADE from which programs are forked. folder: for logs."""

    def __init__(self, folder):
        from yade_server import YadeServer

        from yade_scripts.runner.worker import LOADED

        self.folder = Path(folder)
        self._yade = YadeServer([*LOADED, *OF_PICTURES], {**os.environ, "OPENBLAS_NUM_THREADS": "1"})
        self.close = self._yade.close

    def run(self, arguments, run, call=0, fault=KILLED):
        """Ended of collide.py with these arguments into a run folder (Path)."""
        return self.call(COLLIDE, [*arguments, f"out={run.name}"], run.parent, call, fault)

    def call(self, program, arguments, folder, call=0, fault=KILLED):
        """The same of a program (a script's path in the repository, or a module) in a folder; call: number of that
        which fails."""
        request = dict(program=program, arguments=list(arguments), folder=str(folder), call=call, fault=fault)
        (self.folder / "stdout").unlink(missing_ok=True)
        status = self._yade.run(__file__, self.folder, arguments=[json.dumps(request)])
        calls = [line.split(" ", 2) for line in (self.folder / "calls").read_text().splitlines()]
        lines = (self.folder / "stdout").read_text().splitlines()
        return Ended(status, lines, [Call(int(number), name, path) for number, name, path in calls])


@contextmanager
def fast_folder():
    """A temporary folder in memory where there is such a place: fsync is free there."""
    memory = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None
    with tempfile.TemporaryDirectory(dir=memory, ignore_cleanup_errors=True) as folder:
        yield Path(folder)


def arrays(run):
    """{file: {name: bytes}} of history and states, and the outcome."""
    import numpy as np

    found = {"outcome": json.loads((run / "run.json").read_text())["status"]}
    for file in [run / "history.npz", *sorted((run / "states").glob("*.npz"))]:
        with np.load(file) as archive:
            found[file.name] = {name: archive[name].tobytes() for name in archive.files}
    return found


def _make_faulty(folder, call, fault, log):
    """Have this process's calls that change files in a folder counted, and fail from number `call` on."""
    numbers = count(1)

    def faulty(name, real):
        def changed(*arguments, **how):
            path = arguments[-1] if name != "fsync" else os.readlink(f"/proc/self/fd/{arguments[0]}")
            path = os.path.abspath(os.fspath(path))
            if not path.startswith(f"{folder}/"):
                return real(*arguments, **how)
            number = next(numbers)
            print(number, name, os.path.relpath(path, folder), file=log, flush=True)
            if number == call and fault == KILLED:
                os.kill(os.getpid(), signal.SIGKILL)
            if 0 < call <= number and fault == DISK_FULL and name in ("fsync", "link"):
                raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
            return real(*arguments, **how)

        return changed

    for name in ("fsync", "replace", "link", "unlink"):
        setattr(os, name, faulty(name, getattr(os, name)))


if __name__ == "__main__":
    request = json.loads(sys.argv[1])
    os.dup2(1, 2)
    _make_faulty(request["folder"], request["call"], request["fault"], open("calls", "w"))
    os.chdir(request["folder"])
    sys.argv = [os.path.join(TOP, request["program"]), *request["arguments"]]
    if request["program"].endswith(".py"):
        runpy.run_path(sys.argv[0], run_name="__main__")
    else:
        runpy.run_module(request["program"], run_name="__main__", alter_sys=True)
