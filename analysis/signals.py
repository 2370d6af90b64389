"""Signals that end a process."""

import signal
import sys

ENDING = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)


def end_quietly(*numbers):
    """From now on these signals end the process with status 128 + number, without a traceback, and what it has begun to
    write goes; to be called before slow imports. One that is ignored (nohup, a job in the background) stays so."""
    for number in numbers:
        if signal.getsignal(number) is not signal.SIG_IGN:
            signal.signal(number, lambda number, frame: sys.exit(128 + number))
