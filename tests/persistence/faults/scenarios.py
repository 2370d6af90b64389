"""What is done to runs at each of their file-system calls, and what must hold afterwards."""

import json
import shutil
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from faults.forks import COUNT, DISK_FULL, END_BEFORE, END_HALFWAY

# Six steps of a few grains that fly past each other, so that the end is decided; a checkpoint after each, four states.
RUN = ("radius=2", "velocity=30", "impact=1", "duration=1e-10", "states=4", "threads=1", "checkpointInterval=1e-9")
OTHER = ("seed=2",)  # of a run that was in the folder before
RESUME, OVERWRITE = "resume=1", "overwrite=1"
ACTIONS = {"ends before": END_BEFORE, "ends halfway": END_HALFWAY, "disk full from": DISK_FULL}
STOPPED = 143
RECORDER = "checkpoint/recorder.npz"


@dataclass(frozen=True)
class Scenario:
    """before: arguments of the run that is in the folder at first (None: there is no folder), which is killed when it has
    written so many checkpoints (0: it ends). arguments: of the run that meets the fault; again: those that are called
    afterwards, each alone, and must end with the bits of a run without faults."""

    name: str
    arguments: tuple
    again: tuple
    before: tuple = None
    before_checkpoints: int = 0


SCENARIOS = (
    Scenario("a new run", RUN, (RUN + (RESUME,),)),
    Scenario("a resumed run", RUN + (RESUME,), (RUN + (RESUME,),), before=RUN, before_checkpoints=3),
    Scenario(
        "a run that replaces an ended one",
        RUN + (OVERWRITE,),
        (RUN + (OVERWRITE,), RUN + (RESUME,), RUN + (RESUME, OVERWRITE)),
        before=RUN + OTHER,
    ),
    Scenario(
        "a run that replaces a killed one",
        RUN + (OVERWRITE,),
        (RUN + (OVERWRITE,),),
        before=RUN + OTHER,
        before_checkpoints=3,
    ),
)


@dataclass
class Case:
    """One fault: at which call of which scenario, and what was wrong afterwards (nothing: "")."""

    scenario: str
    fault: str
    call: str
    wrong: list = field(default_factory=list)


def arrays(run):
    """{file: {name: bytes}} of history and states, and the outcome."""
    found = {}
    for file in [run / "history.npz", *sorted((run / "states").glob("*"))]:
        with np.load(file) as archive:
            found[file.name] = {name: archive[name].tobytes() for name in archive.files}
    return found, json.loads((run / "run.json").read_text())["outcome"]


def checkpoint_rows(run):
    """Number of rows in a run folder's checkpoint; 0 without one."""
    if not (run / RECORDER).exists():
        return 0
    with np.load(run / RECORDER) as archive:
        return len(archive["rows"])


class Bench:
    """Tries faults. forks: faults.forks.Forks; folder: for run folders."""

    def __init__(self, forks, folder):
        self.forks, self.folder = forks, Path(folder)
        self.straight = {}  # {arguments of the scene: arrays}
        for more in ((), OTHER):
            run = self.folder / "straight"
            done = forks.run(RUN + more, run)
            assert done.status == 0, done.lines
            self.straight[RUN + more] = arrays(run)
            shutil.rmtree(run)
        self._before = {}

    def calls(self, scenario):
        """The calls of a scenario's run without a fault."""
        run = self._prepared(scenario)
        done = self.forks.run(scenario.arguments, run)
        assert done.status == 0, done.lines
        return done.calls

    def case(self, scenario, fault, call, stop=0):
        """Case of a fault at a Call; stop: SIGTERM before the call of that number."""
        run = self._prepared(scenario)
        rows = checkpoint_rows(run) if RESUME in scenario.arguments else 1
        done = self.forks.run(scenario.arguments, run, call.number, ACTIONS[fault], stop)
        text = f"{call.number} {_plain(call)}" + (f", SIGTERM before {stop}" if stop else "")
        case = Case(scenario.name, fault, text)
        if ACTIONS[fault] == DISK_FULL:
            case.wrong += wrong_on_a_full_disk(done)
        elif done.status != -9 and not (stop and done.status == STOPPED):  # stopped before that call
            case.wrong.append(f"exit status {done.status}: {done.lines}")
        renamed = sum(c.name == "rename" and c.path == RECORDER for c in done.calls[: call.number - 1])
        if renamed and not (run / "ended").exists() and checkpoint_rows(run) < rows + renamed:
            case.wrong.append(f"checkpoint of {checkpoint_rows(run)} rows, there was one of {rows + renamed}")
        for arguments in scenario.again:
            case.wrong += self._afterwards(scenario, run, arguments)
        return case

    def _prepared(self, scenario):
        """A run folder as it is before the scenario's run."""
        run = self.folder / "run"
        shutil.rmtree(run, ignore_errors=True)
        if scenario.before is None:
            return run
        if scenario.name not in self._before:
            made = self.folder / f"before-{len(self._before)}"
            call = 0
            if scenario.before_checkpoints:
                calls = self.forks.run(scenario.before, run).calls
                call = [c.number for c in calls if c.name == "rename" and c.path == RECORDER]
                call = call[scenario.before_checkpoints - 1] + 1
                shutil.rmtree(run)
            self.forks.run(scenario.before, run, call, END_BEFORE if call else COUNT)
            shutil.move(run, made)
            self._before[scenario.name] = made
        return Path(shutil.copytree(self._before[scenario.name], run))

    def _afterwards(self, scenario, faulted, arguments):
        """What is wrong when the run is called again with these arguments."""
        run = self.folder / "again" / "run"
        shutil.rmtree(run, ignore_errors=True)
        run.parent.mkdir(exist_ok=True)
        if faulted.exists():
            shutil.copytree(faulted, run)
        called = " ".join(a for a in arguments if a in (RESUME, OVERWRITE)) or "again"
        if (run / "ended").exists():
            whole = [key for key in self.straight if arrays(run) == (*self.straight[key][:1], "completed")]
            if not whole:
                return ["marked as ended, with other arrays"]
            if OVERWRITE not in arguments:
                return []  # refused, as it must be
        done = self.forks.run(arguments, run)
        if done.status:
            return [f"{called}: exit status {done.status}: {done.lines[-1] if done.lines else ''}"]
        left = sorted(path.name for path in run.iterdir())
        if left != ["ended", "history.npz", "run.json", "states"]:
            return [f"{called}: leaves {left}"]
        return [] if arrays(run) == self.straight[RUN] else [f"{called}: other arrays"]


def wrong_on_a_full_disk(done):
    """What is wrong unless a program said so in one line and its status, or had nothing left to write."""
    full = [line for line in done.lines if "No space left on device" in line and not line.startswith("run folder: ")]
    if done.status == 0 and not full:
        return []
    untidy = [line for line in done.lines if line.startswith("Traceback")]
    right = done.status in (1, 2) and len(full) == 1 and not untidy
    return [] if right else [f"exit status {done.status}, {len(full)} lines: {done.lines[-1:]}"]


def _plain(call):
    """A call without the random part of temporary names."""
    parts = call.path.split("/")
    if parts[-1].endswith(".unfinished"):
        parts[-1] = ".".join(parts[-1].split(".")[:-2] + ["*", "unfinished"])
    return f"{call.name} {'/'.join(parts)}"


def enumerated(bench, scenario, faults=tuple(ACTIONS), every=1, offset=0):
    """Case of each fault at each call of a scenario (or every so many); halfway only in writes."""
    for call in bench.calls(scenario)[offset::every]:
        for fault in faults:
            if ACTIONS[fault] != END_HALFWAY or call.name == "write":
                yield bench.case(scenario, fault, call)


def enumerated_stops(bench, checkpoint, every=1):
    """Case of SIGTERM before each call of one checkpoint of a new run, and SIGKILL at each call from there on to the
    next checkpoint's end (or at every so many of these pairs)."""
    scenario = SCENARIOS[0]
    calls = bench.calls(scenario)
    ends = [c.number for c in calls if c.name == "rename" and c.path == RECORDER]
    first, last = ends[checkpoint - 1] + 1, ends[checkpoint]
    pairs = [(stop, number) for stop in range(first, last + 1) for number in range(stop, last + 25)]
    for stop, number in pairs[::every]:
        yield bench.case(scenario, "ends before", calls[number - 1], stop)


def power_loss(calls):
    """What a power loss could take although it must not, in words (nothing: []), from the calls of a run.

    Of files that were written, and names that were made, without an fsync since, nothing may be counted on. So all must
    be on the disk before `ended` gets its name, scene and states before recorder.npz gets its, and recorder.npz before
    an older scene goes. A heartbeat says nothing of a run that a power loss has ended.
    """
    content, names, wrong = set(), set(), []  # without fsync
    for call in (call for call in calls if "heartbeat" not in call.path):
        folder, _, file = call.path.rpartition("/")
        if call.name == "write":
            content.add(call.path)
        elif call.name == "fsync":
            content.discard(call.path)
            names = {name for name in names if (name.rpartition("/")[0] or ".") != call.path}
        elif call.name == "rename":
            temporary = {path for path in content if path.startswith(f"{folder}/.{file}.".lstrip("/"))}
            own = {call.path} if temporary else set()
            content = content - temporary | own
            if call.path in ("ended", RECORDER):
                wrong += [f"{path} at the renaming of {call.path}" for path in sorted(content | names - {call.path})]
            names.add(call.path)
        elif call.name == "unlink":
            content.discard(call.path)
        if call.name == "unlink" and file.startswith("scene-"):
            wrong += [f"{path} at the removal of {call.path}" for path in sorted(content | names) if path == RECORDER]
    return wrong
