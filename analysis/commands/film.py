"""python3 -m analysis film RUN [--out FILE] [--rate FRAMES] [--along AXIS] [--colour BY] [--width PIXELS]"""

import argparse

from ..figures.grain_colours import COLOURINGS
from . import number, write_of_run


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "film",
        help="write a film of a run's states",
        description="Write a film with a frame for each saved state. Needs ffmpeg.",
    )
    parser.add_argument("run", metavar="RUN", help="run folder")
    parser.add_argument("--out", metavar="FILE", help="where to (default: RUN/film.mp4); .gif: repeats")
    parser.add_argument(
        "--rate",
        metavar="FRAMES",
        type=number(lambda rate: 0.1 <= rate <= 120, "from 0.1 to 120"),
        default=10.0,
        help="states a second (default: 10)",
    )
    parser.add_argument("--along", choices=tuple("xyz"), default="z", help="axis along which it is seen (default: z)")
    parser.add_argument("--colour", choices=COLOURINGS, default="aggregate", help="of the grains (default: aggregate)")
    parser.add_argument("--width", metavar="PIXELS", type=_width, default=960, help="from 160 to 3840 (default: 960)")
    parser.set_defaults(command=run)


def _width(text):
    if not text.isascii() or not text.isdigit() or not 160 <= int(text) <= 3840:
        raise argparse.ArgumentTypeError(f"{text}: must be a whole number from 160 to 3840")
    return int(text)


def run(options):
    """Exit status: 0, or 2 when the run could not be read or the film not be written."""
    from ..export.film import write_film

    write = lambda folder, file: write_film(folder, file, options.rate, options.width, options.along, options.colour)
    return write_of_run(options, "film.mp4", write)
