"""Every command that writes files, ended or with a full disk at its file-system calls: which, and what must hold afterwards."""

import json
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Callable

import numpy as np

from analysis.runs.files import is_unfinished

COLLIDE = "yade_scripts/collide.py"
# Six steps of a few grains that fly past each other, so that the end is decided; a checkpoint after each, four states.
RUN = ("radius=2", "velocity=30", "impact=1", "duration=1e-10", "states=4", "threads=1", "checkpointInterval=1e-9")
OTHER = ("seed=2",)  # of a run that was in the folder before
RESUME, OVERWRITE = "resume=1", "overwrite=1"
RECORDER = "checkpoint/recorder.npz"
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


def arrays(run):
    """{file: {name: bytes}} of history and states, and the outcome."""
    found = {}
    for file in [run / "history.npz", *sorted((run / "states").glob("*"))]:
        with np.load(file) as archive:
            found[file.name] = {name: archive[name].tobytes() for name in archive.files}
    return found, json.loads((run / "run.json").read_text())["outcome"]


def ended_runs(folder):
    """{path: arrays} of the runs at or below a folder that are marked as ended."""
    return {str(mark.parent.relative_to(folder)): arrays(mark.parent) for mark in Path(folder).rglob("ended")}


@dataclass(frozen=True)
class Command:
    """arguments: of the call that meets the fault; before: of one whose files are there then, for it to replace (None: none are),
    a run that is killed when it has written so many checkpoints (0: it ends); again: of calls afterwards, each alone, which must end
    as without a fault (by default the same call). Called in a folder with the runs `run` and `other`, own.py and t.table, and PROGRAMS on
    PATH. watched: what it writes into, a folder; content: of what must be whole; every: of how many calls one is tried, where there
    are many, or each takes long."""

    name: str
    program: str  # a script's path in the repository, or a module
    arguments: tuple
    before: tuple = None
    checkpoints: int = 0
    again: tuple = ()
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


def _of_collide(name, arguments, again=(), before=None, checkpoints=0):
    """A run in the folder out."""
    place = lambda given: (*given, "out=out")
    before = before and place(before)
    return Command(
        f"collide: {name}", COLLIDE, place(arguments), before, checkpoints, tuple(map(place, again)), content=ended_runs
    )


REPLACE = RUN + (OVERWRITE,)
SCENARIOS = (
    _of_collide("a new run", RUN, [RUN + (RESUME,)]),
    _of_collide("a resumed run", RUN + (RESUME,), before=RUN, checkpoints=3),
    _of_collide(
        "a run that replaces an ended one", REPLACE, [REPLACE, RUN + (RESUME,), REPLACE + (RESUME,)], before=RUN + OTHER
    ),
    _of_collide("a run that replaces a killed one", REPLACE, before=RUN + OTHER, checkpoints=3),
)
COMPRESSION = ("grains=20", "finalFilling=0.2", "strainRate=1e-3", "threads=1", "states=3", RESUME, "out=out")
COMMANDS = (
    *SCENARIOS,
    Command("compress", "yade_scripts/compress.py", COMPRESSION, content=ended_runs),
    Command("collide, sintered", COLLIDE, (*RUN, "neck=0.2", RESUME, "out=out"), content=ended_runs, every=3),
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
# packings/files.py.
WRITERS = {
    "analysis/atlas/adapters/disk.py": "needs DustPy",
    "analysis/atlas/make.py": "analysis.atlas.make",
    "analysis/atlas/outcome_table.py": "analysis.atlas.make",
    "analysis/commands/pictures.py": "analysis plot",
    "analysis/commands/study.py": "analysis study",
    "analysis/export/formats.py": "analysis export",
    "analysis/export/film.py": "analysis film",
    "analysis/export/viewer/__init__.py": "analysis view",
    "analysis/figures/draw.py": "analysis figures",
    "analysis/figures/style.py": "analysis study",
    "analysis/report/pdf.py": "analysis study, where weasyprint or chromium is installed",
    "analysis/runs/running.py": "a temporary file only, for the clock of another machine's disk",
    "analysis/studies/analyse.py": "analysis study",
    "contact_law/installation.py": "install",
    "yade_scripts/packings/files.py": "make_packing",
    "yade_scripts/run/folder.py": "collide",
    "yade_scripts/run/heartbeat.py": "collide",
    "yade_scripts/run/table.py": "study --slurm",
    "yade_scripts/runner/slurm.py": "study --slurm",
    "yade_scripts/runner/batch.py": "study",
}
