"""Tries faults at the file-system calls of every command that writes files (faults/), and writes results/faults.md.

    python3 tests/persistence/enumerate_faults.py [NAME ...] [-j JOBS]      an hour on two cores

NAME: lines of the table, by default all; the others stay as they are. Exit status: 0 when all was right, otherwise 1, with
one line on stderr for each case.
"""

import argparse
import os
import sys
from concurrent.futures import ProcessPoolExecutor
from pathlib import Path

HERE = Path(__file__).resolve().parent
TESTS = HERE.parent
sys.path[:0] = map(str, (HERE.parents[1], HERE, TESTS, TESTS / "scripts", TESTS / "benchmarks"))
from conftest import fast_folder
from faults.commands import COMMANDS, SCENARIOS, WRITERS
from faults.forks import DISK_FULL, Forks
from faults.trial import ACTIONS, Trial
from measured_on import machine

PAGE = HERE / "results" / "faults.md"
STOPS = "collide: a new run, SIGTERM in its third checkpoint"
HEAD = """# Faults, one at each file-system call

Each command is repeated for each call (or every so many) with which it changes a file of its output. Before this call, or after half of the bytes
of a write, the process is ended by SIGKILL; or from this call on the disk is full. Then it is called again as a user would. Right means: every file
is afterwards the one that was there or the one that the command writes, never half of one; the full disk gave one line and a status that says
so; the second call comes to its end with the same bytes as a call without faults, and leaves no temporary file. Of runs, the bits of history and states count,
once they are marked as ended; of collisions also that no checkpoint that was there is gone. What processes write that a command
starts (workers of `study`, ffmpeg, the browser that prints PDF) is not counted; sbatch and squeue are programs of this test (`make test-slurm` has
the real ones); `install` and `uninstall` replace and remove an installation.

`make test-faults`, last on {cpu}, {cores} cores.

| command | calls | tried at every | kills | full disks | right | commit |
|---|---:|---:|---:|---:|---:|---|
"""
FOOT = """
Of the modules that write files (faults/commands.py has all) these have no line of their own:

{}
"""


NAMES = [command.name for command in COMMANDS]
NAMES.insert(len(SCENARIOS), STOPS)


def tried(name):
    """(name, calls, of how many one is tried, [Case]) of a line of the table."""
    with fast_folder() as folder:
        forks = Forks(folder)
        (folder / "trial").mkdir()
        command = next((command for command in COMMANDS if command.name == name), SCENARIOS[0])
        trial = Trial(forks, command, folder / "trial")
        cases = list(trial.stops(2) if name == STOPS else trial.cases())
        forks.close()
    return name, len(trial.calls), command.every, cases


def line(name, calls, every, cases, commit):
    """Of the table."""
    full = sum(ACTIONS[case.fault] == DISK_FULL for case in cases)
    right = sum(not case.wrong for case in cases)
    return f"| {name} | {calls} | {every} | {len(cases) - full} | {full} | {right} of {len(cases)} | {commit} |\n"


def page(lines, about):
    """Text of the page of {name: line}."""
    none = [f"- `{module}`: {why}" for module, why in WRITERS.items() if why not in {*NAMES, "collide"}]
    own = "".join(lines[name] for name in NAMES if name in lines)
    return HEAD.format(**about) + own + FOOT.format("\n".join(none))


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("names", nargs="*", metavar="NAME")
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args(arguments)
    for name in set(options.names) - set(NAMES):
        parser.error(f"{name}: must be one of {', '.join(NAMES)}")
    wrong, about = [], machine()
    with ProcessPoolExecutor(options.jobs) as pool:
        for name, *found in pool.map(tried, options.names or NAMES):
            text = line(name, *found, about["commit"])
            print(text, end="", flush=True)
            wrong += [case for case in found[-1] if case.wrong]
            there = (text for text in PAGE.read_text().splitlines(keepends=True) if text.startswith("| "))
            lines = {**{text.split(" | ")[0].removeprefix("| "): text for text in there}, name: text}
            PAGE.write_text(page(lines, about))
    for case in wrong:
        words = f"{case.command}: {case.fault} call {case.call}: {'; '.join(case.wrong)}"
        print(f"enumerate_faults.py: {words}", file=sys.stderr)
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
