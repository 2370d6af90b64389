"""Steps a scene to its end, or to where it is stopped or fails."""
import signal

from yade.wrapper import Omega

from yade_scripts.progress import Progress


def run(steps, recorder, runner, begin, checkpoints):
    """Call begin(), step until that many O.steps are taken, and return (outcome, exit status).

    recorder samples from the PyRunner `runner`. Ctrl-C and SIGTERM end the run after the step that is being
    taken, with a checkpoint and one more step that records where it stopped; the outcome is then
    "interrupted". A scene from a checkpoint has taken some of the steps.
    """
    omega, stop = Omega(), StopSignals()
    progress = Progress(steps, already=omega.iter)
    try:
        begin()
        for step in range(omega.iter + 1, steps + 1):
            omega.step()
            progress.update(step)
            if recorder.error:
                return f'failed: {one_line(recorder.error)}', 1
            checkpoints.save_if_due()
            if stop.received and step < steps:
                checkpoints.save()
                recorder.ending, runner.iterPeriod = True, 1
                omega.step()
                return 'interrupted', 128 + stop.received
    except (RuntimeError, OSError) as error:  # from an engine, or a checkpoint that can't be written
        return f'failed: {one_line(error)}', 1
    finally:
        progress.close()
        stop.restore()
    return 'completed', 0


class StopSignals:
    """Remembers the first SIGINT or SIGTERM in .received; a second one acts as it would have without this."""

    def __init__(self):
        self.received = 0
        self._before = {number: signal.signal(number, self._note)
                        for number in (signal.SIGINT, signal.SIGTERM)}

    def restore(self):
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _note(self, number, _frame):
        self.received = number
        self.restore()


def one_line(error):
    """What an exception says, on one line."""
    return ' '.join(str(error).split()) or type(error).__name__
