"""python3 -m analysis outcome --velocity V --projectile N --target N --filling F [--impact B | averaged] [--maxwell] [--material M]"""

import argparse

from ..printable import printable_lines
from . import FAILED, complain


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "outcome",
        help="what becomes of a collision of two aggregates, from the collision atlas",
        description="Probabilities of the outcomes of a collision of two aggregates, and what is left, from the collision atlas (analysis/gallery/atlas): "
        "from its table of outcomes; with an impact parameter from its model, which takes scikit-learn. Intervals are of 90 %%.",
    )
    number = {"type": _positive, "required": True, "metavar": "X"}
    parser.add_argument("--velocity", help="relative velocity [m/s]", **number)
    parser.add_argument("--projectile", help="grains of one aggregate", **number)
    parser.add_argument("--target", help="grains of the other", **number)
    parser.add_argument(
        "--filling", help="volume filling factor of both, of spheres of radius (5/3)^(1/2) R_g", **number
    )
    parser.add_argument(
        "--impact",
        default="averaged",
        type=_impact,
        metavar="B",
        help="impact parameter, 0 to 1, over the sum of these radii; averaged: uniform in b^2",
    )
    parser.add_argument(
        "--maxwell", action="store_true", help="velocity is the root mean square of a Maxwell distribution of speeds"
    )
    parser.add_argument("--material", default="ice", help="of the grains, ice or silicate")
    parser.add_argument("--grain-radius", default=1e-7, type=_positive, metavar="R", help="of the grains [m]")
    parser.set_defaults(command=run)


def _positive(text):
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"{text}: must be a number > 0")
    return value


def _impact(text):
    if text == "averaged":
        return text
    try:
        value = float(text)
    except ValueError:
        value = -1.0
    if not 0 <= value <= 1:
        raise argparse.ArgumentTypeError(f"{text}: must be 0 to 1, or averaged")
    return value


def run(options):
    """Exit status: 0, or 2 with one line on stderr."""
    from ..atlas.model import NoLearning
    from ..atlas.query import text
    from ..runs.table import TableError

    try:
        print(printable_lines(text(options)))
    except (ValueError, NoLearning, TableError) as error:
        complain(error)
        return FAILED
    except OSError as error:
        complain(f"{error.filename}: {error.strerror}; must be the atlas's, which a checkout has")
        return FAILED
    return 0
