"""Tries every fault at every file-system call of every scenario (faults/scenarios.py), and writes results/faults.md.

    python3 tests/persistence/enumerate_faults.py [-j JOBS] [--out FILE]      six to twenty minutes on two cores

Exit status: 0 when nothing was lost, otherwise 1, with one line on stderr for each case.
"""

import argparse
import os
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "benchmarks")]
from conftest import fast_folder
from faults.forks import Forks
from faults.scenarios import ACTIONS, SCENARIOS, Bench, enumerated, enumerated_stops
from measured_on import machine

STOPS = "a new run, SIGTERM in its third checkpoint"
HEAD = """# Faults, one at each file-system call

A run of a few grains, with a checkpoint after each of its six steps and four states, is repeated for each call that changes
a file below its run folder. Before this call, or after half of the bytes of a write, the process is ended by SIGKILL; or from
this call on the disk is full. Afterwards the run is called again as a user or `study.py` would. Lost means one of these: it
doesn't come to its end, it ends with other bits than a run without faults, a checkpoint that was there is gone, a folder marked
as ended holds something else, or the full disk gave more than one line. After SIGTERM the process is ended at each call up to
the end of the next checkpoint.

`make test-faults`, commit {commit}, {cpu}, {cores} cores, {minutes:.0f} minutes.

| run | fault | cases | lost |
|---|---|---:|---:|
"""


def jobs():
    """(scenario's name, fault) of every row of the table."""
    return [(scenario.name, fault) for scenario in SCENARIOS for fault in ACTIONS] + [(STOPS, "ends before")]


def tried(job):
    """(job, [Case])."""
    name, fault = job
    with fast_folder() as folder:
        forks = Forks(folder)
        bench = Bench(forks, folder)
        if name == STOPS:
            cases = list(enumerated_stops(bench, 2))
        else:
            cases = list(enumerated(bench, next(s for s in SCENARIOS if s.name == name), (fault,)))
        forks.close()
    return job, cases


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--out", type=Path, default=HERE / "results" / "faults.md")
    options = parser.parse_args(arguments)
    begun, rows, lost = time.monotonic(), [], []
    with ProcessPoolExecutor(options.jobs) as pool:
        for (name, fault), cases in pool.map(tried, jobs()):
            wrong = [case for case in cases if case.wrong]
            rows.append(f"| {name} | {fault} | {len(cases)} | {len(wrong)} |\n")
            print(rows[-1], end="", flush=True)
            lost += [f"{case.scenario}: {case.fault} call {case.call}: {'; '.join(case.wrong)}" for case in wrong]
    options.out.parent.mkdir(exist_ok=True)
    head = HEAD.format(**machine(), minutes=(time.monotonic() - begun) / 60)
    options.out.write_text(head + "".join(rows) + "".join(f"\n- {line}" for line in lost))
    for line in lost:
        print(f"enumerate_faults.py: {line}", file=sys.stderr)
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
