"""python3 -m analysis status, verify: what has become of runs, and whether they are as they were written."""

import json
from dataclasses import asdict

from ..printable import printable
from . import FAILED, RUNS, complain


def add_parsers(commands):
    """Add the commands to argparse's subparsers."""
    parser = commands.add_parser(
        "status",
        help="what is done, running, waiting and failed, and the time left",
        description="Print what has become of each run, also of runs of other machines on a shared disk, with their "
        "host. Times left are by each run's own pace. Rows of a table that have not begun have no folder: "
        "yade_scripts/study.py TABLE --status counts them too.",
    )
    parser.add_argument("runs", nargs="+", metavar="RUNS", help=RUNS)
    parser.add_argument("--json", action="store_true", help="print JSON: a list with an object a run, times in s")
    parser.set_defaults(command=status)
    parser = commands.add_parser(
        "verify",
        help="compare runs that have ended with their sums",
        description="Read all files of each run and compare them with the SHA-256 that the run left of them; print "
        "what differs. `sha256sum -c ended` in a run folder does the same. Runs of versions before 0.5.0 have no sums.",
    )
    parser.add_argument("runs", nargs="+", metavar="RUNS", help=f"{RUNS}, a study's runs.csv, or a table of outcomes")
    parser.set_defaults(command=verify)


def status(options):
    """Exit status: 0, or 2 when a path holds no run or a run has failed."""
    from ..runs.collect import run_folders
    from ..runs.status import FAILED as HAS_FAILED
    from ..runs.status import line, state, total

    found = run_folders(options.runs)
    states = {str(path): state(path) for path, problem in found if not problem}
    problems = [problem for _, problem in found if problem]
    if options.json:
        print(json.dumps([{"run": name, **asdict(of_run)} for name, of_run in states.items()], indent=1))
    elif states:
        width = max(len(printable(name)) for name in states)
        for name, of_run in states.items():
            print(line(printable(name).ljust(width), of_run, of_run.left))
        print(total(states.values()))
    for problem in problems:
        complain(problem)
    return FAILED if problems or any(of_run.kind == HAS_FAILED for of_run in states.values()) else 0


def verify(options):
    """Exit status: 0, or 2 when something differs from its sum, a run has lost its sums, or no path holds a run."""
    from ..progress import line_beside_bars, progress
    from ..runs.collect import run_folders
    from ..runs.status import verify_run

    found, differs = run_folders(options.runs), False
    for path, problem in progress(found, "verifying"):
        problems, notes = ([problem], []) if problem else verify_run(path)
        differs |= bool(problems)
        for text in problems:
            complain(text)
        for text in notes:
            line_beside_bars(f"{path}: {text}")
    return FAILED if differs else 0
