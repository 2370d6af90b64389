"""python3 -m analysis study [NAME RUNS... [--figures FOLDER] [--json | --format FORMAT]]"""

from pathlib import Path

from . import FAILED, complain

FORMATS = ("text", "markdown", "json", "csv")
TABLE_FILE, PAGE_FILE, DATA_FILE = "runs.csv", "comparison.md", "comparison.json"


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    from ..studies.find import names

    parser = commands.add_parser(
        "study",
        help="figures and numbers of a study from many runs, beside the paper's; without a name: list the studies",
        description="Fit and draw what a study does from runs of its scene, and print the numbers beside the paper's. "
        "Without a name: list the studies.",
    )
    parser.set_defaults(command=_list)
    studies = parser.add_subparsers(metavar="NAME")
    for name in names():
        _add_study(studies.add_parser(name, description=f"The study {name}: analysis/studies/{name}."), name)


def _add_study(parser, name):
    parser.add_argument(
        "runs",
        nargs="+",
        metavar="RUNS",
        help=f"run folder, folder that holds run folders (one or two levels below), or {TABLE_FILE} of an earlier "
        "analysis; runs that have not ended or are of another scene are left out with a note on stderr",
    )
    parser.add_argument(
        "--figures",
        metavar="FOLDER",
        help=f"write {PAGE_FILE}, {DATA_FILE}, {TABLE_FILE} (a row a run) and the figures there; made if it is missing",
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
    parser.set_defaults(command=run, name=name)


def run(options):
    """Exit status: 0, or 2 when a path or run could not be read or nothing was left to analyse."""
    from ..studies.find import find

    return _analyse(find(options.name), options)


def _list(options):
    from ..studies.find import find, names

    for name in names():
        print(f"{name:<16} {find(name).title}")
    return 0


def _analyse(study, options):
    from ..report.section import Report
    from ..runs.arrays import RunFolderError
    from ..studies.gather import gather

    found = gather(study, options.runs)
    for line in (*found.notes, *found.problems):
        complain(line)
    if found.table is None:
        if not found.problems:
            complain(f"no run of {study.scene.name} to analyse")
        return FAILED
    try:
        results = study.results(found.table)
        sections, remarks = tuple(study.sections(results)), tuple(study.remarks(results))
        report = Report(study.name, study.title, found.provenance, remarks, tuple(_kept(found)), sections)
        if options.figures:
            _write(Path(options.figures), study, report, found, results)
    except OSError as error:
        complain(f"{error.filename or options.figures}: {error.strerror}")
        return FAILED
    except RunFolderError as error:
        complain(error)
        return FAILED
    print(_printed(options.format, study, report, found))
    return FAILED if found.problems else 0


def _kept(found):
    """What the files say of runs left out, without this machine's paths."""
    yield from found.earlier
    if found.notes:
        yield f"{len(found.notes)} runs left out (not ended, of another scene, or with nothing to measure)"
    if found.problems:
        yield f"{len(found.problems)} runs not readable"


def _printed(wanted, study, report, found):
    from ..report.data import json_text
    from ..report.markdown import markdown
    from ..report.text import text

    if wanted == "csv":
        return _csv(study, report, found).rstrip("\n")
    if wanted == "json":
        return json_text(report).rstrip("\n")
    return markdown(report).rstrip("\n") if wanted == "markdown" else text(report)


def _csv(study, report, found):
    from ..runs.table import table_text

    head = {"study": study.name, "provenance": report.provenance, "notes": list(report.notes)}
    return table_text(found.table, study.columns, head)


def _write(folder, study, report, found, results):
    from ..report.data import json_text
    from ..report.markdown import markdown

    folder.mkdir(parents=True, exist_ok=True)
    (folder / TABLE_FILE).write_text(_csv(study, report, found), encoding="utf-8")
    (folder / DATA_FILE).write_text(json_text(report), encoding="utf-8")
    drawn = list(_draw(folder, study, results))
    (folder / PAGE_FILE).write_text(markdown(report, drawn), encoding="utf-8")


def _draw(folder, study, results):
    """(file name, caption) of the figures that are there."""
    # matplotlib is slow to load, and the numbers do without it.
    from tqdm import tqdm

    from ..figures.save import save_small
    from ..runs.table import NoRunFolder
    from ..studies.find import figures

    for figure in tqdm(figures(study.name), "drawing", disable=None, leave=False):
        file = folder / f"{figure.name}.png"
        try:
            drawn = figure.draw(results)
        except NoRunFolder:
            complain(f"{figure.name}: not drawn: it needs the run folders, a table has only their numbers")
            if file.exists():
                yield file.name, figure.caption
            continue
        if drawn is None:
            file.unlink(missing_ok=True)
            continue
        save_small(drawn, file)
        yield file.name, figure.caption
