"""The codes that run a scene of a file (scene_file.py), each by one interface.

A code is opened on a scene and asked in turn with others: open_code(...).measure(threads, seconds, most) returns at least
{grains, contacts (mean of the touching pairs), steps, seconds, fraction (processor seconds a second), version}. It does
nothing between measurements.
"""

import json
import subprocess
import tempfile
from dataclasses import dataclass

import peers
from measured_on import HERE, TOP

HARNESS = TOP / "build/harness"


class CodeFailed(RuntimeError):
    """A code did not come to its end."""


@dataclass(frozen=True)
class Code:
    """name, as tables have it; physics, in words; law: what runs in YADE (yade_codes.py), "" for a program of its own;
    instructions of the engine."""

    name: str
    physics: str
    law: str = ""
    instructions: str = ""


OURS = "This law, all channels of the energy ledger."
STOCK = (
    "CohFrictPhys with moments: linear springs with sliding, rolling and twisting, a bond between grains; no JKR, no energy "
    "ledger."
)
CODES = {
    "engine": Code("JKRWadaEngine", OURS, "fused"),
    "engine-avx2": Code("JKRWadaEngine, AVX2", OURS, "fused", "avx2"),
    "engine-portable": Code("JKRWadaEngine, portable", OURS, "fused", "portable"),
    "functors": Code("functors in YADE's loop", OURS, "functors"),
    "stock": Code("YADE's own loop, stock cohesive law", STOCK, "stock"),
    "lammps": Code("LAMMPS", peers.PROGRAMS["lammps"].physics),
    "liggghts": Code("LIGGGHTS", peers.PROGRAMS["liggghts"].physics),
}


def threads_of(code):
    """Numbers of threads, or of a peer's processes, that a code is measured with here."""
    if CODES[code].instructions:
        return (1,)
    return (1, 2) if CODES[code].law else peers.core_counts()


def missing(code, scene=None):
    """Why a code cannot be measured here, or on this SceneFile, in a line; None when it can."""
    return None if CODES[code].law else peers.missing(code, scene)


def open_code(code, path, together, threads, settings):
    """What measures a code on the scene of a file; together: small steps in an O.step; threads: what YADE is started with
    (its own loops have no other way)."""
    return YadeCode(code, path, together, threads) if CODES[code].law else peers.PeerCode(code, path, settings)


class YadeCode:
    """A YADE that holds a scene (yade_codes.py). It starts in the background; about() waits for it."""

    def __init__(self, code, path, together, threads):
        law, instructions = CODES[code].law, CODES[code].instructions
        asked = {"path": str(path), "together": together, "law": law, "instructions": instructions}
        command = ["yade", "-n", "-x", f"-j{threads}", str(HERE / "yade_codes.py"), json.dumps(asked)]
        self.name, self.errors, self.started = f"{code} on {path.name}", tempfile.TemporaryFile("w+"), None
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=self.errors, text=True)

    def about(self):
        """{commit, bytes: memory of the engine, None where that cannot be told}"""
        self.started = self.started or self._answer()
        return self.started

    def measure(self, threads, seconds, most):
        """Of so many seconds, or of a share of `most` small steps; with what the engine counted (yade_codes.py)."""
        self.about()
        request = {"threads": threads, "seconds": seconds, "most": most}
        print(json.dumps(request), file=self.process.stdin, flush=True)
        return self._answer()

    def _answer(self):
        for line in self.process.stdout:
            if line.startswith("ANSWER "):
                return json.loads(line[len("ANSWER ") :])
        self.errors.seek(0)
        raise CodeFailed(f"{self.name} ended without an answer:\n{self.errors.read()[-2000:]}")

    def close(self):
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()
        self.errors.close()


def harness(path, prefix=(), timeout=None, **parameters):
    """The lines of JSON, as dictionaries, that the engine without YADE (harness/, build/harness --help) prints for a scene's
    file. prefix: of the command. Raises CodeFailed with its words."""
    command = [*prefix, str(HARNESS), str(path), *(f"{name}={value}" for name, value in parameters.items())]
    done = subprocess.run(command, capture_output=True, text=True, timeout=timeout)
    if done.returncode:
        raise CodeFailed(done.stderr.strip() or f"{HARNESS} failed with status {done.returncode}")
    return [json.loads(line) for line in done.stdout.splitlines()]
