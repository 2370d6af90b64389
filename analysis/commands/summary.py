"""python3 -m analysis summary RUN... [--json]"""

import json

from ..printable import printable_lines
from . import FAILED, complain


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "summary",
        help="print compression, outcome and energies of runs",
        description="Print compression (A24 eqs 10-13), outcome, restitution and the energy channels of each run.",
    )
    parser.add_argument("runs", nargs="+", metavar="RUN", help="run folder (holds run.json, history.npz, states/)")
    parser.add_argument(
        "--json",
        action="store_true",
        help="print JSON, all in SI units: one object for one run, a list of objects for several; null where a value "
        "does not exist",
    )
    parser.set_defaults(command=run)


def run(options):
    """Exit status: 0, or 2 when a run could not be read."""
    from ..report.summary import summarise, table
    from ..runs.arrays import RunFolderError
    from ..runs.folder import open_run

    results, failed = [], False
    for path in options.runs:
        try:
            folder = open_run(path)
            numbers = summarise(folder)
            text = table(folder, numbers)
        except RunFolderError as error:
            complain(error)
            failed = True
            continue
        if not options.json:
            print(("\n" if results else "") + printable_lines(text), flush=True)
        results.append(numbers)
    if options.json and (results or len(options.runs) > 1):
        print(json.dumps(results if len(options.runs) > 1 else results[0], indent=2, allow_nan=False))
    return FAILED if failed else 0
