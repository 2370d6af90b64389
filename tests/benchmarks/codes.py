"""The codes that run a scene of a file (scene_file.py), each by one interface.

open_code(...).measure(threads, seconds, most) returns at least {grains, contacts (mean of the touching pairs), steps,
seconds, fraction (processor seconds a second), version}. An open code does nothing between measurements.
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
    """name, as tables have it; law: what runs in YADE (in_yade.py), "" for a program of its own; instructions: of the
    engine; physics: where it is not this law."""

    name: str
    law: str = ""
    instructions: str = ""
    physics: str = ""


CODES = {
    "engine": Code("JKRWadaEngine", "fused"),
    "engine-avx2": Code("JKRWadaEngine, AVX2", "fused", "avx2"),
    "engine-portable": Code("JKRWadaEngine, portable", "fused", "portable"),
    "functors": Code("functors in YADE's loop", "functors"),
    **{name: Code(title, physics=peers.PHYSICS[name]) for name, title in peers.TITLES.items()},
}


def threads_of(code):
    """Numbers of threads, or of a peer's processes, that a code is measured with here."""
    if CODES[code].instructions:
        return (1,)
    return (1, 2) if CODES[code].law else peers.core_counts(code)


def missing(code, scene):
    """Why a code cannot be measured here on this SceneFile, in a line; None when it can."""
    return None if CODES[code].law else peers.missing(code, scene)


def open_code(code, path, together, how):
    """What measures a code on the scene of a file; together: small steps in an O.step; how: bench.Settings."""
    return YadeCode(CODES[code], path, together) if CODES[code].law else peers.PeerCode(code, path, how)


class YadeCode:
    """A code in YADEs that hold a scene (in_yade.py), each started when it is first used: one for any number of the
    engine's threads; of YADE's own loops one for each number, which they cannot change."""

    def __init__(self, code, path, together):
        opened = {"path": str(path), "together": together, "law": code.law, "instructions": code.instructions}
        self.opened, self.one_for_all, self.yades = opened, code.law == "fused", {}

    def measure(self, threads, seconds, most):
        """A measurement of so many seconds, or of a share of `most` small steps."""
        own = 1 if self.one_for_all else threads
        if own not in self.yades:
            command = ["yade", "-n", "-x", f"-j{own}", str(HERE / "in_yade.py"), json.dumps(self.opened)]
            errors, pipe = tempfile.TemporaryFile("w+"), subprocess.PIPE
            self.yades[own] = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=errors, text=True), errors
        yade, errors = self.yades[own]
        print(json.dumps({"threads": threads, "seconds": seconds, "most": most}), file=yade.stdin, flush=True)
        for line in yade.stdout:
            if line.startswith("ANSWER "):
                return json.loads(line[len("ANSWER ") :])
        errors.seek(0)
        raise CodeFailed(f"YADE ended without an answer on {self.opened['path']}:\n{errors.read()[-2000:]}")

    def close(self):
        for yade, errors in self.yades.values():
            yade.communicate()
            errors.close()


def harness(path, prefix=(), timeout=None, program=HARNESS, **parameters):
    """The lines of JSON, as dictionaries, that build/harness prints for a scene's file (build/harness --help).
    prefix: of the command; program: build/harness of a clone. Raises CodeFailed with its words."""
    command = [*prefix, str(program), str(path), *(f"{name}={value}" for name, value in parameters.items())]
    done = subprocess.run(command, capture_output=True, text=True, timeout=timeout)
    if done.returncode:
        raise CodeFailed(done.stderr.strip() or f"{program} failed with status {done.returncode}")
    return [json.loads(line) for line in done.stdout.splitlines()]
