"""Command line: python3 -m analysis summary RUN... [--json], figures RUN [--out DIR], and elastoplastic RUNS...
[--figures FOLDER] [--json]."""

import argparse
import json
import os
import sys

from .elastoplastic.command import add_parser as add_elastoplastic
from .run_folder import RunFolderError, open_run
from .summary import summarise, table

FAILED = 2


def main(arguments=None):
    """Run a command; returns the exit status: 0, or 2 when a run could not be analysed (each gets one line on
    stderr)."""
    options = _parser().parse_args(arguments)
    try:
        return options.command(options)
    except BrokenPipeError:
        # The reader (head, less) has gone: nothing is left to say, not even at the interpreter's exit.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return 0


def _parser():
    parser = argparse.ArgumentParser(
        prog="python3 -m analysis",
        description="Analyse run folders of aggregate collisions.",
        epilog="Exit status: 0, or 2 if a run could not be analysed. A run that has not ended "
        "is analysed as far as it went.",
    )
    commands = parser.add_subparsers(required=True, metavar="command")
    summary = commands.add_parser(
        "summary",
        help="print compression, outcome and energies of runs",
        description="Print compression (A24 eqs 10-13), outcome, restitution and the energy " "channels of each run.",
    )
    summary.add_argument("runs", nargs="+", metavar="RUN", help="run folder (holds run.json, history.npz, states/)")
    summary.add_argument(
        "--json",
        action="store_true",
        help="print JSON, all in SI units: one object for one run, a list of objects for several; "
        "null where a value does not exist",
    )
    summary.set_defaults(command=_summary)
    figures = commands.add_parser(
        "figures",
        help="draw a run's figures",
        description="Write motion.png (d and v against time), energy.png (the channels), "
        "grains.png (cut through the aggregates) and forces.png (contact forces).",
    )
    figures.add_argument("run", metavar="RUN", help="run folder")
    figures.add_argument(
        "--out", metavar="DIR", help="folder for the figures (default: RUN/figures), made if it is missing"
    )
    figures.set_defaults(command=_figures)
    add_elastoplastic(commands)
    return parser


def _complain(message):
    print(f"analysis: {message}", file=sys.stderr, flush=True)


def _summary(options):
    results, failed = [], False
    for path in options.runs:
        try:
            run = open_run(path)
            numbers = summarise(run)
            text = table(run, numbers)
        except RunFolderError as error:
            _complain(error)
            failed = True
            continue
        if not options.json:
            print(("\n" if results else "") + text, flush=True)
        results.append(numbers)
    if options.json and (results or len(options.runs) > 1):
        print(json.dumps(results if len(options.runs) > 1 else results[0], indent=2, allow_nan=False))
    return FAILED if failed else 0


def _figures(options):
    # matplotlib is slow to load, and `summary` does without it.
    from .figures import draw_all

    try:
        run = open_run(options.run)
        for file in draw_all(run, options.out or run.path / "figures"):
            print(file)
    except (RunFolderError, OSError) as error:
        _complain(error)
        return FAILED
    return 0


if __name__ == "__main__":
    sys.exit(main())
