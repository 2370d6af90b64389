"""python3 -m analysis summary, outcome: numbers of runs, and of the collision atlas."""

import json
from pathlib import Path

from ..printable import printable_lines
from . import FAILED, RUNS, complain, number


def add_parsers(commands):
    """Add the commands to argparse's subparsers."""
    _add_summary(commands)
    _add_outcome(commands)


def _add_summary(commands):
    parser = commands.add_parser(
        "summary",
        help="print outcome, compression and energies of runs",
        description="Print a row a run: the parameters in which the runs differ, and what became of them; with --long "
        "compression (A24 eqs 10-13), outcome, restitution and the energy channels of each.",
    )
    parser.add_argument("runs", nargs="+", metavar="RUNS", help=RUNS)
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--long", action="store_true", help="print all of each run")
    form.add_argument(
        "--json",
        action="store_true",
        help="print JSON, all in SI units: one object for one run folder, a list of objects for several; null where a "
        "value does not exist",
    )
    parser.set_defaults(command=summary)


def summary(options):
    """Exit status: 0, or 2 when a run could not be read, or there was none."""
    from ..report.rows import frame, measure, row, summarise
    from ..report.text import long_text, short_text

    if options.json:
        of_run = summarise
    elif options.long:
        of_run = lambda run: long_text(run, row(run, structure=False))
    else:
        of_run = lambda run: row(run, structure=False)
    measured, problems = measure(options.runs, of_run)
    found = [of for _, of in measured]
    if options.json and (measured or len(options.runs) > 1):
        one = len(options.runs) == 1 and measured[0][0] == Path(options.runs[0])
        print(json.dumps(found[0] if one else found, indent=2, allow_nan=False))
    elif measured:
        print(printable_lines("\n\n".join(found) if options.long else short_text(frame(measured))))
    for problem in problems:
        complain(problem)
    return FAILED if problems else 0


def _add_outcome(commands):
    parser = commands.add_parser(
        "outcome",
        help="what becomes of a collision of two aggregates, from the collision atlas",
        description="Probabilities of the outcomes of a collision of two aggregates, and what is left, from the tables "
        "of the collision atlas (analysis/gallery/atlas). With --impact it has intervals of 90 %; there are none where "
        "the answer is that of the nearest data.",
    )
    positive = number(lambda value: 0 < value < float("inf"), "a number > 0")
    parser.add_argument("--velocity", type=positive, required=True, metavar="X", help="relative velocity [m/s]")
    for name, about in (
        ("projectile", "grains of one aggregate"),
        ("target", "grains of the other"),
        ("filling", "volume filling factor of both, of spheres of radius (5/3)^(1/2) R_g"),
    ):
        parser.add_argument(f"--{name}", type=float, required=True, metavar="X", help=about)
    parser.add_argument(
        "--impact",
        type=float,
        metavar="B",
        help="impact parameter, 0 to 1, over the sum of these radii (default: averaged, uniform in b^2)",
    )
    parser.add_argument(
        "--maxwell", action="store_true", help="velocity is the root mean square of a Maxwell distribution of speeds"
    )
    parser.add_argument(
        "--structure",
        default="grown",
        help="grown: by hits of grains and clusters, or compressed; close-packed: a dense packing without some of its "
        "grains, which bounces far more often",
    )
    parser.add_argument("--material", default="ice", help="of the grains, ice or silicate")
    parser.add_argument(
        "--grain-radius",
        type=float,
        metavar="R",
        help="of the grains [m] (default: that of the material, 1e-07 of ice and 6e-07 of silicate)",
    )
    parser.set_defaults(command=outcome)


def outcome(options):
    """Exit status: 0, or 2 with one line on stderr."""
    from ..atlas.query import in_words

    try:
        lines = list(in_words(options))
    except ValueError as error:
        complain(error)
        return FAILED
    print(printable_lines("\n".join(lines)))
    return 0
