"""States of runs (runs.status.State) as lines of text."""

from tqdm import tqdm

from ..printable import printable
from ..runs.status import DONE, FAILED, KINDS, RUNNING

WIDTH = 20  # of a bar


def duration_text(seconds):
    """02:03 or 1:02:03 for a number of seconds.

    >>> duration_text(123), duration_text(3723.4)
    ('02:03', '1:02:03')
    """
    return tqdm.format_interval(seconds)


def counts(states):
    """How many are done, running, waiting and failed, in words."""
    return ", ".join(f"{sum(state.kind == kind for state in states)} {kind}" for kind in KINDS)


def line(name, state, left=None):
    """One run: its state, name, bar, time left [s] (None: unknown) and note."""
    text, note = f"  {state.kind:8s} {printable(name):24s}", printable(state.note)
    if state.kind == FAILED:
        return f"{text} {note}"
    if state.kind == DONE:
        return f"{text} {duration_text(state.seconds or 0):>8s}"
    filled = int(WIDTH * state.progress)
    bar = f' [{"#" * filled}{"." * (WIDTH - filled)}] {100 * state.progress:5.1f} %' if state.kind == RUNNING else ""
    return text + bar + ("" if left is None else f" {duration_text(left):>8s} left") + (f"  {note}" if note else "")
