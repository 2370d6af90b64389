"""Steps a scene to its end, or to where it is stopped or fails."""
import signal

from yade.wrapper import Omega

from yade_scripts.progress import Progress


def run(steps, recorder, runner, begin):
    """Call begin(), take that many O.steps, and return (outcome, exit status).

    recorder samples from the PyRunner `runner`. Ctrl-C and SIGTERM end the run after the step that is being
    taken, with one more step that records where it stopped; the outcome is then "interrupted".
    """
    omega, progress, stop = Omega(), Progress(steps), StopSignals()
    try:
        begin()
        for step in range(1, steps + 1):
            omega.step()
            progress.update(step)
            if recorder.error:
                return f'failed: {one_line(recorder.error)}', 1
            if stop.received and step < steps:
                recorder.ending, runner.iterPeriod = True, 1
                omega.step()
                return 'interrupted', 128 + stop.received
    except RuntimeError as error:  # from an engine
        recorder.write_last_good()
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
