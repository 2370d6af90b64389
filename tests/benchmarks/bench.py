"""make bench: speed of every code on the same grains, speed through a collision, and error against the time step, in one run.

    /usr/bin/python3 tests/benchmarks/bench.py [--quick | --tiny] [--only speed,collision,error] [--out FOLDER]

Writes bench.json (everything measured), bench.md (tables, and whether each target is reached) and figures, all with the commit and the machine.
--quick measures less, in some three minutes, and writes to build/bench; --tiny only shows that it works.
"""

import argparse
import dataclasses
import json
import sys
from pathlib import Path

from measured_on import RESULTS, TOP, machine

sys.path.insert(0, str(TOP))
import errors  # noqa: E402
import figures  # noqa: E402
import paper_moments  # noqa: E402
import paper_report  # noqa: E402
import peers  # noqa: E402
import report  # noqa: E402
import settings  # noqa: E402
import speed  # noqa: E402
import whole_collision  # noqa: E402

from yade_scripts.run.progress import progress_bar  # noqa: E402
from yade_scripts.runner.view import duration_text  # noqa: E402

PARTS = {"speed": speed, "collision": whole_collision, "error": errors}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    size = parser.add_mutually_exclusive_group()
    size.add_argument("--quick", action="store_const", dest="size", const="quick", help="a shortened version")
    size.add_argument(
        "--tiny", action="store_const", dest="size", const="tiny", help="as little as shows that it works"
    )
    parser.add_argument("--only", default=",".join(PARTS), help="parts to measure: " + ",".join(PARTS))
    parser.add_argument("--out", type=Path, help="folder for the results")
    given = parser.parse_args()
    given.only = given.only.split(",")
    if unknown := [name for name in given.only if name not in PARTS]:
        parser.error(f"--only: no part {unknown[0]}; must be of {', '.join(PARTS)}")
    given.out = given.out or (TOP / "build/bench" if given.size else RESULTS)
    return given


class Done:
    """Adds up the estimated seconds of what is done, for the progress bar."""

    def __init__(self, total):
        self.progress, self.total, self.seconds = progress_bar(total, unit="s"), total, 0.0

    def __call__(self, seconds):
        new = min(self.total, self.seconds + seconds) - self.seconds
        self.seconds += new
        self.progress.update(new)


def main():
    given = arguments()
    how = getattr(settings, (given.size or "full").upper())
    total = sum(PARTS[name].estimate(how) for name in given.only)
    print(f"bench: about {duration_text(total)}; keep the machine quiet meanwhile", flush=True)
    missing = {code: reason for code in peers.PROGRAMS if (reason := peers.missing(code))}
    for code, reason in missing.items():
        print(f"bench: without {code}: {reason}", flush=True)
    done = Done(total)
    found = {
        "machine": machine(),
        "settings": dataclasses.asdict(how),
        "missing": missing,
        "versions": {code: peers.version(code) for code in peers.PROGRAMS if code not in missing},
    }
    for name in given.only:
        found[name] = PARTS[name].measure(how, done)
    done.progress.close()
    given.out.mkdir(parents=True, exist_ok=True)
    (given.out / "bench.json").write_text(json.dumps(found, indent=1))
    text = paper_report.with_section(report.text(how, found), paper_report.text(paper_moments.read(given.out)))
    (given.out / "bench.md").write_text(text)
    figures.draw(how, found, given.out)
    print(text)


if __name__ == "__main__":
    sys.exit(main())
