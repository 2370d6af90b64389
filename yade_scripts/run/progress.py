"""The progress bar of a run."""

import sys

from analysis.progress import tqdm


def progress_bar(total, already=0, stream=sys.stderr, unit="step"):
    """A bar with the time left; nothing is drawn when the stream is no terminal, and nothing stays at the end."""
    tqdm.monitor_interval = 0  # no thread of its own
    return tqdm(total=total, initial=already, file=stream, disable=None, leave=False, unit=unit, mininterval=0.5)
