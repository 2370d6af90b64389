"""Signals that end a process."""

import signal
import sys
import threading
from contextlib import contextmanager

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def end_quietly(*numbers):
    """From now on these signals end the process with status 128 + number, without a traceback, and what it has begun to write
    goes; to be called before slow imports.

    One that is ignored (nohup, a job in the background) stays so.
    """
    for number in numbers:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, lambda number, frame: sys.exit(128 + number))


@contextmanager
def held():
    """Signals that end the process do so when the block has ended: for what must not be left half done."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    came, before = [], {number: signal.getsignal(number) for number in ENDING}
    for number, handler in before.items():
        if callable(handler):
            signal.signal(number, lambda number, frame: came.append((number, frame)))
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
    for number, frame in came:
        before[number](number, frame)
