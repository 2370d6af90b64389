"""Speed and error of this law's codes and of others', on the scenes of the bench and of the papers, in one report.

    /usr/bin/python3 tests/benchmarks/bench.py [--scene bench] [--quick | --tiny] [--only make,measure,report]

--scene: names, or groups of them: bench (sizes, unlike grains, moments of collisions, and the error against the step:
a collision), papers (moments of the papers' runs), peers (all codes, on a collision and an aggregate that rings:
throughput.py makes their page).
Three parts, one after the other: make the moments' files (build/bench/scenes; minutes for each of the papers' scenes of
100,000 grains), measure, report. Each can be stopped at any time and called again: files that are there, and what was
measured with the same plugin (its commit), machine and settings, are not done again. Results: speed.csv, moments.csv,
error.csv (results.py) and bench.md (tables).
--quick measures less, and writes to build/bench; --tiny only shows that it works.
"""

import argparse
import sys
from functools import cache, partial
from pathlib import Path

from measured_on import RESULTS, TOP, built_commit, machine

sys.path.insert(0, str(TOP))
import codes
import errors
import measured_scenes
import moments
import report
import settings
import speed
from results import Results

PARTS = ("make", "measure", "report")
say = partial(print, "bench:", flush=True)


def arguments(words=None):
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_const", dest="size", const="QUICK", help="a shortened version")
    parser.add_argument(
        "--tiny", action="store_const", dest="size", const="TINY", help="as little as shows that it works"
    )
    parser.add_argument("--scene", default="bench", help="scenes, or groups: bench, papers, peers")
    parser.add_argument("--only", default=",".join(PARTS), help="parts to do: " + ",".join(PARTS))
    parser.add_argument("--out", type=Path, help="folder for the results")
    given = parser.parse_args(words)
    given.settings = getattr(settings, given.size or "FULL")
    known = groups(given.settings)
    given.scene = [name for word in given.scene.split(",") for name in known.get(word, [word])]
    given.only = given.only.split(",")
    every = [name for names in known.values() for name in names]
    for option, names, allowed in (("scene", given.scene, [*known, *every]), ("only", given.only, PARTS)):
        if unknown := [name for name in names if name not in allowed]:
            parser.error(f"--{option} {unknown[0]}: must be of {', '.join(allowed)}")
    given.out = given.out or (TOP / "build/bench" if given.size else RESULTS)
    return given


def groups(how):
    """{name of a group: names of scenes, and of the errors' scenes}"""
    own = [*measured_scenes.bench(how), "collision"]
    return {"bench": own, "papers": [*measured_scenes.PAPERS], "peers": ["peers", *errors.FOLLOWED]}


def measure_speed(scenes, how, results):
    """Make and measure what is not done, one batch after the other."""
    wanted = {"commit": built_commit(), "cpu": machine()["cpu"], "settings": how.text()}
    changed = wanted["commit"].endswith("-changed")
    start = cache(lambda name: moments.make(name, scenes[name], say=say))
    for batch in speed.batches(scenes):
        if changed or not all(results.is_done(name, moment, **wanted) for name, _, moment in batch):
            starts = {name: start(name) for name, _, _ in batch}
            results.put(**speed.measure(batch, starts, how))
            say(f"{', '.join(f'{name} {moment}' for name, _, moment in batch)}: measured")


def measure_errors(names, how, results):
    of = {"cpu": machine()["cpu"], "commit": built_commit()[:7]}
    for name in names:
        there = results.error[results.error.scene == name]
        if not len(there) or any(there[key].iloc[0] != value for key, value in of.items()):
            say(f"error of {name} against the step")
            results.put(error=[{**row, **of} for row in errors.measure(name, how)])


def main():
    given = arguments()
    how, known = given.settings, measured_scenes.all_scenes(given.settings)
    scenes, results = {name: known[name] for name in given.scene if name in known}, Results(given.out)
    if "make" in given.only:
        for name, scene in scenes.items():
            moments.make(name, scene, say=say)
    if "measure" in given.only:
        say("keep the machine quiet meanwhile")
        for code in sorted({code for scene in scenes.values() for code in scene.codes}):
            if reason := codes.missing(code):
                say(f"without {code}: {reason}")
        measure_speed(scenes, how, results)
        measure_errors([name for name in given.scene if name not in known], how, results)
    if "report" in given.only:
        if not len(results.speed) + len(results.error):
            sys.exit(f"bench: {given.out} holds no measurement: must be measured first (--only measure)")
        text = report.text(results, how)
        (given.out / "bench.md").write_text(text)
        print(text)


if __name__ == "__main__":
    sys.exit(main())
