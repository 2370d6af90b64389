"""make bench-papers: speed on the scenes of the papers, at several moments of each run, and each run's time to solution.

    /usr/bin/python3 tests/benchmarks/bench_papers.py [--scene a22,k13] [--quick] [--only make,measure,report] [--again] [--out FOLDER]

Three parts, one after the other: make the moments' files (build/bench/scenes; minutes for each scene of 100,000 grains), measure them (half a minute each),
report. Each can be stopped at any time and called again: files that are there, and moments that were measured with the same plugin (its commit) and settings,
are not done again (--again measures all anew). Results: papers.json, a figure, and a section of bench.md, which keeps the rest of that file.
--quick measures less, and writes to build/bench.
"""

import argparse
import json
import sys
from pathlib import Path

from measured_on import RESULTS, TOP, machine

sys.path.insert(0, str(TOP))
import paper_figure  # noqa: E402
import paper_moments  # noqa: E402
import paper_report  # noqa: E402
import paper_scenes  # noqa: E402
import paper_speed  # noqa: E402
from paper_moments import RESULT, read  # noqa: E402

PARTS = ("make", "measure", "report")


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--scene", default=",".join(paper_scenes.SCENES), help="of " + ", ".join(paper_scenes.SCENES))
    parser.add_argument("--quick", action="store_true", help="a shortened version")
    parser.add_argument("--only", default=",".join(PARTS), help="parts to do: " + ",".join(PARTS))
    parser.add_argument("--again", action="store_true", help="measure again what has been measured")
    parser.add_argument("--out", type=Path, help="folder for the results")
    given = parser.parse_args()
    given.scene, given.only = given.scene.split(","), given.only.split(",")
    for option, names, known in (("scene", given.scene, paper_scenes.SCENES), ("only", given.only, PARTS)):
        if unknown := [name for name in names if name not in known]:
            parser.error(f"--{option} {unknown[0]}: must be of {', '.join(known)}")
    given.out = given.out or (TOP / "build/bench" if given.quick else RESULTS)
    return given


def write(folder, found):
    folder.mkdir(parents=True, exist_ok=True)
    new = folder / (RESULT + ".new")
    new.write_text(json.dumps(found, indent=1))
    new.replace(folder / RESULT)


def is_done(result, settings):
    """Whether a moment was measured with the plugin that is built now, and with these settings."""
    commit = (TOP / "build/commit.list").read_text().strip()
    measured = bool(result) and result["settings"] == paper_speed.settings_of(settings)
    return measured and result["engine"]["commit"] == commit and not commit.endswith("-changed")


def measure(names, settings, folder, again):
    """Measure every moment of these scenes, and write papers.json after each. Moments without a file are left out, with a line."""
    for name in names:
        begin = None
        for moment, path in ((one, paper_scenes.path_of(name, one)) for one in paper_scenes.SCENES[name].moments):
            found = read(folder)
            of_scene = found["scenes"].setdefault(name, {})
            if not path.exists():
                print(f"bench-papers: {name}, {moment}: has no file yet (--only make)", flush=True)
                continue
            if not again and is_done(of_scene.get(moment), settings):
                continue
            begin = begin or paper_scenes.start_of(paper_scenes.SCENES[name])
            of_scene[moment] = result = paper_speed.measure(name, moment, settings, begin)
            found["machine"] = machine()
            write(folder, found)
            one = paper_moments.Moment(name, moment, result)
            print(f"bench-papers: {name}, {moment}: {one.best(1):.3g} and {one.best(2):.3g} ms a step", flush=True)


def report(folder):
    """The section of bench.md, and the figure."""
    found = read(folder)
    section = paper_report.text(found)
    if not section:
        sys.exit(f"bench-papers: {folder / RESULT} holds no measurement: must be measured first (--only measure)")
    bench = folder / "bench.md"
    bench.write_text(paper_report.with_section(bench.read_text() if bench.exists() else "", section))
    paper_figure.draw(found, folder)
    return section


def main():
    given = arguments()
    settings = paper_speed.QUICK if given.quick else paper_speed.FULL
    for name in given.scene if "make" in given.only else ():
        paper_scenes.make(name, say=lambda words, **how: print(f"bench-papers: {words}", **how))
    if "measure" in given.only:
        measure(given.scene, settings, given.out, given.again)
    if "report" in given.only:
        print(report(given.out))


if __name__ == "__main__":
    sys.exit(main())
