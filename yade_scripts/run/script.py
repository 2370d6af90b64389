"""A run from its parameters to its run folder: what a script of a kind of run calls."""

import os
import platform
import signal
import sys
import time
from contextlib import suppress
from functools import cache

import numpy as np

from analysis.printable import printable
from analysis.progress import tqdm
from analysis.runs.files import RunFolderError
from analysis.runs.folder import settings
from analysis.version import version_text
from yade_scripts.parameters import InputError, ParameterError, one_line, one_line_errors, show, tell
from yade_scripts.run import checkpoint
from yade_scripts.run.folder import RunFolder
from yade_scripts.run.kind import Schedule, derived
from yade_scripts.run.parameters import gather
from yade_scripts.time_step import AUTO, require_countable


def main(kind, description):
    """Run the parameters of the command line or of yade-batch, and end the process; called within YADE.

    kind: run.kind.Kind; description: what --help prints before the parameters."""
    begun = time.monotonic()
    script = os.path.basename(sys.argv[0])
    if "--help" in sys.argv[1:]:
        show(f"{description}\n{kind.parameters.help_text()}")
        sys.exit(0)
    if "--version" in sys.argv[1:]:
        print(f"{script} {version_text()}")
        sys.exit(0)
    with one_line_errors(script):
        if "yade" not in sys.modules:
            raise InputError(f"must be run by YADE: yade -n -x {sys.argv[0]} velocity=3, say")
        texts, row = gather(sys.argv[1:], kind)
        parameters = checkpoint.continued(kind, texts) if checkpoint.CONTINUE in texts else kind.parse(texts, row)
        from yade.wrapper import Omega

        import contact_law  # noqa: F401  (the plugin, before its classes are needed)

        scene = kind.prepare(parameters, Omega().numThreads)
        if scene.parameters.stepFraction == AUTO:
            raise ParameterError(f"stepFraction = {AUTO}: not measured for this kind of run; must be a number [t0]")
        require_countable(scene.parameters.duration, scene.time_step)
        folder, schedule = _open(kind, scene)
    try:
        status = _carry_out(kind, scene, schedule, folder, begun)
    finally:
        folder.close()
    sys.exit(status)


def _open(kind, scene):
    """The run folder, with its checkpoint if the run resumes from one, and the Schedule."""
    given = scene.parameters
    folder = RunFolder(given.out, given.overwrite, given.resume)
    saved = folder.checkpoint
    interval = saved.interval if saved else None
    schedule = Schedule.of(given.duration, scene.time_step, scene.interval, states=given.states, kept=interval)
    try:
        if saved:
            difference = checkpoint.difference(kind, given, saved.run, but=("duration",))
            saved.require(difference, made_with(), schedule.steps * scene.time_step, folder.has_ended())
            folder.resume()
    except BaseException:
        folder.close()
        raise
    return folder, schedule


def _carry_out(kind, scene, schedule, folder, begun):
    """Step the scene to its end and write the run folder; the exit status."""
    from yade_scripts.run import scene as yade_scene
    from yade_scripts.run.recorder import Recorder

    parameters, saved = scene.parameters, folder.checkpoint
    begun -= saved.wallTime if saved else 0.0  # before interruptions
    run = record_of(kind.name, parameters.as_dict(), derived(scene, schedule), made_with())
    wall_time = lambda: time.monotonic() - begun
    write = lambda status: folder.write_run({**run, "wallTime": wall_time(), "status": status})
    recorder, ending = Recorder(folder, schedule, kind.format, scene), None
    try:
        if saved:
            recorder.resume(saved.rows, saved.columns, saved.states)
            steps, runner, begin = yade_scene.resume(scene, schedule, recorder, saved)
        else:
            steps, runner, begin = yade_scene.start(scene, schedule, recorder)
        write("running")  # which a killed run keeps
        print(f"{kind.name}: {settings(run['parameters'], run['derived'])}", flush=True)
        if scene.step_choice != "as given":
            print(f"step: {scene.step_choice}", flush=True)
        if moved := scene.derived.get("largestMotion"):
            print(f"at rest: grains were moved by up to {moved / parameters.grainRadius:.2g} grain radii", flush=True)
        writer = checkpoint.CheckpointWriter(folder, run, recorder, wall_time, parameters.checkpointInterval)
        status, code = _step(steps, recorder, runner, begin, writer)
        recorder.write_history()
        if status == "completed":
            ending, run["endedBy"] = kind.ending(folder.path), scene.ended_by(recorder)
        if ending:
            run["outcome"] = ending.outcome
        if ending and ending.why_undecided:
            writer.save()
    except (OSError, RuntimeError, RunFolderError) as error:  # a folder's, or a scene's that YADE can't load
        status, code = f"failed: {one_line(error)}", 1
    run["timeReached"] = recorder.time
    try:
        write(status)
        if status == "completed":
            folder.write_ended()
    except OSError as error:
        if not status.startswith("failed"):
            status, code = f"failed: {one_line(error)}", 1
            with suppress(OSError):
                write(status)
    if status == "completed" and not (ending and ending.why_undecided):
        with suppress(OSError):
            folder.remove_checkpoint()
    _print_end(folder.path, run, status, ending, wall_time())
    return code


def record_of(name, parameters, derived, made):
    """What run.json holds before the run; name: of the kind of run; made: as made_with() gives it."""
    return {
        "kind": name,
        "parameters": parameters,
        "derived": derived,
        "seed": parameters.get("seed"),
        **made,
        "hardware": hardware(),
        "endedBy": None,
        "outcome": None,  # until it has come to its end
    }


def _step(steps, recorder, runner, begin, writer):
    """Call begin(), and step until that many O.steps are taken or the scene is at its end; (status, exit status).

    Ctrl-C and SIGTERM end the run after the step that is being taken, with a checkpoint and one more step that records
    where it stopped (runner samples it); the status is then "interrupted"."""
    from yade.wrapper import Omega

    omega, stop = Omega(), StopSignals()
    tqdm.monitor_interval = 0  # no thread of its own
    progress = tqdm(total=steps, initial=omega.iter, disable=None, leave=False, unit="step", mininterval=0.5)
    try:
        begin()
        for step in range(omega.iter + 1, steps + 1):
            omega.step()
            progress.update()
            if recorder.error:
                return f"failed: {one_line(recorder.error)}", 1
            if recorder.finished:
                break
            writer.save_if_due()
            if stop.received and step < steps:
                writer.save()
                recorder.ending, runner.iterPeriod = True, 1
                omega.step()
                return "interrupted", 128 + stop.received
    except (RuntimeError, OSError) as error:  # from an engine, or a checkpoint that can't be written
        recorder.write_last_good()
        return f"failed: {one_line(error)}", 1
    finally:
        progress.close()
        stop.restore()
    return "completed", 0


def _print_end(path, run, status, ending, seconds):
    """The last lines of a log, and one on stderr for a failure; neither when it can't be written."""
    if status.startswith("failed"):
        tell(status)
    try:
        if run["endedBy"]:
            print(f"ended by {run['endedBy']}")
        if ending:
            print(f"outcome {ending.outcome}: {ending.why_undecided or ending.words}")
        if ending and ending.why_undecided:
            print(f"to continue: {checkpoint.command(path, duration=2 * run['parameters']['duration'])}")
        if status == "interrupted":
            print(f"to continue: {checkpoint.command(path)}")
        print(f"run folder: {printable(path)} ({printable(status)}, {seconds:.1f} s)", flush=True)
    except OSError:  # what is left in the buffer would fail again at exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())


class StopSignals:
    """Keeps the first of these signals in .received. A second Ctrl-C acts as it would have without this; others are
    passed over, since a batch system may send one to each process of a job."""

    def __init__(self, numbers=(signal.SIGINT, signal.SIGTERM)):
        self.received = 0
        self._before = {number: signal.signal(number, self._note) for number in numbers}

    def restore(self):
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _note(self, number, _frame):
        self.received = self.received or number
        if signal.SIGINT in self._before:
            signal.signal(signal.SIGINT, self._before[signal.SIGINT])


def made_with():
    """The versions of the software, and the plugin's commit, for run.json. Called within YADE."""
    import yade.config

    import contact_law

    versions = {"yade": yade.config.version, "python": sys.version.split()[0], "numpy": np.__version__}
    return {"versions": {**versions, "contact_law": contact_law.__version__}, "commit": contact_law.commit}


@cache
def hardware():
    """{'cpu': model, 'cores': number} of this machine."""
    model = platform.machine()
    with suppress(OSError), open("/proc/cpuinfo") as lines:
        model = next((line.split(":", 1)[1].strip() for line in lines if line.startswith("model name")), model)
    return {"cpu": model, "cores": os.cpu_count()}
