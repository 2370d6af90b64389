"""python3 -m analysis outcome --velocity V --projectile N --target N --filling F [--impact B | averaged] …"""

from ..printable import printable_lines
from . import FAILED, complain, number

_positive = number(lambda value: 0 < value < float("inf"), "a number > 0")
_grains = number(lambda value: 1 <= value < float("inf"), "a number >= 1")
_filling = number(lambda value: 0 < value <= 1, "a number > 0 and at most 1")
_radius = number(lambda value: 1e-9 <= value <= 1e-3, "1e-09 to 0.001 [m]")


def _impact(text):
    return text if text == "averaged" else number(lambda b: 0 <= b <= 1, "0 to 1, or averaged")(text)


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "outcome",
        help="what becomes of a collision of two aggregates, from the collision atlas",
        description="Probabilities of the outcomes of a collision of two aggregates, and what is left, from the tables "
        "of the collision atlas (analysis/gallery/atlas). With --impact it has intervals of 90 %; there are none where "
        "the answer is that of the nearest data.",
    )
    needed = {"required": True, "metavar": "X"}
    parser.add_argument("--velocity", type=_positive, help="relative velocity [m/s]", **needed)
    parser.add_argument("--projectile", type=_grains, help="grains of one aggregate", **needed)
    parser.add_argument("--target", type=_grains, help="grains of the other", **needed)
    parser.add_argument(
        "--filling", type=_filling, help="volume filling factor of both, of spheres of radius (5/3)^(1/2) R_g", **needed
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
        help="grown: by hits of grains and clusters, or compressed; close-packed: a dense packing without some of its "
        "grains, which bounces far more often",
    )
    parser.add_argument("--material", default="ice", help="of the grains, ice or silicate")
    parser.add_argument(
        "--grain-radius",
        type=_radius,
        metavar="R",
        help="of the grains [m]; where it is left out that of the material, 1e-07 of ice and 6e-07 of silicate",
    )
    parser.set_defaults(command=run)


def run(options):
    """Exit status: 0, or 2 with one line on stderr."""
    from ..atlas.query import in_words  # loads pandas and scipy

    try:
        lines = in_words(options)
    except ValueError as error:
        complain(error)
        return FAILED
    print(printable_lines("\n".join(lines)))
    return 0
