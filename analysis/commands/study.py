"""python3 -m analysis study [NAME RUNS... [--figures FOLDER] [--page FILE] [--json | --format FORMAT]]"""

import json
import os
import tempfile
from contextlib import nullcontext
from pathlib import Path

from ..printable import printable, printable_lines
from . import FAILED, add_command, complain, with_ending


def add_parsers(commands):
    """Add the command to argparse's subparsers."""
    about = "figures and numbers of a study from many runs, beside the paper's; without a name: list the studies"
    parser = add_command(commands, study, about)
    parser.add_argument("name", nargs="?", metavar="NAME", help="a study, or a file NAME.py of one's own")
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
        help="write runs.csv (a row a run), comparison.csv and the figures there, and fill the table of its README.md",
    )
    parser.add_argument(
        "--page", metavar="FILE", type=with_ending(".html"), help="write one HTML page that can be sent"
    )
    output = parser.add_mutually_exclusive_group()
    output.add_argument(
        "--format", choices=("text", "json", "csv"), default="text", help="what to print (csv: a row a run)"
    )
    output.add_argument("--json", action="store_const", const="json", dest="format", help="the same as --format json")


def study(options):
    # pandas and scipy take a moment to load, and the parser does without them.
    from ..studies.comparison import counted, of_table, text_table
    from ..studies.gather import gather
    from ..studies.study import NAMES, find

    if not options.name:
        for name in NAMES:
            print(f"{name:<13}  {find(name).title}")
        return 0
    chosen = find(options.name)
    if not options.runs:
        complain(f"study {options.name}: no runs given; must be run folders, folders of them, or a runs.csv")
        return FAILED
    _require_places(options, chosen)
    found = gather(chosen, options.runs)
    for line in (*found.notes, *found.problems):
        complain(line)
    if found.table is None:
        if not found.problems:
            complain(f"no run of the study {options.name} to analyse")
        return FAILED
    runs = chosen.runs(found.table)
    rows = [row for row in chosen.rows(runs) if row.printed or row.word != "not run"]
    written = _write(options, chosen, found, runs, rows) if options.figures or options.page else None
    if options.format == "csv":
        print(found.csv(chosen), end="")
    elif options.format == "json":
        records = json.loads(of_table(rows).to_json(orient="records", double_precision=15))
        print(json.dumps({"study": chosen.name, "runs": len(found.table), "rows": records}, indent=1))
    else:
        print(printable_lines(f"{text_table(rows)}\n{counted(rows)}".rstrip("\n")))
        if written:
            print(printable(f"written: {written}"))
    return FAILED if found.problems else 0


def _require_places(options, study):
    """OSError where a file cannot be written, is one of several that are read, or is not of this study."""
    from ..runs.files import require_output
    from ..studies.gather import TABLE_FILE, require_own

    if options.page:
        require_output(options.page)
    if options.figures:
        file = Path(options.figures) / TABLE_FILE
        if not _is_only_input(file, options.runs):
            require_output(file, inputs=options.runs)
        require_own(file, study.name)


def _is_only_input(table, runs):
    """Whether a table is all that is read: then it stays as it is."""
    return [os.path.realpath(path) for path in runs] == [os.path.realpath(table)]


def _write(options, study, found, runs, rows):
    """Write tables, figures and page, as far as they are wanted; what to open first."""
    from ..runs.collect import provenance_lines
    from ..runs.files import write_file
    from ..studies.comparison import START, filled, html_page, of_table
    from ..studies.gather import TABLE_FILE

    with nullcontext(options.figures) if options.figures else tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        folder.mkdir(parents=True, exist_ok=True)
        readme = folder / "README.md"
        text = readme.read_text(encoding="utf-8") if readme.is_file() else ""
        if options.figures and not _is_only_input(folder / TABLE_FILE, options.runs):
            write_file(folder / TABLE_FILE, found.csv(study))
        write_file(folder / "comparison.csv", of_table(rows).to_csv(index=False, float_format="%.10g"))
        drawn = _draw(study, runs, folder, text if START in text else None)
        if options.page:
            options.page.parent.mkdir(parents=True, exist_ok=True)
            write_file(options.page, html_page(study, rows, drawn, list(provenance_lines(found.provenance))))
        if START in text:  # last: words that no longer hold are read beside the new numbers
            write_file(readme, filled(readme, text, rows, study.independent))
    return options.page or (readme if START in text else folder)


def _draw(study, runs, folder, readme):
    """[(caption, file)] of the figures that there is something to draw of; with a README (str) of those that it
    shows."""
    # matplotlib is slow to load, and the numbers do without it.
    from ..figures.style import save_small
    from ..progress import progress

    drawn = []
    for name, caption, figure in progress(study.figures(runs), "drawing"):
        file = folder / f"{name}.png"
        if figure is None and file.exists():
            complain(f"{file}: is of other runs; these have nothing to draw there")
        elif figure is not None and (readme is None or file.name in readme):
            save_small(figure, file)
            drawn.append((caption, file))
    return drawn
