"""A YADE that measures (yade_measured.py), from outside."""

import json
import subprocess
import tempfile

from measured_on import HERE


class YadeProcess:
    """YadeProcess(law, kind, radius).ask("fused", seconds=1, threads=2): the requests and answers of yade_measured.py.

    YADE starts in the background; the first ask() waits for it. It does nothing between requests.
    """

    def __init__(self, law, kind, radius, speed, loop_threads=1):
        self.name = f"YADE ({law}, {kind}, R = {radius}, -j{loop_threads})"
        self.errors = tempfile.TemporaryFile("w+")
        command = [
            "yade",
            "-n",
            "-x",
            f"-j{loop_threads}",
            str(HERE / "yade_measured.py"),
            law,
            kind,
            str(radius),
            str(speed),
        ]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=self.errors, text=True
        )
        self.scene = None

    def wait(self):
        """{grains, contacts (pairs that overlap at the start)}"""
        self.scene = self.scene or self._answer()
        return self.scene

    def ask(self, do, **parameters):
        self.wait()
        self.process.stdin.write(json.dumps({"do": do, **parameters}) + "\n")
        self.process.stdin.flush()
        return self._answer()

    def close(self):
        self.process.stdin.close()
        self.process.wait()
        self.process.stdout.close()
        self.errors.close()

    def _answer(self):
        for line in self.process.stdout:
            if line.startswith("ANSWER "):
                return json.loads(line[len("ANSWER ") :])
        self.errors.seek(0)
        raise RuntimeError(f"{self.name} ended without an answer:\n{self.errors.read()[-2000:]}")
