"""The commands of python3 -m analysis, one a module: add_parser(commands) and what they run."""

import sys
from pathlib import Path

from ..printable import printable

FAILED = 2


def complain(message):
    """One line on stderr."""
    print(printable(f"analysis: {message}"), file=sys.stderr, flush=True)


def write_of_run(options, name, write, *refusals):
    """Exit status of a command that writes one file of options.run: write(RunFolder, Path), to options.out or to `name` in its folder;
    refusals: what write() raises beside the usual, one line each."""
    from ..runs.arrays import RunFolderError
    from ..runs.folder import open_run

    try:
        folder = open_run(options.run)
        print(printable(write(folder, Path(options.out) if options.out else folder.path / name)))
    except (RunFolderError, *refusals) as error:
        complain(error)
        return FAILED
    except OSError as error:
        complain(f"{error.filename or options.run}: {error.strerror}")
        return FAILED
    return 0
