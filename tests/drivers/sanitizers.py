"""The sanitizers of addresses, undefined behaviour and threads on the engine, the kernel, the functors and checkpoints.

Run by make test-sanitizers, a quarter of an hour on two cores. The last commit is compiled in build/sanitizers, once
for each: by clang, as g++ takes ten times as long for the engine's passes; what sees YADE's types by g++, as YADE was.
Threads are tried in the harness alone, where clang's OpenMP tells the sanitizer when a parallel region begins and ends
(Archer). YADE itself is not instrumented. Writes build/sanitizers.md; exit status 0 when nothing was found.
"""

import os
import subprocess
import sys
import tempfile
from itertools import chain, product
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1]), str(HERE), str(HERE.parent / "benchmarks")]
import measured_scenes
from codes import TOP, machine
from debian_systems import last_commit_in, run, write_page

FOLDER, COMPILER = TOP / "build/sanitizers", "clang++-14"
MEMORY, THREADS = "address,undefined", "thread"  # as -fsanitize has them
FINDINGS = ("ERROR: AddressSanitizer", "runtime error: ", "WARNING: ThreadSanitizer")
IN_YADE = ("physics/test_pairs.py", "persistence", "equivalence", "hard_cases")
# YADE's own: where a second thread's numbers need more room, it copies as many bytes as the new place has
# (OpenMPArrayAccumulator::resize), and clears those beyond the old ones.
YADES = "interceptor_via_fun:yade::EnergyTracker::add"
HEAD = """# Sanitizers

Commit {commit}, {cpu}.

| sanitizers | what ran | result | findings |
|---|---|---|---:|
"""


def make(sanitize, goal):
    """Compile what make calls `goal`, of the last commit, in the sanitizers' clone."""
    last_commit_in(FOLDER / sanitize)
    how = [f"SANITIZE={sanitize}", f"CXX={COMPILER}", "YADE_CXX=g++"]
    run(["make", f"-j{os.cpu_count()}", *how, goal], cwd=FOLDER / sanitize)


def row(sanitize, what, command, **more):
    """A line of the table for a command in the sanitizers' clone, and whether it passed with nothing found."""
    with tempfile.TemporaryDirectory() as folder:
        log, known = f"log_path={folder}/found", Path(folder) / "known"
        known.write_text(YADES)
        own = {
            "ASAN_OPTIONS": f"{log}:detect_leaks=0:detect_odr_violation=0:suppressions={known}",
            "UBSAN_OPTIONS": f"{log}:print_stacktrace=1",
            "TSAN_OPTIONS": f"{log}:ignore_noninstrumented_modules=1",
        }
        environment = {**os.environ, **own, **more}
        done = subprocess.run(command, cwd=FOLDER / sanitize, env=environment, capture_output=True, text=True)
        found = "".join(file.read_text(errors="replace") for file in sorted(Path(folder).glob("found*")))
    count = sum(found.count(words) for words in FINDINGS)
    lines = [line for line in (done.stdout + done.stderr).splitlines() if line.strip()]
    result = lines[-1].strip("= ") if lines and "pytest" in command else "ended"
    if done.returncode:
        result = f"failed: {result}"
        print("\n".join(lines[-40:]), flush=True)
    print(found[:8000], end="", flush=True)
    return f"| {sanitize} | {what} | {result} | {count} |", count == 0 and done.returncode == 0


def of_harness(sanitize, scenes):
    """A row for each scene with one, two and four threads, without vectors and with the best instructions here."""
    make(sanitize, "build/harness")
    for name, path in scenes:
        for instructions, threads in product(("portable", ""), (1, 2, 4)):
            how = ["steps=200", f"threads={threads}", "domains=8", f"instructions={instructions}"]
            what = f"harness, {name}, {instructions or 'the best instruction set'}, {threads} threads"
            yield row(sanitize, what, ["build/harness", str(path), *how])


def of_tests(sanitize):
    """Rows for the kernel's probe and tests inside YADE, with the sanitizer's library in front of all others."""
    make(sanitize, "build")
    library = run([COMPILER, "-print-file-name=libclang_rt.asan-x86_64.so"]).stdout.strip()
    pytest = [sys.executable, "-m", "pytest", "-q", "-p", "no:cacheprovider"]
    probe = {"CXX": COMPILER, "PROBE_FLAGS": f"-fsanitize={sanitize} -g1"}
    yield row(sanitize, "tests/kernel", [*pytest, "tests/kernel"], LD_PRELOAD=library, **probe)
    for path in IN_YADE:
        yield row(sanitize, f"tests/{path}, in YADE", [*pytest, f"tests/{path}"], LD_PRELOAD=library)


def small_scenes(folder):
    """[(name and moment, file)] of small scenes, made in a folder: drag, a periodic cell, bonds that break."""
    folder.mkdir(parents=True, exist_ok=True)
    run(["make", "build/harness"], cwd=TOP)
    made = {name: measured_scenes.make(name, scene, folder)[1] for name, scene in measured_scenes.SMALL.items()}
    return [(f"{name}, {moment}", path) for name, paths in made.items() for moment, path in paths.items()]


def main():
    scenes = small_scenes(FOLDER)
    rows = chain(of_harness(THREADS, scenes), of_harness(MEMORY, scenes), of_tests(MEMORY))
    return 0 if write_page(TOP / "build/sanitizers.md", HEAD.format(**machine()), rows) else 1


if __name__ == "__main__":
    sys.exit(main())
