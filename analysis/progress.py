"""Progress with the time left, on a terminal and in a notebook; nothing elsewhere."""

import sys
from threading import RLock

from tqdm import tqdm

from .printable import printable

# tqdm's own is one between processes too, for which Python 3.14 starts a process that outlives a killed run, and warns.
tqdm.set_lock(RLock())


def progress(items, what, total=None):
    """The items, with a bar on stderr while they are taken; nothing of it stays.

    total: their number, where len(items) can't tell."""
    return tqdm(items, what, total=total, disable=_disabled(), leave=False)


def bar(total, what):
    """A bar on stderr of `total` things, moved by .update(number); .set_postfix_str() shows the time left, .write()
    prints a line on stdout beside it."""
    form = "{desc}: {percentage:3.0f} %|{bar}| {n:.1f} of {total:g} [{elapsed}{postfix}]"
    return tqdm(desc=what, total=total, disable=_disabled(), leave=False, bar_format=form, mininterval=1.0)


def line_beside_bars(text):
    """Print a line on stdout while a bar may be there."""
    tqdm.write(printable(text))


def _disabled():
    """For tqdm: None where it looks for a terminal itself."""
    return False if "ipykernel" in sys.modules else None
