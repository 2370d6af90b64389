"""python3 -m analysis outcome --velocity V --projectile N --target N --filling F [--impact B | averaged] [--maxwell] [--material M]"""

from ..printable import printable_lines
from . import FAILED, complain, number


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "outcome",
        help="what becomes of a collision of two aggregates, from the collision atlas",
        description="Probabilities of the outcomes of a collision of two aggregates, and what is left, from the tables of the collision atlas "
        "(analysis/gallery/atlas). With --impact it has intervals of 90 %; there are none where the answer is that of the nearest data.",
    )
    of_number = {"type": _positive, "required": True, "metavar": "X"}
    parser.add_argument("--velocity", help="relative velocity [m/s]", **of_number)
    of_grains = of_number | {"type": number(lambda value: 1 <= value < float("inf"), "a number >= 1")}
    parser.add_argument("--projectile", help="grains of one aggregate", **of_grains)
    parser.add_argument("--target", help="grains of the other", **of_grains)
    of_filling = of_number | {"type": number(lambda value: 0 < value <= 1, "a number > 0 and at most 1")}
    parser.add_argument(
        "--filling", help="volume filling factor of both, of spheres of radius (5/3)^(1/2) R_g", **of_filling
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
    parser.add_argument(
        "--structure",
        default="grown",
        help="grown: by hits of grains and clusters, or compressed; close-packed: a dense packing without some of its grains, which bounces far more often",
    )
    parser.add_argument("--material", default="ice", help="of the grains, ice or silicate")
    parser.add_argument(
        "--grain-radius",
        type=_radius,
        metavar="R",
        help="of the grains [m]; where it is left out that of the material, 1e-07 of ice and 6e-07 of silicate",
    )
    parser.set_defaults(command=run)


_positive = number(lambda value: 0 < value < float("inf"), "a number > 0")

_radius = number(lambda value: 1e-9 <= value <= 1e-3, "1e-09 to 0.001 [m]")


def _impact(text):
    return text if text == "averaged" else number(lambda b: 0 <= b <= 1, "0 to 1, or averaged")(text)


def run(options):
    """Exit status: 0, or 2 with one line on stderr."""
    from ..atlas.query import text

    try:
        answer = text(options)
    except ValueError as error:  # numpy's among them
        complain(error)
        return FAILED
    print(printable_lines(answer))
    return 0
