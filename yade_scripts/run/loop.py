"""Steps a scene to its end, or to where it is stopped or fails."""

import signal
import sys

from analysis.progress import tqdm


def run(steps, recorder, runner, begin, checkpoints):
    """Call begin(), and step until that many O.steps are taken or the scene is at its end.

    recorder samples from the PyRunner `runner`. Ctrl-C and SIGTERM end the run after the step that is being taken,
    with a checkpoint and one more step that records where it stopped; the outcome is then "interrupted". A scene from
    a checkpoint has taken some of the steps; one that has ended before its time (recorder.finished) takes no more.

    Returns
    -------
    (str, int)
        outcome, exit status
    """
    from yade.wrapper import Omega

    omega, stop = Omega(), StopSignals()
    progress = progress_bar(steps, omega.iter)
    try:
        begin()
        for step in range(omega.iter + 1, steps + 1):
            omega.step()
            progress.update()
            if recorder.error:
                return f"failed: {one_line(recorder.error)}", 1
            if recorder.finished:
                break
            checkpoints.save_if_due()
            if stop.received and step < steps:
                checkpoints.save()
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


def one_line(error):
    """What an exception says, on one line."""
    if isinstance(error, OSError) and error.filename:
        return f"{error.filename}: {error.strerror}"
    return " ".join(str(error).split()) or type(error).__name__


def progress_bar(total, already=0, stream=sys.stderr):
    """A bar with the time left; nothing is drawn when the stream is no terminal, and nothing stays at the end."""
    tqdm.monitor_interval = 0  # no thread of its own
    return tqdm(total=total, initial=already, file=stream, disable=None, leave=False, unit="step", mininterval=0.5)


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
