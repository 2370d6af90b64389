"""Shared by all tests: the repository's top on sys.path, and scripts in YADE, each in a process of its own."""

import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP))


class YadeFailed(AssertionError):
    """A YADE script ended with a non-zero status; the message holds what it printed."""


class YadeServer:
    """The one YADE of this process that tests' scripts are forked from (yade_server.py), started when it is first asked."""

    def __init__(self):
        self.process = None

    def run(self, script, folder, timeout):
        """Exit status of a script (path) run in a folder, a signal's number negative; after so many seconds it is ended."""
        if self.process is None or self.process.poll() is not None:
            self._start()
        request = {"script": str(script), "folder": str(folder), "timeout": timeout}
        print(json.dumps(request), file=self.requests, flush=True)
        answer = self.answers.readline()
        if not answer:
            raise YadeFailed("the YADE that scripts are forked from has ended")
        return int(answer)

    def _start(self):
        (theirs, ours), (answers, to_us) = os.pipe(), os.pipe()
        command = ["yade", "-n", "-x", "-j1", str(TOP / "tests" / "yade_server.py"), str(theirs), str(to_us)]
        quiet = subprocess.DEVNULL
        self.process = subprocess.Popen(command, pass_fds=(theirs, to_us), stdin=quiet, stdout=quiet, stderr=quiet)
        os.close(theirs)
        os.close(to_us)
        self.requests, self.answers = os.fdopen(ours, "w"), os.fdopen(answers)


SERVER = YadeServer()


def run_yade(script, parameters=None, threads=1, timeout=300):
    """Run Python source `script` inside YADE (headless) and return what it stored in the dict `result`.

    The script sees `parameters` (a dict), the contact law's classes and YADE's own names. numpy arrays in `result` come
    back as lists. With one thread it runs in a process forked from a YADE that has started; with more in a YADE of its
    own. Raises YadeFailed when it ends with a non-zero status.
    """
    with tempfile.TemporaryDirectory() as folder:
        path, answer = Path(folder) / "script.py", Path(folder) / "result.json"
        path.write_text(
            "import sys, json, math\n"
            f"sys.path[:0] = [{str(TOP)!r}, {str(TOP / 'tests')!r}]\n"
            "import numpy as np\nimport contact_law\nfrom yade.wrapper import *\nfrom yade import utils\nfrom yade.minieigenHP import *\n"
            f"parameters = json.loads({json.dumps(json.dumps(parameters or {}))})\nresult = {{}}\n"
            + script
            + f"\nopen({str(answer)!r}, 'w').write(json.dumps(result, default=lambda x: x.tolist()))\n"
        )
        if threads == 1:
            status = SERVER.run(path, folder, timeout)
        else:
            command = ["yade", "-n", "-x", f"-j{threads}", str(path)]
            with open(Path(folder) / "stdout", "w") as out, open(Path(folder) / "stderr", "w") as err:
                status = subprocess.run(command, stdout=out, stderr=err, timeout=timeout, cwd=folder).returncode
        if status or not answer.exists():
            said = [(Path(folder) / name).read_text()[-3000:] for name in ("stdout", "stderr")]
            raise YadeFailed("\n".join([f"status {status}", *said]))
        return json.loads(answer.read_text())


@pytest.fixture
def yade():
    return run_yade
