"""Progress with the time left, of whatever takes longer than a moment."""

from tqdm import tqdm

from .printable import printable


def progress(items, what, total=None):
    """The items, with a bar on stderr while they are taken; nothing is drawn when that is no terminal, and nothing stays.

    total: their number, where len(items) can't tell."""
    return tqdm(items, what, total=total, disable=None, leave=False)


def line_beside_bars(text):
    """Print a line on stdout while a bar may be there."""
    tqdm.write(printable(text))
