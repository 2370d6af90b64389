"""python3 -m analysis status RUNS... [--json]"""

import json
from dataclasses import asdict

from ..printable import printable
from . import FAILED as EXIT_FAILED
from . import complain


def add_parser(commands):
    """Add the command to argparse's subparsers."""
    from ..runs.status import SILENCE

    parser = commands.add_parser(
        "status",
        help="what is done, running, waiting and failed, and the time left",
        description="Print what has become of each run, also of runs of other machines on a shared disk, with their host. Running is "
        "what holds its folder's lock, runs by Slurm or has a heartbeat; of a version without heartbeats what wrote something in "
        f"the last {SILENCE:.0f} s. Times left are by each run's own pace. Rows of a "
        "table that have not begun have no folder: yade_scripts/study.py TABLE --status counts them too.",
    )
    parser.add_argument(
        "runs", nargs="+", metavar="RUNS", help="run folder, or folder that holds run folders (one or two levels below)"
    )
    parser.add_argument("--json", action="store_true", help="print JSON: a list with an object a run, times in s")
    parser.set_defaults(command=run)


def run(options):
    """Exit status: 0, or 2 when a path holds no run or a run has failed."""
    from ..report.status import line
    from ..runs.collect import run_folders
    from ..runs.status import FAILED, state

    names, states, problems = [], [], []
    for path, error in run_folders(options.runs):
        if error:
            problems.append(error)
        else:
            names.append(str(path))
            states.append(state(path))
    if options.json:
        print(json.dumps([{"run": name, **asdict(s)} for name, s in zip(names, states, strict=True)], indent=1))
    elif states:
        width = max(len(printable(name)) for name in names)
        for name, of_run in zip(names, states, strict=True):
            print(line(printable(name).ljust(width), of_run, of_run.left))
        print(_total(states))
    for problem in problems:
        complain(problem)
    return EXIT_FAILED if problems or any(s.kind == FAILED for s in states) else 0


def _total(states):
    """The line below: how many of each, and the time left."""
    from ..report.status import counts, duration_text
    from ..runs.status import RUNNING, WAITING

    text = f"{len(states)} runs: {counts(states)}"
    for kind, sum_up, what in (
        (RUNNING, max, "left until the last running one ends"),
        (WAITING, sum, "for the waiting ones, one after another"),
    ):
        left = [s.left for s in states if s.kind == kind]
        if left:
            text += "; " + ("unknown time" if None in left else duration_text(sum_up(left))) + f" {what}"
    return text
