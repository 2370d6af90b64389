"""python3 -m analysis summary RUNS... [--long | --json]"""

import json
from pathlib import Path

from ..printable import printable_lines
from . import FAILED, complain


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "summary",
        help="print outcome, compression and energies of runs",
        description="Print a row a run: the parameters in which the runs differ, and what became of them; with --long compression "
        "(A24 eqs 10-13), outcome, restitution and the energy channels of each.",
    )
    parser.add_argument(
        "runs",
        nargs="+",
        metavar="RUNS",
        help="run folder, folder that holds run folders, or a pattern such as 'runs/**'",
    )
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--long", action="store_true", help="print all of each run")
    form.add_argument(
        "--json",
        action="store_true",
        help="print JSON, all in SI units: one object for one run folder, a list of objects for several; null where a value "
        "does not exist",
    )
    parser.set_defaults(command=run)


def run(options):
    """Exit status: 0, or 2 when a run could not be read, or there was none."""
    from ..report.rows import frame, measure, short_text

    measured, problems = measure(options.runs, lambda run: _of(run, options))
    if options.json and (measured or len(options.runs) > 1):
        results = [numbers for _, numbers in measured]
        one = len(options.runs) == 1 and measured[0][0] == Path(options.runs[0])
        print(json.dumps(results[0] if one else results, indent=2, allow_nan=False))
    elif measured:
        told = "\n\n".join(text for _, text in measured) if options.long else short_text(frame(measured))
        print(printable_lines(told))
    for problem in problems:
        complain(problem)
    return FAILED if problems else 0


def _of(run, options):
    """What is wanted of a RunFolder."""
    from ..report.rows import row
    from ..report.summary import summarise, table

    if options.json:
        return summarise(run)
    return table(run, summarise(run)) if options.long else row(run, structure=False)
