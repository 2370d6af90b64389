"""Breaks copies of the code, one slip each, and runs the tests that must notice; writes build/mutations.md.

    python3 tests/mutations/run_mutations.py [WORD ...] [-j JOBS]

WORD: only mutations with one of these in their room, file or description; their results are printed, and not written.
First the expected tests run on unchanged code, where they must pass.
Exit status: 0 when all were caught, otherwise 1.
"""

import argparse
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent / "benchmarks")]
from codes import machine
from mutation import TOP, read

LONGEST = 3600  # s for the tests of one mutation
COMPILED = ("objects", "*.gch")  # of build/: only for a copy that compiles
HEAD = """# Mutations

Each row is a slip in the code that a test has to notice; `tests/mutations/*.toml` has the lines.
The tests expected to fail run on a copy with this one change, after they have passed without it.

`make test-mutations`, commit {commit}, {cpu}, {cores} cores, {minutes:.0f} minutes.

| where | what is wrong | noticed by |
|---|---|---|
"""


@dataclass(frozen=True)
class Result:
    """test: the first one that failed, None when none did; error: why it could not be tried, one line."""

    test: str = None
    error: str = None

    def __str__(self):
        return f"**not tried: {self.error}**" if self.error else f"`{self.test}`" if self.test else "**nothing**"


@contextmanager
def copy_of_the_tree(compiles):
    """Path of a copy of the work tree, with what make built, in a temporary folder."""
    with tempfile.TemporaryDirectory(prefix="mutation-") as top:
        command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
        listed = subprocess.run(command, cwd=TOP, capture_output=True, check=True, text=True).stdout.split("\0")
        for name in (name for name in listed if name and (TOP / name).exists()):
            (Path(top) / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(TOP / name, Path(top) / name)
        left_out = shutil.ignore_patterns("lint", "lammps", "docs", "newest", *(() if compiles else COMPILED))
        shutil.copytree(TOP / "build", Path(top) / "build", symlinks=True, ignore=left_out)
        yield Path(top)


def compiled(top):
    """Result of what doesn't compile, or None. The commit stays, so that only what changed is compiled."""
    commit = (top / "build" / "commit.list").read_text().strip()
    done = subprocess.run(["make", "-j2", f"COMMIT={commit}", "build"], cwd=top, capture_output=True, text=True)
    return Result(error=done.stderr.strip().splitlines()[-1]) if done.returncode else None


def tested(top, tests, jobs=0):
    """Result of these tests (paths); jobs: files at once."""
    command = [sys.executable, "-m", "pytest", "-q", "-x", "-rfE", "-p", "no:cacheprovider", *tests]
    command += ["-n", str(jobs), "--dist", "loadfile"]
    try:
        done = subprocess.run(command, cwd=top, capture_output=True, text=True, timeout=LONGEST)
    except subprocess.TimeoutExpired:
        return Result(error=f"no end within {LONGEST} s")
    if re.search(r"^E .*(no end within|TimeoutExpired)", done.stdout, re.MULTILINE):
        return Result(error="a test ran into its time limit, which says nothing: try again on a quiet machine")
    failed = re.search(r"^(?:FAILED|ERROR) (.+?)(?: - .*)?$", done.stdout, re.MULTILINE)
    if done.returncode == 0 or (done.returncode in (1, 2) and failed):  # 2: -x, with several files at once
        return Result(failed and failed.group(1))
    return Result(error=(done.stdout + done.stderr).strip().splitlines()[-1])


def tried(mutation):
    """Result of one mutation."""
    with copy_of_the_tree(mutation.plugin) as top:
        mutation.apply(top)
        return (compiled(top) if mutation.plugin else None) or tested(top, mutation.tests)


def main(arguments):
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("words", nargs="*", metavar="WORD")
    parser.add_argument("-j", "--jobs", type=int, default=os.cpu_count())
    options = parser.parse_args(arguments)
    begun, about = time.monotonic(), machine()
    chosen = [m for m in read() if not options.words or any(w in f"{m.room} {m.file} {m.wrong}" for w in options.words)]
    with copy_of_the_tree(False) as top:
        unchanged = tested(top, sorted({test for mutation in chosen for test in mutation.tests}), options.jobs)
    if unchanged.test or unchanged.error:
        print(f"run_mutations.py: without any mutation: {unchanged}; must pass", file=sys.stderr)
        return 1
    rows, missed = [], 0
    with ThreadPoolExecutor(options.jobs) as pool:
        for mutation, result in zip(chosen, pool.map(tried, chosen)):
            rows.append(f"| {mutation.room} | {mutation.wrong} | {result} |\n")
            print(rows[-1], end="", flush=True)
            missed += not result.test
    print(f"{len(chosen) - missed} of {len(chosen)} were noticed")
    if not options.words:
        head = HEAD.format(**about, minutes=(time.monotonic() - begun) / 60)
        (TOP / "build/mutations.md").write_text(head + "".join(rows))
    return 1 if missed else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
