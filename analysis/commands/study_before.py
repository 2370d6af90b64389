"""python3 -m analysis study [NAME RUNS... [--figures FOLDER] [--page FILE] [--json | --format FORMAT]]"""

import argparse
import os
import tempfile
from contextlib import contextmanager
from pathlib import Path

from ..printable import printable, printable_lines, shell_line
from . import FAILED, complain

FORMATS = {"text": "text", "markdown": "markdown", "json": "json", "csv": "csv"}


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "study",
        help="figures and numbers of a study from many runs, beside the paper's; without a name: list the studies",
        description="Fit and draw what a study does from runs of its scene, and print the numbers beside the paper's. "
        "Without a name: list the studies.",
    )
    parser.add_argument(
        "name", nargs="?", metavar="NAME", help="name of a study, or a file NAME.py of one's own that defines STUDY"
    )
    parser.add_argument(
        "runs",
        nargs="*",
        metavar="RUNS",
        help="run folder, folder that holds run folders (one or two levels below), or runs.csv of an earlier "
        "analysis; runs that have not ended or are of another scene are left out with a note on stderr",
    )
    parser.add_argument(
        "--figures",
        metavar="FOLDER",
        help="write README.md, details.md, comparison.json, runs.csv (a row a run) and the figures there; made if it is missing",
    )
    parser.add_argument(
        "--page",
        metavar="FILE",
        type=_page_file,
        help="write one HTML page with everything in it, to be sent to others, a page FILE-view.html to turn a run, and a PDF where weasyprint "
        "or chromium is installed",
    )
    output = parser.add_mutually_exclusive_group()
    output.add_argument("--format", choices=FORMATS, default="text", help="what to print (csv: a row a run)")
    output.add_argument(
        "--json",
        action="store_const",
        const="json",
        dest="format",
        help="print JSON (SI units unless a unit is named): --format json",
    )
    parser.set_defaults(command=run)


def _page_file(text):
    if Path(text).suffix != ".html":
        raise argparse.ArgumentTypeError(f"{text}: must end in .html")
    return Path(text)


def run(options):
    """Exit status: 0, or 2 when a path or run could not be read or nothing was left to analyse."""
    # pandas and scipy take a moment to load, and the parser does without them.
    from ..studies.analyse import NothingToAnalyse, analyse
    from ..studies.find import find

    if not options.name:
        return _list()
    study = find(options.name)
    if not options.runs:
        complain(f"study {options.name}: of which runs? Give run folders, folders of them, or a runs.csv")
        return FAILED
    table = _writes_table(options, study.name)
    try:
        analysis = analyse(study, options.runs)
    except NothingToAnalyse as nothing:
        _complain_of(nothing.found)
        if not nothing.found.problems:
            complain(nothing)
        return FAILED
    _complain_of(analysis.found)
    written = _write(analysis, options, table) if options.figures or options.page else None
    text = getattr(analysis, options.format)().rstrip("\n")
    print(text if options.format == "csv" else printable_lines(text))
    if written and options.format == "text":
        print(printable(f"written: {written}"))
    return FAILED if analysis.found.problems else 0


def _writes_table(options, study):
    """Whether a table is written: not in the place of all that is read, which holds the same runs. OSError where a file cannot be
    written, is one of several that are read, or is somebody else's."""
    from ..runs.files import require_output
    from ..studies.analyse import TABLE_FILE, require_own

    if options.page:
        require_output(options.page)
    if not options.figures:
        return True
    require_own(Path(options.figures), study)
    file = os.path.join(options.figures, TABLE_FILE)
    if [os.path.realpath(path) for path in options.runs] == [os.path.realpath(file)]:
        return False
    require_output(file, inputs=options.runs)
    return True


def _write(analysis, options, table):
    """Figures and page, as far as they are wanted; what to open first."""
    with _folder(options.figures) as folder:
        written = analysis.write(folder, table, tuple(_commands(options)))
        for name in written.undrawn:
            complain(f"{name}: not drawn: it needs the run folders, a table has only their numbers")
        if options.page:
            options.page.parent.mkdir(parents=True, exist_ok=True)
            _write_page(options.page, analysis.page(written, _write_view(options.page, analysis.found.table)))
    return options.page or folder / "README.md"


@contextmanager
def _folder(wanted):
    """The folder for figures: the one that is wanted, or one that goes when the page holds them."""
    if wanted:
        yield Path(wanted)
    else:
        with tempfile.TemporaryDirectory() as folder:
            yield Path(folder)


def _write_view(page, table):
    """The page on which the first run that is at hand can be turned, beside the study's: (name of its file, the run's), or None."""
    from ..export.viewer import NoThree, write_view
    from ..runs.files import RunFolderError
    from ..runs.folder import open_run
    from ..runs.table import FOLDER

    file = page.with_name(f"{page.stem}-view.html")
    folder = next((folder for folder in table[FOLDER].dropna() if os.path.isdir(folder)), None)
    if folder is None:
        return None
    try:
        return write_view(open_run(folder), file).name, os.path.basename(folder)
    except (NoThree, RunFolderError) as error:
        complain(f"{file}: not written: {error}")
        return None


def _write_page(file, text):
    """The page and its PDF."""
    from ..report.pdf import NoPdf, write_pdf
    from ..runs.files import write_file

    pdf = file.with_suffix(".pdf")
    write_file(file, text)
    try:
        write_pdf(file, pdf)
    except NoPdf as error:
        complain(f"{pdf}: {error}" + ("; what is there is of an earlier page" if pdf.exists() else ""))


def _commands(options):
    """How to make it again, without this machine's folders."""
    words = (
        path if not os.path.isabs(path) else os.path.basename(os.path.normpath(path))
        for path in (options.name, *options.runs)
    )
    yield f"python3 -m analysis study {shell_line(words)} --figures FOLDER --page FILE.html"


def _list():
    from ..studies.find import find, names

    width = max(map(len, names()))
    for name in names():
        print(f"{name:<{width}}  {find(name).title}")
    return 0


def _complain_of(found):
    for line in (*found.notes, *found.shown, *found.problems):
        complain(line)
