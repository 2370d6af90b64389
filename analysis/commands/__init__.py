"""The commands of python3 -m analysis: each module adds its own to the parser, and loads what they need when they
run. A command is a function of the options that returns the exit status: 0, or FAILED when something could not be
read or written."""

import argparse
from pathlib import Path

from ..printable import FAILED, complain, printable  # noqa: F401

RUNS = "run folder, folder that holds run folders, or a pattern such as 'runs/**'"


def add_command(commands, command, about, description=None, runs=None, **more):
    """A parser for a command's options, added to argparse's subparsers; runs: help of its argument RUNS, if it has
    one."""
    parser = commands.add_parser(command.__name__, help=about, description=description, **more)
    parser.set_defaults(command=command)
    if runs:
        parser.add_argument("runs", nargs="+", metavar="RUNS", help=runs)
    return parser


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


def with_ending(ending):
    """A type of argparse's: the Path of a file with this ending."""

    def of(text):
        if Path(text).suffix != ending:
            raise argparse.ArgumentTypeError(f"{text}: must end in {ending}")
        return Path(text)

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
