"""The commands of python3 -m analysis: each module adds its own to the parser, and loads what they need when they
run."""

import argparse
from pathlib import Path

from ..printable import FAILED, complain, printable  # noqa: F401

RUNS = "run folder, folder that holds run folders, or a pattern such as 'runs/**'"


def number(is_right, must_be):
    """A type of argparse's: a number for which is_right(number) holds, refused with what it must be."""

    def of(text):
        try:
            value = float(text)
        except ValueError:
            value = float("nan")
        if not is_right(value):
            raise argparse.ArgumentTypeError(f"{text}: must be {must_be}")
        return value

    return of


def in_one_line(options):
    """Exit status of a command. Refusals, of the file system or by this package, get one line; an error of the file
    system that names no file, as a full disk's, is of what the command writes."""
    try:
        return options.command(options)
    except BrokenPipeError:  # main()'s
        raise
    except OSError as error:
        written = (getattr(options, name, None) for name in ("page", "figures", "out", "run"))
        complain(f"{error.filename or next(filter(None, written), '')}: {error.strerror}")
    except Exception as error:
        if not type(error).__module__.startswith("analysis."):
            raise
        complain(error)
    return FAILED


def write_of_run(options, name, write):
    """Exit status of a command that writes one file of options.run: write(RunFolder, Path), to options.out or to
    `name` in its folder."""
    from ..runs.folder import open_run

    folder = open_run(options.run)
    print(printable(write(folder, Path(options.out) if options.out else folder.path / name)))
    return 0
