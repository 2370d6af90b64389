"""Wrong input ends a script with one line on stderr and exit status 2."""

import os
import sys
from contextlib import contextmanager, suppress

from analysis.printable import printable


class InputError(Exception):
    """Input that can't be used; the message is one line: what, where, what it must be."""


@contextmanager
def one_line_errors(script):
    """Within it an InputError, a file that can't be used, or a plugin that isn't built, is one line and exit status
    2."""
    try:
        yield
    except (InputError, ImportError, MemoryError) as error:
        tell(" ".join(str(error).split()) or type(error).__name__, script)
        sys.exit(2)
    except OSError as error:
        tell(f"{error.filename}: {error.strerror}" if error.filename else error, script)
        sys.exit(2)


def tell(text, script=None):
    """One line on stderr that begins with the name of the script (this process's); nothing when it can't be written."""
    with suppress(OSError):
        print(printable(f"{script or os.path.basename(sys.argv[0])}: {text}"), file=sys.stderr, flush=True)
