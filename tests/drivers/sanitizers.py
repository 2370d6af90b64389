"""The sanitizers of addresses, undefined behaviour and threads on the engine, the kernel, the functors and checkpoints. Run by `make test-sanitizers`.

    python3 tests/drivers/sanitizers.py      a quarter of an hour on two cores

The last commit is cloned into build/sanitizers and compiled there once for each trial. Scenes of the harness are made with the ordinary build.
Compiled by clang, as g++ takes more than ten times as long for the engine's passes; what sees YADE's types by g++, as YADE was. Threads are looked at in
the harness alone, where clang's OpenMP tells the sanitizer when a parallel region begins and ends (Archer); YADE's does not, and every region would be
a finding.
Exit status: 0 when nothing was found and all passed, otherwise 1.
"""

import os
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass
from itertools import chain
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1]), str(HERE), str(HERE.parent / "benchmarks"), str(HERE.parent)]
import moments
from debian_systems import last_commit_in, run, write_page
from measured_on import TOP, machine
from test_harness import SMALL

FOLDER = TOP / "build/sanitizers"
COMPILER = "clang++-14"
FINDINGS = ("ERROR: AddressSanitizer", "runtime error: ", "WARNING: ThreadSanitizer")
IN_YADE = (
    "tests/physics/test_pairs.py",
    "tests/persistence/test_save_load.py",
    "tests/persistence/test_damaged_checkpoints.py",
    "tests/persistence/test_periodic_checkpoint.py",
    "tests/equivalence",
    "tests/hard_cases",
)
# YADE's own: where a second thread's numbers need more room, it copies as many bytes as the new place has (OpenMPArrayAccumulator::resize), and
# clears those beyond the old ones.
YADES = "interceptor_via_fun:yade::EnergyTracker::add"
HEAD = """# Sanitizers

`make test-sanitizers`, commit {commit}, {cpu}, {cores} cores. {version}.
YADE itself is Debian's and not instrumented: what it does with memory that the plugin gave it is seen only where it calls malloc, free or memcpy.
Left out is one finding in YADE: with two threads EnergyTracker::add reads up to a cache line too much, and then clears what it read.

| sanitizers | what ran | result | findings | time [s] |
|---|---|---|---:|---:|
"""


@dataclass
class Trial:
    """A clone compiled with sanitizers, in a folder of its name."""

    sanitize: str  # as -fsanitize has it

    @property
    def clone(self):
        return FOLDER / self.sanitize

    def make(self, goal):
        """Compile what make calls `goal`, of the last commit."""
        last_commit_in(self.clone)
        how = [f"SANITIZE={self.sanitize}", f"CXX={COMPILER}", "YADE_CXX=g++"]
        run(["make", f"-j{os.cpu_count()}", *how, goal], cwd=self.clone)

    def row(self, what, command, **more):
        """A line of the table for a command, and whether it passed with nothing found."""
        with tempfile.TemporaryDirectory() as folder:
            log, known = f"log_path={folder}/found", Path(folder) / "known"
            known.write_text(YADES)
            own = {
                "ASAN_OPTIONS": f"{log}:detect_leaks=0:detect_odr_violation=0:suppressions={known}",
                "UBSAN_OPTIONS": f"{log}:print_stacktrace=1",
                "TSAN_OPTIONS": f"{log}:ignore_noninstrumented_modules=1",
            }
            begun = time.monotonic()
            environment = {**os.environ, **own, **more}
            done = subprocess.run(command, cwd=self.clone, env=environment, capture_output=True, text=True)
            found = "".join(file.read_text(errors="replace") for file in sorted(Path(folder).glob("found*")))
        count = sum(found.count(words) for words in FINDINGS)
        lines = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()]
        result = (lines[-1].strip("= ") if lines else "ended") if "pytest" in command else "ended"
        if done.returncode:
            result = f"failed: {result}"
            print("\n".join(lines[-40:]), flush=True)
        print(found[:8000], end="", flush=True)
        print(f"{self.sanitize}: {what}: {result}, {count} findings", flush=True)
        row = f"| {self.sanitize} | {what} | {result} | {count} | {time.monotonic() - begun:.0f} |"
        return row, count == 0 and done.returncode == 0

    def harness(self, scenes):
        """A row for each scene: on one to four threads by turns, eight domains, without vectors and with the best that this machine has."""
        self.make("build/harness")
        for name, path in scenes:
            for instructions in ("portable", ""):
                how = ["steps=200", "threads=1,2,4", "domains=8", f"instructions={instructions}"]
                what = f"harness, {name}, {instructions or 'the best instruction set'}"
                yield self.row(what, ["build/harness", str(path), *how])

    def tests(self):
        """Rows for the kernel's probe and for files of tests inside YADE, with the sanitizer's library in front of all others."""
        self.make("build")
        library = run([COMPILER, "-print-file-name=libclang_rt.asan-x86_64.so"]).stdout.strip()
        pytest = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
        probe = {"CXX": COMPILER, "PROBE_FLAGS": f"-fsanitize={self.sanitize} -g1"}
        yield self.row("kernel (tests/kernel)", [*pytest, "tests/kernel"], LD_PRELOAD=library, **probe)
        for path in IN_YADE:
            yield self.row(f"in YADE: {path}", [*pytest, path], LD_PRELOAD=library)


MEMORY, THREADS = Trial("address,undefined"), Trial("thread")


def scenes_in(folder):
    """[(name and moment, file)] of small scenes: drag, a periodic cell, bonds that break."""
    run(["make", "build/harness"], cwd=TOP)
    for name, scene in SMALL.items():
        moments.make(name, scene, folder)
    return [(f"{n}, {m}", moments.path_of(n, m, scene, folder)) for n, scene in SMALL.items() for m in scene.moments]


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    version, scenes = run([COMPILER, "--version"]).stdout.splitlines()[0], scenes_in(FOLDER)
    rows = chain(THREADS.harness(scenes), MEMORY.harness(scenes), MEMORY.tests())
    return 0 if write_page(HERE / "results/sanitizers.md", HEAD.format(version=version, **machine()), rows) else 1


if __name__ == "__main__":
    sys.exit(main())
