"""The engine of a 64-bit ARM beside this machine's: the same bits, without vectors. Run by `make test-arm64`.

    python3 tests/drivers/arm64.py      some minutes; most is compiling

The last commit is cloned into build/arm64 and compiled there by Debian's cross compiler, without YADE; qemu runs it. Scenes are made with this machine's
own build. (A whole ARM system with YADE in it, emulated as well: make test-debian SYSTEMS=bookworm-arm64.)
An emulator that runs on x86 orders memory as x86 does: what a race of threads would do on a real ARM, the sanitizer of threads has to tell.
Exit status: 0 when all bits are the same, otherwise 1.
"""

import json
import os
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parents[1]), str(HERE), str(HERE.parent / "benchmarks"), str(HERE.parent)]
import numpy as np
import scene_file
from debian_systems import last_commit_in, run, write_page
from measured_on import TOP, machine
from sanitizers import scenes_in

CLONE = TOP / "build/arm64"
COMPILER = "aarch64-linux-gnu-g++"
EMULATED = ("qemu-aarch64", "-L", "/usr/aarch64-linux-gnu", str(CLONE / "build/harness"))
HOW = ("steps=1000", "domains=4", "instructions=portable")
HEAD = """# 64-bit ARM

`make test-arm64`, commit {commit}, on {cpu}. {version}; {emulator}.
Each scene runs 1000 small steps here and there, without vectors ("portable"); the hash is of all bits of the grains' motion.

| scene | threads | contacts at the end | hash here | on ARM | numbers of the last state that differ |
|---|---:|---:|---|---|---:|
"""


def end_of(harness, scene, threads, out):
    """(last line that the harness prints, state that it leaves)"""
    printed = run([*harness, str(scene), *HOW, f"threads={threads}", f"out={out}"]).stdout
    return json.loads(printed.splitlines()[-1]), scene_file.load(out)


def differing(one, other):
    """How many numbers of grains and contacts differ in a bit; nan where there are not as many."""
    pairs = [(one.grains, other.grains), (one.contacts, other.contacts)]
    if any(len(a) != len(b) for a, b in pairs):
        return float("nan")
    return sum(int(np.count_nonzero(a.view(np.uint64) != b.view(np.uint64))) for a, b in pairs)


def rows(folder):
    """(line of the table, whether the bits are the same) of each scene."""
    for name, scene in scenes_in(folder):
        for threads in (1, 2):
            here, state = end_of((str(TOP / "build/harness"),), scene, threads, folder / "here.scene")
            there, other = end_of(EMULATED, scene, threads, folder / "arm64.scene")
            count = differing(state, other)
            row = f"| {name} | {threads} | {there['contacts']} | {here['hash']} | {there['hash']} | {count} |"
            print(row, flush=True)
            yield row, here["hash"] == there["hash"] and count == 0


def main():
    last_commit_in(CLONE)
    run(["make", f"-j{os.cpu_count()}", f"CXX={COMPILER}", "build/harness"], cwd=CLONE)
    version, emulator = (run([name, "--version"]).stdout.splitlines()[0] for name in (COMPILER, EMULATED[0]))
    head = HEAD.format(version=version, emulator=emulator, **machine())
    return 0 if write_page(HERE / "results/arm64.md", head, rows(CLONE / "build")) else 1


if __name__ == "__main__":
    sys.exit(main())
