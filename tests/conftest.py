"""Shared by all tests: the repository's top on sys.path, and scripts in YADE, each in a process of its own."""

import json
import os
import pickle
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(TOP))

from approx import without_absolute_tolerance

without_absolute_tolerance()


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
        if int(answer) == -signal.SIGALRM:
            raise YadeFailed(f"no end within {timeout} s")
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


SCRIPT = f"import sys\nsys.path[:0] = [{str(TOP)!r}, {str(TOP / 'tests')!r}]\n"
TO_CALL = SCRIPT + "from yade_call import answer\nanswer()\n"


def call_in_yade(path, name, arguments, threads=1, timeout=300):
    """What the function `name` of a Python file returns inside YADE (headless), called with a dict of arguments; both as pickle
    can hold them. With one thread it runs in a process forked from a YADE that has started; with more in a YADE of its own.
    Raises YadeFailed for what it raises, and when YADE ends otherwise."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "script.py").write_text(TO_CALL)
        (folder / "call").write_bytes(pickle.dumps((str(path), name, arguments)))
        status = _run(folder, threads, timeout)
        if status or not (folder / "answer").exists():
            raise YadeFailed("\n".join([f"status {status}", *_said(folder)]))
        return pickle.loads((folder / "answer").read_bytes())


def run_yade(script, parameters=None, threads=1, timeout=300):
    """What a function of a test module returns inside YADE, called with `parameters`; or run Python source `script`
    there, and return what it stored in the dict `result`.

    The script sees `parameters` (a dict), the contact law's classes and YADE's own names. numpy arrays in `result` come
    back as lists.
    """
    if callable(script):
        return call_in_yade(script.__code__.co_filename, script.__name__, parameters or {}, threads, timeout)
    with tempfile.TemporaryDirectory() as folder:
        path, answer = Path(folder) / "script.py", Path(folder) / "result.json"
        path.write_text(
            SCRIPT + "import json, math\n"
            "import numpy as np\nimport contact_law\nfrom yade.wrapper import *\nfrom yade import utils\nfrom yade.minieigenHP import *\n"
            f"parameters = json.loads({json.dumps(json.dumps(parameters or {}))})\nresult = {{}}\n"
            + script
            + f"\nopen({str(answer)!r}, 'w').write(json.dumps(result, default=lambda x: x.tolist()))\n"
        )
        status = _run(Path(folder), threads, timeout)
        if status or not answer.exists():
            raise YadeFailed("\n".join([f"status {status}", *_said(Path(folder))]))
        return json.loads(answer.read_text())


def _run(folder, threads, timeout):
    """Exit status of script.py in a folder."""
    if threads == 1:
        return SERVER.run(folder / "script.py", folder, timeout)
    command = ["yade", "-n", "-x", f"-j{threads}", str(folder / "script.py")]
    with open(folder / "stdout", "w") as out, open(folder / "stderr", "w") as err:
        return subprocess.run(command, stdout=out, stderr=err, timeout=timeout, cwd=folder).returncode


def _said(folder):
    return [(folder / name).read_text()[-3000:] for name in ("stdout", "stderr")]


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem):
    """Tests marked in_yade run inside YADE, with the values of their fixtures."""
    if pyfuncitem.get_closest_marker("in_yade") is None:
        return None
    names = pyfuncitem._fixtureinfo.argnames
    arguments = {name: pyfuncitem.funcargs[name] for name in names}
    call_in_yade(pyfuncitem.path, pyfuncitem.originalname, arguments)
    return True


@pytest.fixture
def yade():
    return run_yade
