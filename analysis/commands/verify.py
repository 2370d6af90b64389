"""python3 -m analysis verify RUNS..."""

from pathlib import Path

from ..progress import line_beside_bars
from . import FAILED, complain

OF_STUDIES = "runs.csv", "comparison.json"


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    parser = commands.add_parser(
        "verify",
        help="compare runs that have ended, and tables of runs, with their sums",
        description="Read all files of each run and compare them with the SHA-256 that the run left of them; print what differs. "
        "`sha256sum -c ended` in a run folder does the same. What runs of versions before 0.5.0 have left has no sums.",
    )
    parser.add_argument(
        "runs",
        nargs="+",
        metavar="RUNS",
        help="run folder, folder that holds run folders, a pattern such as 'runs/**', a study's runs.csv or comparison.json, or a table of outcomes",
    )
    parser.set_defaults(command=run)


def run(options):
    """Exit status: 0, or 2 when something differs from its sum, a run has lost its list of sums and its parameters, or no path holds a run."""
    from ..progress import progress
    from ..runs.collect import LOST, is_lost, run_folders
    from ..runs.files import begins_with_sum
    from ..runs.verify import verify_run, verify_text

    texts = [
        Path(path) for path in options.runs if Path(path).suffix in (".csv", ".json", ".txt") and Path(path).is_file()
    ]
    folders = [Path(path) for path in options.runs if Path(path).is_dir()]
    places = [path for folder in folders for path in (folder, folder / "figures")]
    texts += [file for place in places for name in OF_STUDIES if begins_with_sum(file := place / name)]
    found, differs = run_folders([path for path in options.runs if Path(path) not in texts]), False
    found += [(None, f"{folder}: {LOST}") for folder in folders if is_lost(folder)]
    for path, problem in progress([*((text, None) for text in texts), *found], "verifying"):
        problems, said = ([problem], []) if problem else verify_text(path) if path in texts else verify_run(path)
        differs |= bool(problems)
        for line in problems:
            complain(line)
        for line in said:
            line_beside_bars(f"{path}: {line}")
    return FAILED if differs else 0
