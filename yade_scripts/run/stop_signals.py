"""Ctrl-C and SIGTERM as a wish to stop, to be granted at a good moment."""

import signal
import sys


def end_quietly():
    """From now on Ctrl-C ends the process with status 130, without a traceback; to be called before slow imports.

    Where it is ignored (nohup, a job in the background), it stays so.
    """
    if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
        signal.signal(signal.SIGINT, lambda number, frame: sys.exit(128 + number))


class StopSignals:
    """Keeps the first of these signals in .received; a second one acts as it would have without this."""

    def __init__(self, numbers=(signal.SIGINT, signal.SIGTERM)):
        self.received = 0
        self._before = {number: signal.signal(number, self._note) for number in numbers}

    def restore(self):
        for number, handler in self._before.items():
            signal.signal(number, handler)

    def _note(self, number, _frame):
        self.received = number
        self.restore()
