"""Runs of programs that end, or meet a full disk, at a chosen call that changes their files."""

import json
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

from running import environment
from yade_server import YadeServer

HERE = Path(__file__).parent
# What programs import: once, before they are forked.
MODULES = """contact_law analysis.figures analysis.atlas.model analysis.atlas.outcome_table analysis.atlas.scores analysis.commands.study
analysis.export.film analysis.export.formats analysis.export.viewer yade_scripts.experiments.collision
yade_scripts.experiments.compression yade_scripts.run.checkpoint_writer yade_scripts.run.loop yade_scripts.run.recorder
yade_scripts.run.report yade_scripts.run.scene yade_scripts.run.script""".split()
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
    """A YADE from which programs are forked, with the injector preloaded. folder: for the library and logs."""

    def __init__(self, folder):
        self.folder = Path(folder)
        library = self.folder / "injector.so"
        source = HERE / "injector.c"
        subprocess.run(["gcc", "-shared", "-fPIC", "-O1", "-Wall", "-o", library, source, "-ldl"], check=True)
        more = {
            "LD_PRELOAD": f"{os.environ.get('LD_PRELOAD', '')} {library}",
            "OPENBLAS_NUM_THREADS": "1",
            "SOURCE_DATE_EPOCH": "0",  # which PDF files hold
        }
        self._yade = YadeServer(MODULES, environment(**more))
        self.close = self._yade.close

    def run(self, arguments, watched, call=0, action=COUNT, stop=0):
        """Ended of collide.py with these arguments, in the folder that holds `watched` (the run folder, its changes are
        counted): ended or failing at a call, with SIGTERM before call number `stop` (0: none)."""
        arguments = [*arguments, f"out={Path(watched).name}"]
        return self.call("yade_scripts/collide.py", arguments, watched, call, action, stop)

    def call(self, program, arguments, watched, call=0, action=COUNT, stop=0):
        """The same of a program (a script's path in the repository, or a module as of python3 -m) that writes into `watched`, called
        in the folder that holds it, with what is in its bin."""
        watched, log, output = Path(watched), self.folder / "calls", self.folder / "stdout"
        output.unlink(missing_ok=True)
        request = dict(program=program, arguments=list(arguments), folder=str(watched.parent), watched=str(watched))
        request |= dict(call=call, action=action, stop=stop, log=str(log))
        status = self._yade.run(HERE / "faulted.py", self.folder, arguments=[json.dumps(request)])
        calls = (line.split(" ", 2) for line in log.read_text().splitlines())
        return Ended(
            status,
            tuple(output.read_text().splitlines()),
            tuple(Call(int(number), name, os.path.relpath(path, watched)) for number, name, path in calls),
        )
