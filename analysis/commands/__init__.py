"""The commands of python3 -m analysis, one a module: add_parser(commands) and what they run."""

import sys

from ..printable import printable

FAILED = 2


def complain(message):
    """One line on stderr."""
    print(printable(f"analysis: {message}"), file=sys.stderr, flush=True)
