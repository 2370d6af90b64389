"""Runs of programs that end, or meet a full disk, at a chosen call that changes their files."""

import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parent
# As in injector.c.
COUNT, END_BEFORE, END_HALFWAY, DISK_FULL = range(4)


@dataclass(frozen=True)
class Call:
    """A call that changes files: its number from 1, the function's name, the path relative to the run folder."""

    number: int
    name: str
    path: str

    def __str__(self):
        return f"{self.name} {self.path}"


@dataclass(frozen=True)
class Ended:
    """How a run ended: exit status (minus the number of a signal), lines of its output, the calls that it made."""

    status: int
    lines: tuple
    calls: tuple


class Forks:
    """A YADE from which runs are forked, with the injector preloaded. folder: for the library and logs."""

    def __init__(self, folder):
        self.folder = Path(folder)
        library = self.folder / "injector.so"
        source = HERE / "injector.c"
        subprocess.run(["gcc", "-shared", "-fPIC", "-O1", "-Wall", "-o", library, source, "-ldl"], check=True)
        requests, self._requests = os.pipe()
        self._answers, answers = os.pipe()
        environment = {name: value for name, value in os.environ.items() if name != "YADE_BATCH"}
        self._yade = subprocess.Popen(
            ["yade", "-n", "-x", "-j1", HERE / "fork_server.py", str(requests), str(answers)],
            env={
                **environment,
                "LD_PRELOAD": f"{os.environ.get('LD_PRELOAD', '')} {library}",
                "OPENBLAS_NUM_THREADS": "1",
                "SOURCE_DATE_EPOCH": "0",  # which PDF files hold
            },
            stdin=subprocess.DEVNULL,
            stdout=subprocess.DEVNULL,
            stderr=subprocess.PIPE,
            pass_fds=[requests, answers],
            text=True,
        )
        os.close(requests)
        os.close(answers)
        self._requests, self._answers = os.fdopen(self._requests, "w"), os.fdopen(self._answers)
        if self._answers.readline() != "ready\n":
            raise RuntimeError(f"no run can be forked: {self._yade.communicate()[1]}")

    def run(self, arguments, watched, call=0, action=COUNT, stop=0):
        """Ended of collide.py with these arguments, in the folder that holds `watched` (the run folder, its changes are
        counted): ended or failing at a call, with SIGTERM before call number `stop` (0: none)."""
        return self.call(
            "yade_scripts/collide.py", [*arguments, f"out={Path(watched).name}"], watched, call, action, stop
        )

    def call(self, program, arguments, watched, call=0, action=COUNT, stop=0):
        """The same of a program (as fork_server.py has it) that writes into `watched`, called in the folder that holds it."""
        watched, log, output = Path(watched), self.folder / "calls", self.folder / "output"
        request = dict(
            folder=str(watched.parent),
            program=program,
            arguments=list(arguments),
            watched=str(watched),
            call=call,
            action=action,
            stop=stop,
            log=str(log),
            output=str(output),
        )
        print(json.dumps(request), file=self._requests, flush=True)
        status = int(self._answers.readline())
        calls = (line.split(" ", 2) for line in log.read_text().splitlines())
        return Ended(
            status,
            tuple(output.read_text().splitlines()),
            tuple(Call(int(number), name, os.path.relpath(path, watched)) for number, name, path in calls),
        )

    def close(self):
        """End YADE."""
        self._requests.close()
        self._answers.close()
        self._yade.stderr.close()
        self._yade.wait(timeout=30)
