"""A run from its parameters to its run folder: what a script of a kind of run calls."""

import os
import sys
import time

from analysis.runs.files import RunFolderError
from yade_scripts.parameters import ParameterError
from yade_scripts.parameters.errors import InputError, one_line_errors
from yade_scripts.run import resuming
from yade_scripts.run.parameters import gather
from yade_scripts.stability import AUTO, require_countable


def main(kind, description):
    """Run the parameters of the command line or of yade-batch, and end the process.

    kind: run.kind.Kind; description: what --help says before the parameters. To be called within YADE.
    """
    begun = time.monotonic()
    script = os.path.basename(sys.argv[0])
    if "--help" in sys.argv[1:]:
        print(f"{description}\n{kind.parameters.help_text()}")
        sys.exit(0)
    if "--version" in sys.argv[1:]:
        from analysis.version import version_text

        print(f"{script} {version_text()}")
        sys.exit(0)
    with one_line_errors(script):
        texts, row = gather(sys.argv[1:], kind)
        if "yade" not in sys.modules:
            raise InputError(f"must be run by YADE: yade -n -x {sys.argv[0]} velocity=3, say")
        parameters = resuming.continued(kind, texts) if resuming.CONTINUE in texts else kind.parse(texts, row)
        from yade.wrapper import Omega

        import contact_law  # noqa: F401  (the plugin, before its classes are needed)

        scene = kind.prepare(parameters, Omega().numThreads)
        _require_finite(scene.parameters, scene.constants["timeUnit"])
        folder, schedule = _open(kind, scene)
    try:
        status = _carry_out(kind, scene, schedule, folder, begun)
    finally:
        folder.close()
    sys.exit(status)


def _require_finite(parameters, time_unit):
    """Raise ParameterError when a kind of run has left the step open, or the steps are too many."""
    if parameters.stepFraction == AUTO:
        raise ParameterError(f"stepFraction = {AUTO}: not measured for this kind of run; must be a number [t0]")
    require_countable(parameters.duration, parameters.stepFraction, time_unit)


def _open(kind, scene):
    """The run folder, with its checkpoint if the run resumes from one; the Schedule, whose interval between samples is
    then the checkpoint's."""
    from yade_scripts.run import report
    from yade_scripts.run.folder import RunFolder
    from yade_scripts.run.kind import Schedule

    given, interval = scene.parameters, None
    folder = RunFolder(given.out, given.overwrite, given.resume)
    saved = folder.checkpoint
    try:
        if saved:
            differs = resuming.difference(kind, given, saved.run, but=("duration",))
            saved.require_agreement(differs, report.made_with())
            interval = saved.interval
        schedule = Schedule.of(given.duration, scene.time_step, scene.interval, states=given.states, kept=interval)
        if saved:
            saved.require_whole()
            saved.require_time_left(schedule.steps * scene.time_step, folder.has_ended())
            folder.resume()
    except BaseException:
        folder.close()
        raise
    return folder, schedule


def _carry_out(kind, scene, schedule, folder, begun):
    """Step the scene to its end and write the run folder; the exit status."""
    from yade_scripts.run import loop
    from yade_scripts.run import scene as yade_scene
    from yade_scripts.run.checkpoint import CheckpointWriter
    from yade_scripts.run.recorder import Recorder
    from yade_scripts.run.report import Report

    parameters, saved = scene.parameters, folder.checkpoint
    recorder = Recorder(folder, schedule, kind.format, scene)
    about = {
        "kind": kind.name,
        "parameters": parameters.as_dict(),
        "derived": yade_scene.derived(scene, schedule),
        "seed": parameters.as_dict().get("seed"),
    }
    report = Report(folder, about, begun, saved.wallTime if saved else 0.0)
    try:
        if saved:
            recorder.resume(saved.rows, saved.columns, saved.states)
            steps, runner, begin = yade_scene.resume(scene, schedule, recorder, saved)
        else:
            steps, runner, begin = yade_scene.start(scene, schedule, recorder)
        report.begin()
        if scene.step_choice != "as given":
            print(f"step: {scene.step_choice}", flush=True)
        checkpoints = CheckpointWriter(folder, report.run, recorder, report.wall_time, parameters.checkpointInterval)
        outcome, status = loop.run(steps, recorder, runner, begin, checkpoints)
        recorder.write_history()
        if outcome == "completed":
            report.undecided, report.run["endedBy"] = kind.why_undecided(folder.path), scene.ended_by(recorder)
        if report.undecided:
            checkpoints.save()
    except (OSError, RuntimeError, RunFolderError) as error:  # a folder's, or a scene's that YADE can't load
        outcome, status = f"failed: {loop.one_line(error)}", 1
    return report.end(outcome, status, recorder.time)
