"""python3 -m analysis view RUN [--out FILE] [--three FOLDER]"""

from . import FAILED, complain, write_of_run


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "view",
        help="write a page on which the aggregates can be turned",
        description="Write the saved states as one HTML file for a browser: turn, zoom, go through the states, colour by aggregate, "
        "contacts, speed, fragment or sintered bonds. It needs no network. Made with three.js (Debian: libjs-three).",
    )
    parser.add_argument("run", metavar="RUN", help="run folder")
    parser.add_argument("--out", metavar="FILE", help="where to (default: RUN/view.html)")
    parser.add_argument("--three", metavar="FOLDER", help="three.js, r110 to r147 (default: Debian's)")
    parser.set_defaults(command=run)


def run(options):
    """Exit status: 0, or 2 when the run could not be read or the page not be written."""
    from ..export.viewer import THREE, write_view

    if options.out and not options.out.endswith((".html", ".htm")):
        complain(f"{options.out}: must end in .html")
        return FAILED
    return write_of_run(options, "view.html", lambda folder, file: write_view(folder, file, options.three or THREE))
