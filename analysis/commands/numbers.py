"""python3 -m analysis summary, outcome, status, verify: numbers of runs and of the collision atlas, what has become of
runs, and whether they are as they were written."""

import json
from dataclasses import asdict
from pathlib import Path

from ..printable import printable, printable_lines
from . import FAILED, RUNS, add_command, complain, number


def add_parsers(commands):
    """Add the commands to argparse's subparsers."""
    parser = add_command(
        commands,
        summary,
        "print outcome, compression and energies of runs",
        "Print a row a run: the parameters in which the runs differ, and what became of them; with --long compression "
        "(A24 eqs 10-13), outcome, restitution and the energy channels of each.",
        RUNS,
    )
    form = parser.add_mutually_exclusive_group()
    form.add_argument("--long", action="store_true", help="print all of each run")
    of_json = "print JSON, all in SI units: an object for one run folder, a list of objects for several; null: no value"
    form.add_argument("--json", action="store_true", help=of_json)
    _add_outcome(commands)
    parser = add_command(
        commands,
        status,
        "what is done, running, waiting and failed, and the time left",
        "Print what has become of each run, also of runs of other machines on a shared disk, with their host. Times "
        "left are by each run's own pace. Rows of a table that have not begun have no folder: "
        "yade_scripts/study.py TABLE --status counts them too.",
        RUNS,
    )
    parser.add_argument("--json", action="store_true", help="print JSON: a list with an object a run, times in s")
    add_command(
        commands,
        verify,
        "compare runs that have ended with their sums",
        "Read all files of each run and compare them with the SHA-256 that the run left of them; print what differs. "
        "`sha256sum -c ended` in a run folder does the same. Runs of versions before 0.5.0 have no sums.",
        RUNS,
    )


def summary(options):
    from ..report.rows import frame, long_text, measure, row, short_text, summarise

    if options.json:
        of_run = summarise
    elif options.long:
        of_run = lambda run: long_text(run, row(run, structure=False))
    else:
        of_run = lambda run: row(run, structure=False)
    measured, problems = measure(options.runs, of_run)
    found = [of for _, of in measured]
    if options.json and (measured or len(options.runs) > 1):
        one = len(options.runs) == 1 and measured[0][0] == Path(options.runs[0])
        print(json.dumps(found[0] if one else found, indent=2, allow_nan=False))
    elif measured:
        print(printable_lines("\n\n".join(found) if options.long else short_text(frame(measured))))
    for problem in problems:
        complain(problem)
    return FAILED if problems else 0


def _add_outcome(commands):
    parser = add_command(
        commands,
        outcome,
        "what becomes of a collision of two aggregates, from the collision atlas",
        "Probabilities of the outcomes of a collision of two aggregates, and what is left, from the tables of the "
        "collision atlas (analysis/gallery/atlas). With --impact it has intervals of 90 %; there are none where the "
        "answer is that of the nearest data.",
    )
    add = parser.add_argument
    positive = number(lambda value: 0 < value < float("inf"), "a number > 0")
    add("--velocity", type=positive, required=True, metavar="X", help="relative velocity [m/s]")
    add("--projectile", type=float, required=True, metavar="X", help="grains of one aggregate")
    add("--target", type=float, required=True, metavar="X", help="grains of the other")
    of_filling = "volume filling factor of both, of spheres of radius (5/3)^(1/2) R_g"
    add("--filling", type=float, required=True, metavar="X", help=of_filling)
    of_impact = "impact parameter, 0 to 1, over the sum of these radii (default: averaged, uniform in b^2)"
    add("--impact", type=float, metavar="B", help=of_impact)
    of_maxwell = "velocity is the root mean square of a Maxwell distribution of speeds"
    add("--maxwell", action="store_true", help=of_maxwell)
    of_structure = "grown: by hits of grains and clusters, or compressed; close-packed: a dense packing without some "
    of_structure += "of its grains, which bounces far more often"
    add("--structure", default="grown", help=of_structure)
    add("--material", default="ice", help="of the grains, ice or silicate")
    of_radius = "of the grains [m] (default: that of the material, 1e-07 of ice and 6e-07 of silicate)"
    add("--grain-radius", type=float, metavar="R", help=of_radius)
    add("--surface-energy", type=positive, metavar="X", help="of the grains [J/m^2] (default: that of the material)")
    add("--young", type=positive, metavar="X", help="Young's modulus [Pa] (likewise)")
    add("--density", type=positive, metavar="X", help="of the grains [kg/m^3] (likewise)")


def outcome(options):
    from ..atlas.query import in_words

    try:
        lines = list(in_words(options))
    except ValueError as error:
        complain(error)
        return FAILED
    print(printable_lines("\n".join(lines)))
    return 0


def status(options):
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
    from ..progress import line_beside_bars, progress
    from ..runs.collect import run_folders
    from ..runs.status import verify_run

    differs = False
    for path, problem in progress(run_folders(options.runs), "verifying"):
        problems, notes = ([problem], []) if problem else verify_run(path)
        differs |= bool(problems)
        for text in problems:
            complain(text)
        for text in notes:
            line_beside_bars(f"{path}: {text}")
    return FAILED if differs else 0
