"""The command line: python3 -m analysis COMMAND (summary, outcome, plot, figures, view, film, export, status, verify,
study)."""

import argparse
import os
import sys

from .startup import ENDING, end_quietly, require_libraries

if __name__ == "__main__":
    end_quietly(*ENDING)
    require_libraries()

from .commands import in_one_line, numbers, pictures, study  # noqa: E402
from .printable import printable  # noqa: E402


def main(arguments=None):
    """Run a command; returns the exit status: 0, or 2 when a run could not be analysed (each gets one line on
    stderr)."""
    if arguments is None:
        end_quietly(*ENDING)
    options = _parser().parse_args(arguments)
    try:
        return in_one_line(options)
    except BrokenPipeError:
        # The reader (head, less) has gone: nothing more may be printed, not even at the interpreter's exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


def _parser():
    parser = _Parser(
        prog="python3 -m analysis",
        description="Analyse run folders.",
        epilog="Exit status: 0, or 2 if a run could not be analysed. A run that has not ended is analysed as far as it "
        "went by summary, figures, view, film and export, and left out by study.",
    )
    parser.add_argument("--version", action=_Version, nargs=0, help="print version and commit, and exit")
    commands = parser.add_subparsers(required=True, metavar="command")
    for module in (numbers, pictures, study):
        module.add_parsers(commands)
    return parser


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        super().error(printable(message))


class _Version(argparse.Action):
    """Asks git only when it is called."""

    def __call__(self, parser, *_):
        from .version import version_text

        print(f"analysis {version_text()}")
        parser.exit()


if __name__ == "__main__":
    sys.exit(main())
