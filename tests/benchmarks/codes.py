"""The codes that run a scene of a file (scene_file.py), each by one interface.

A code is opened on a scene and asked in turn with others: open_code(...).measure(threads, seconds, most) returns at least {contacts (mean of the touching pairs),
grains, steps, seconds, fraction (processor seconds a second), version}. It does nothing between measurements.
"""

import json
import subprocess
import tempfile
from dataclasses import dataclass

import peers
import scene_file
from measured_on import HERE, TOP

HARNESS = TOP / "build/harness"


class CodeFailed(RuntimeError):
    """A code that is installed did not come to its end."""


@dataclass(frozen=True)
class Code:
    """name, as tables have it; physics, in words; law: what runs in YADE (yade_codes.py), "" for a program of its own; instructions of the engine."""

    name: str
    physics: str
    law: str = ""
    instructions: str = ""


OURS = "This law, all channels of the energy ledger."
STOCK = "CohFrictPhys with moments: linear springs with sliding, rolling and twisting, a bond between grains; no JKR, no energy ledger."
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
    """What measures a code on the scene of a file; together: small steps in an O.step; threads: what YADE is started with (its own loops have no other way)."""
    return YadeCode(code, path, together, threads) if CODES[code].law else PeerCode(code, path, settings)


class YadeCode:
    """A YADE that holds a scene (yade_codes.py). It starts in the background; what asks it first waits."""

    def __init__(self, code, path, together, threads=1):
        self.name = f"YADE ({code}, {path.name}, -j{threads})"
        asked = {
            "scene": str(path),
            "together": together,
            "law": CODES[code].law,
            "instructions": CODES[code].instructions,
        }
        command = ["yade", "-n", "-x", f"-j{threads}", str(HERE / "yade_codes.py"), json.dumps(asked)]
        self.errors, self.about = tempfile.TemporaryFile("w+"), None
        pipe = subprocess.PIPE
        self.process = subprocess.Popen(command, stdin=pipe, stdout=pipe, stderr=self.errors, text=True)

    def wait(self):
        """{commit, bytes: memory of the engine, None where that cannot be told}"""
        self.about = self.about or self._answer()
        return self.about

    def measure(self, threads, seconds, most):
        return self._ask(do="turn", threads=threads, seconds=seconds, most=most)

    def through(self, o_steps, parts):
        """[answers] of a flight of so many O.steps and the parts of the collision behind it (yade_codes.py)."""
        return self._ask(do="through", flight=o_steps, parts=parts)

    def _ask(self, **request):
        self.wait()
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


class PeerCode:
    """LAMMPS or LIGGGHTS: started anew for each measurement; the first with so many processes finds the skin that is best for it."""

    def __init__(self, code, path, settings):
        self.code, self.scene, self.settings, self.best = code, scene_file.load(path), settings, {}

    def wait(self):
        return {}

    def measure(self, threads, seconds, most):
        """seconds is for other codes: a peer makes peers.steps_for() steps."""
        steps = peers.steps_for(self.scene, self.settings.peer_steps)
        skins = (self.best[threads],) if threads in self.best else self.settings.skins
        runs = [peers.measure(self.code, self.scene, steps, threads, skin) for skin in skins]
        best = max(runs, key=lambda run: run["steps"] / run["seconds"])
        self.best[threads] = best["skin"]
        return best

    def close(self):
        pass


def harness(path, prefix=(), **parameters):
    """The lines of JSON that the harness (harness/, build/harness --help) prints for a scene's file, as dictionaries; prefix: of the command. Raises CodeFailed with its words."""
    command = [*prefix, str(HARNESS), str(path), *(f"{name}={value}" for name, value in parameters.items())]
    done = subprocess.run(command, capture_output=True, text=True, timeout=None if not prefix else 600)
    if done.returncode:
        raise CodeFailed(done.stderr.strip() or f"{HARNESS} failed with status {done.returncode}")
    return [json.loads(line) for line in done.stdout.splitlines()]
