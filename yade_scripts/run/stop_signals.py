"""Ctrl-C and SIGTERM as a wish to stop, to be granted at a good moment."""

import signal


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
