"""The engine of a 64-bit ARM beside this machine's: the same bits, without vectors. Run by `make test-arm64`.

The last commit is compiled in build/arm64 by Debian's cross compiler, without YADE; qemu runs it. An emulator on x86
orders memory as x86 does: races of threads are the sanitizer's to find. Writes build/arm64.md; exit status 0 when all
bits are the same.
"""

import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1]), str(HERE), str(HERE.parent / "benchmarks")]
import codes
from codes import TOP, machine
from debian_systems import last_commit_in, run, write_page
from sanitizers import small_scenes

CLONE, COMPILER = TOP / "build/arm64", "aarch64-linux-gnu-g++"
EMULATED = ("qemu-aarch64", "-L", "/usr/aarch64-linux-gnu")
HEAD = """# 64-bit ARM

Commit {commit}, on {cpu}. Each scene runs 1000 small steps here and there, without vectors ("portable"); the hash is of
all bits of the grains' motion.

| scene | threads | hash here | on ARM |
|---|---:|---|---|
"""


def rows():
    """(line of the table, whether the bits are the same) of each scene."""
    for name, scene in small_scenes(CLONE / "build"):
        for threads in (1, 2):
            how = dict(steps=1000, domains=4, instructions="portable", threads=threads)
            here = codes.harness(scene, **how)["hash"]
            there = codes.harness(scene, EMULATED, program=CLONE / "build/harness", **how)["hash"]
            yield f"| {name} | {threads} | {here} | {there} |", here == there


def main():
    last_commit_in(CLONE)
    run(["make", f"-j{os.cpu_count()}", f"CXX={COMPILER}", "build/harness"], cwd=CLONE)
    return 0 if write_page(TOP / "build/arm64.md", HEAD.format(**machine()), rows()) else 1


if __name__ == "__main__":
    sys.exit(main())
