"""python3 -m analysis view RUN [--out FILE] [--three FOLDER]"""

from pathlib import Path

from ..printable import printable
from . import FAILED, complain


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
    from ..export.viewer import THREE, NoThree, write_view
    from ..runs.arrays import RunFolderError
    from ..runs.folder import open_run

    try:
        folder = open_run(options.run)
        file = Path(options.out) if options.out else folder.path / "view.html"
        print(printable(write_view(folder, file, options.three or THREE)))
    except (RunFolderError, NoThree) as error:
        complain(error)
        return FAILED
    except OSError as error:
        complain(f"{error.filename or options.run}: {error.strerror}")
        return FAILED
    return 0
