"""Every command that writes files, ended or with a full disk at its file-system calls: which, and what must hold afterwards."""

import re
import shutil
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

from faults.forks import DISK_FULL, END_HALFWAY
from faults.scenarios import ACTIONS, OTHER, RESUME, RUN, Case, arrays, wrong_on_a_full_disk

from analysis.atlas.columns import MEASURED
from analysis.atlas.grid import RUNS_FILE
from analysis.runs.table import read_table, table_text
from analysis.runs.write import is_unfinished
from analysis.studies.columns import flat

# A study of one's own, as analysis/STUDIES.md has it, and a table for the runner: what commands read beside runs.
OWN = """
from analysis.studies.collisions import collision_study, outcome_quantities
from analysis.studies.curve_figure import CurveFigure
from analysis.studies.runs import Runs

def quantities(table):
    return outcome_quantities(Runs(table, pair="seed", population=()), by=("velocity",))

STUDY = collision_study(title="T", question="Q?", varied=("velocity", "seed"), quantities=quantities)
FIGURES = (CurveFigure("sticking", "What sticks.", "sticking", x="velocity", logarithmic="x"),)
"""
TABLE = "description {}\na {}\n".format(*(" ".join(words) for words in zip(*(cell.split("=") for cell in RUN))))
# Programs that commands call: a queue of Slurm's in which the one job waits once it has been submitted. (make test-slurm has the real one.)
PROGRAMS = {"sbatch": 'touch "$0.called"; echo 12', "squeue": 'test -e "${0%squeue}sbatch.called" && echo 12_1 PENDING'}


def files_below(folder):
    """{path: bytes} of the files below a folder, but temporary ones and what Python has made of modules."""
    files = (path for path in Path(folder).rglob("*") if path.is_file() and path.suffix != ".pyc")
    named = {str(path.relative_to(folder)): path for path in files}
    return {name: path.read_bytes() for name, path in named.items() if not any(map(is_unfinished, name.split("/")))}


def submitted(folder):
    """{path: bytes} of what was submitted to Slurm: a second call after a fault has a number of its own, and all else is the same."""
    numbered = re.compile(rb"slurm-\d+")
    found = {}
    for path, content in sorted(files_below(folder).items()):
        name, content = numbered.sub(b"slurm-N", path.encode()).decode(), numbered.sub(b"slurm-N", content)
        found[name if found.get(name, content) == content else path] = content
    return found


def ended_runs(folder):
    """{path: arrays} of the runs at or below a folder that are marked as ended."""
    return {str(mark.parent.relative_to(folder)): arrays(mark.parent) for mark in Path(folder).rglob("ended")}


@dataclass(frozen=True)
class Command:
    """arguments: of the call that meets the fault; before: of one whose files are there then, for it to replace (None: none are).
    Called in a folder with the runs `run` and `other`, own.py and t.table, and PROGRAMS on PATH. watched: what it writes into, a folder; content: of what
    must be whole; every: of how many calls one is tried, where there are many, or each takes long."""

    name: str
    program: str  # as fork_server.py has it
    arguments: tuple
    before: tuple = None
    watched: str = "out"
    content: Callable = files_below
    every: int = 1


def _of_analysis(words, before="", every=1):
    """A command of the analysis; before: the run instead of `run` of which it has written the same before."""
    words = tuple(words.split())
    return Command(
        f"analysis {words[0]}",
        "analysis",
        words,
        tuple(before if word == "run" else word for word in words) if before else None,
        every=every,
    )


COMPRESSION = ("grains=20", "finalFilling=0.2", "strainRate=1e-3", "threads=1", "states=3", RESUME, "out=out")
COMMANDS = (
    Command("compress", "yade_scripts/compress.py", COMPRESSION, content=ended_runs),
    Command(
        "collide, sintered",
        "yade_scripts/collide.py",
        (*RUN, "neck=0.2", RESUME, "out=out"),
        content=ended_runs,
        every=3,
    ),
    Command(
        "make_packing",
        "yade_scripts/make_packing.py",
        ("out/a.npz", "out/b.npz", "radius=4"),
        ("out/a.npz", "out/b.npz", "radius=3"),
    ),
    Command("study", "yade_scripts/study.py", ("t.table", "-j1"), watched="runs", content=ended_runs, every=7),
    Command("study --slurm", "yade_scripts/study.py", ("t.table", "--slurm"), watched="runs", content=submitted),
    _of_analysis("export run --format all --out out", "other"),
    _of_analysis("figures run --out out", "other", every=8),
    _of_analysis("view run --out out/view.html", "other"),
    _of_analysis("film run --width 160 --out out/film.mp4", "other"),
    _of_analysis("plot d_max run --out out/plot.png", "other"),
    _of_analysis("study own.py run other --figures out --page out/page.html", "other", every=11),
    _of_analysis("summary --long run"),
    _of_analysis("status run"),
    _of_analysis("verify run"),
    _of_analysis("outcome --velocity 5 --projectile 200 --target 500 --filling 0.15"),
    Command("analysis.atlas.make", "analysis.atlas.make", ("atlas",), watched="atlas", every=4),
    Command("install", "contact_law/installation.py", ("install", "out"), ("install", "out"), every=211),
    Command("uninstall", "contact_law/installation.py", ("uninstall", "out"), ("install", "out"), every=41),
)

# {module that writes files: the row of which command tries it, or why none does}. The scripts of studies write tables and packings by run/table.py and
# packings/packing.py.
WRITERS = {
    "analysis/atlas/adapters/disk.py": "needs DustPy",
    "analysis/atlas/make.py": "analysis.atlas.make",
    "analysis/atlas/outcome_table.py": "analysis.atlas.make",
    "analysis/commands/plot.py": "analysis plot",
    "analysis/commands/study.py": "analysis study",
    "analysis/export/extended_xyz.py": "analysis export",
    "analysis/export/film.py": "analysis film",
    "analysis/export/viewer/__init__.py": "analysis view",
    "analysis/export/vtk_series.py": "analysis export",
    "analysis/figures/draw.py": "analysis figures",
    "analysis/figures/save.py": "analysis study",
    "analysis/report/pdf.py": "analysis study, where weasyprint or chromium is installed",
    "analysis/runs/running.py": "a temporary file only, for the clock of another machine's disk",
    "analysis/studies/analyse.py": "analysis study",
    "analysis/studies/documents/__init__.py": "writes into the repository",
    "contact_law/installation.py": "install",
    "yade_scripts/packings/packing.py": "make_packing",
    "yade_scripts/run/folder.py": "collide",
    "yade_scripts/run/heartbeat.py": "collide",
    "yade_scripts/run/table.py": "study --slurm",
    "yade_scripts/runner/slurm.py": "study --slurm",
    "yade_scripts/runner/batch.py": "study",
}


class Trial:
    """One command in a folder of its own. forks: faults.forks.Forks."""

    def __init__(self, forks, command, folder):
        self._forks, self.command, self._folder = forks, command, Path(folder)
        self._out, self._kept = self._folder / command.watched, self._folder / "before"
        for name, more in (("run", ()), ("other", OTHER)):
            assert forks.run(RUN + more, self._folder / name).status == 0
        (self._folder / "own.py").write_text(OWN)
        (self._folder / "t.table").write_text(TABLE)
        (self._folder / "bin").mkdir()
        for name, line in PROGRAMS.items():
            (self._folder / "bin" / name).write_text(f"#!/bin/sh\n{line}\n")
            (self._folder / "bin" / name).chmod(0o755)
        self._out.mkdir()
        if command.watched == "atlas":
            _part_of_the_atlas(self._out)
        if command.before is not None:
            self._made(command.before)
        shutil.copytree(self._out, self._kept, symlinks=True)
        before = command.content(self._out)
        self.calls = self._made(command.arguments)
        self._whole = before, command.content(self._out)

    def _made(self, arguments):
        """The calls without a fault."""
        done = self._call(arguments)
        assert done.status == 0, done.lines
        return done.calls

    def _call(self, arguments, *fault):
        return self._forks.call(self.command.program, arguments, self._out, *fault)

    def cases(self, every=None):
        """Case of each fault at every so many calls (None: as the command says); halfway only in writes."""
        for call in self.calls[:: every or self.command.every]:
            for fault in ACTIONS:
                if ACTIONS[fault] != END_HALFWAY or call.name in ("write", "sendfile"):
                    yield self._case(call, fault)

    def _case(self, call, fault):
        shutil.rmtree(self._out)
        (self._folder / "bin/sbatch.called").unlink(missing_ok=True)
        shutil.copytree(self._kept, self._out, symlinks=True)
        done = self._call(self.command.arguments, call.number, ACTIONS[fault])
        found, wrong = self.command.content(self._out), []
        half = [path for path in found if found[path] not in [each.get(path) for each in self._whole]]
        wrong += [f"half of {len(half)} files, such as {half[0]}"] if half else []
        if ACTIONS[fault] == DISK_FULL:
            wrong += wrong_on_a_full_disk(done)
        elif done.status != -9:
            wrong.append(f"exit status {done.status}: {done.lines}")
        again = self._call(self.command.arguments)
        while any("is being run by another process" in line for line in again.lines):  # the killed one's workers
            again = self._call(self.command.arguments)
        if self.command.content(self._out) != self._whole[1] or again.status and found != self._whole[1]:
            wrong.append(f"again: exit status {again.status}: {again.lines[-1:]}")
        left = [path.name for path in self._out.rglob("*") if is_unfinished(path.name)]
        return Case(self.command.name, fault, str(call), wrong + ([f"leaves {left}"] if left else []))


def _part_of_the_atlas(folder):
    """A twelfth of its table of runs: the model takes a minute of each call."""
    columns = flat(MEASURED)
    table, head = read_table(RUNS_FILE, columns)
    (folder / "runs.csv").write_text(table_text(table[::12], columns, head))
