"""python3 -m analysis elastoplastic RUNS... [--figures FOLDER] [--json]"""

import json
import sys
from pathlib import Path

from ..progress import progress
from ..run_folder import RunFolderError
from .collect import collect
from .measure import NoCompression, measure
from .provenance import provenance
from .report import data, markdown, text
from .study import make_study

FAILED = 2


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "elastoplastic",
        help="A24's figures and numbers from many runs, beside the paper's",
        description="Fit and draw what A24 (elastoplastic collisions) does from runs of its scene, print the "
        "numbers beside the paper's, and say where the energy goes and how collisions end. Runs that have not ended "
        "or are of another scene are left out with a note on stderr.",
    )
    parser.add_argument(
        "runs", nargs="+", metavar="RUNS", help="run folder, or folder that holds run folders (one or two levels below)"
    )
    parser.add_argument(
        "--figures",
        metavar="FOLDER",
        help="write comparison.md, comparison.json and the figures there; made if it is missing",
    )
    parser.add_argument(
        "--json", action="store_true", help="print JSON (SI units unless a unit is named) instead of text"
    )
    parser.set_defaults(command=run)


def run(options):
    """Exit status: 0, or 2 when a path or run could not be read or nothing was left to analyse."""
    collection = collect(options.runs)
    rows, measured, notes, problems = [], [], list(collection.notes), list(collection.problems)
    for folder in progress(collection.runs, "reading runs"):
        try:
            rows.append(measure(folder))
            measured.append(folder)
        except NoCompression as error:
            notes.append(f"{error}, left out")
        except RunFolderError as error:
            problems.append(str(error))
    for line in (*notes, *problems):
        print(f"analysis: {line}", file=sys.stderr, flush=True)
    if not rows:
        if not problems:
            print("analysis: no run of A24's scene to analyse", file=sys.stderr)
        return FAILED
    study, origin = make_study(rows), provenance(measured)
    kept = _summary(notes, problems)
    try:
        if options.figures:
            _write(Path(options.figures), study, origin, kept)
    except OSError as error:
        print(f"analysis: {error.filename or options.figures}: {error.strerror}", file=sys.stderr)
        return FAILED
    except RunFolderError as error:
        print(f"analysis: {error}", file=sys.stderr)
        return FAILED
    print(json.dumps(data(study, origin, kept), indent=2, allow_nan=False) if options.json else text(study, origin))
    return FAILED if problems else 0


def _summary(notes, problems):
    """What the kept files say of runs left out, without this machine's paths."""
    counts = (
        (len(notes), "left out (not ended, of another scene, or without a compression)"),
        (len(problems), "not readable"),
    )
    return [f"{number} runs {what}" for number, what in counts if number]


def _write(folder, study, origin, notes):
    # matplotlib is slow to load, and the numbers do without it.
    from .figures import FIGURES, draw

    folder.mkdir(parents=True, exist_ok=True)
    drawn = []
    for name in progress(list(FIGURES), "drawing"):
        caption = draw(name, study, folder)
        if caption:
            drawn.append((f"{name}.png", caption))
    (folder / "comparison.md").write_text(markdown(study, origin, notes, drawn), encoding="utf-8")
    (folder / "comparison.json").write_text(
        json.dumps(data(study, origin, notes), indent=1, allow_nan=False) + "\n", encoding="utf-8"
    )
