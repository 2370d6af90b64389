"""python3 -m analysis plot WHAT RUNS... [--x COLUMN] [--by COLUMN] [--where COLUMN=VALUE] [--out FILE]"""

import argparse

from ..printable import printable
from . import FAILED, complain

TRUTHS = {"True": True, "False": False}


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "plot",
        help="draw a quantity of many runs against one of their parameters",
        description="Draw sticking (fraction of the decided runs that stick: the largest piece gains at least 0.8 of the projectile's mass over "
        "the target, so that it holds 0.9 of equal aggregates; with exact 95 % intervals, which count undecided runs "
        "either way; those that never met are left out), largest (mass of the largest piece), energy (where it went, by channel), or any column of analysis.table "
        "against another, with standard errors over the pairs of aggregates; write a PNG and print its path.",
    )
    parser.add_argument("what", metavar="WHAT", help="sticking, largest, energy, or a column")
    parser.add_argument(
        "runs",
        nargs="+",
        metavar="RUNS",
        help="run folder, folder that holds run folders, or a pattern such as 'runs/**'",
    )
    parser.add_argument("--x", metavar="COLUMN", default="velocity", help="on the axis (default: velocity)")
    parser.add_argument("--by", metavar="COLUMN", default="", help="tells curves apart; panels of energy")
    parser.add_argument(
        "--where", metavar="COLUMN=VALUE", type=_condition, action="append", default=[], help="draw these runs only"
    )
    parser.add_argument("--log", choices=("x", "y", "xy", "none"), help="logarithmic axes (default: x over a decade)")
    parser.add_argument("--out", metavar="FILE", help="the PNG (default: WHAT-COLUMN.png)")
    parser.set_defaults(command=run)


def _condition(text):
    name, equals, value = text.partition("=")
    if not equals:
        raise argparse.ArgumentTypeError(f"{text}: must be COLUMN=VALUE")
    if value in TRUTHS:
        return name, TRUTHS[value]
    try:
        return name, float(value)
    except ValueError:
        return name, value


def run(options):
    """Exit status: 0, or 2 when a run could not be read or nothing be drawn."""
    from pathlib import Path

    from ..report.plot import plot
    from ..report.rows import frame, measure, row
    from ..runs.files import replacing

    file = Path(options.out or f"{options.what}-{options.x}.png")
    if file.suffix != ".png":
        complain(f"{file}: must end in .png")
        return FAILED
    where = dict(options.where)
    if len(where) < len(options.where):
        complain("--where: must be given once for a column")
        return FAILED
    logarithmic = "" if options.log == "none" else options.log
    structure = any("largest_" in name for name in (options.what, options.x, options.by, *where))
    measured, problems = measure(options.runs, lambda run: row(run, structure))
    for problem in problems:
        complain(problem)
    if not measured:
        return FAILED
    figure = plot(options.what, frame(measured), options.x, options.by, where, logarithmic)
    file.parent.mkdir(parents=True, exist_ok=True)
    with replacing(file) as out:
        figure.savefig(out, format="png", dpi=150)
    print(printable(file))
    return FAILED if problems else 0
