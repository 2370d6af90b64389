"""Shared by all tests: the repository's top on sys.path, and scripts in YADE, each in a process of its own."""

import os
import pickle
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parents[1]
# Folders whose helpers other folders' tests import.
ROOMS = [str(TOP / "tests" / room) for room in (".", "scripts", "analysis", "benchmarks")]
sys.path.insert(0, str(TOP))
sys.path += ROOMS

from yade_server import SERVER, without_absolute_tolerance

without_absolute_tolerance()


class YadeFailed(AssertionError):
    """A YADE script ended with a non-zero status; the message holds what it printed."""


TO_CALL = f"import sys\nsys.path[:0] = {[str(TOP), *ROOMS]}\nfrom yade_server import answer\nanswer()\n"


def call_in_yade(path, name, arguments, threads=1, timeout=300):
    """What the function `name` of a Python file returns inside YADE (headless), called with a dict of arguments; both
    as pickle can hold them. With one thread it runs in a process forked from a YADE that has started; with more in a
    YADE of its own. Raises YadeFailed for what it raises, and when YADE ends otherwise."""
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "script.py").write_text(TO_CALL)
        (folder / "call").write_bytes(pickle.dumps((str(path), name, arguments)))
        status = _run(folder, threads, timeout)
        if status or not (folder / "answer").exists():
            raise YadeFailed("\n".join([f"status {status}", *_printed(folder)]))
        return pickle.loads((folder / "answer").read_bytes())


def run_yade(function, parameters=None, threads=1, timeout=300):
    """What a function of a test module returns inside YADE, called with `parameters` (a dict)."""
    return call_in_yade(function.__code__.co_filename, function.__name__, parameters or {}, threads, timeout)


def _run(folder, threads, timeout):
    """Exit status of script.py in a folder."""
    if threads == 1:
        status = SERVER.run(folder / "script.py", folder, timeout)
        if status == -signal.SIGALRM:
            raise YadeFailed(f"no end within {timeout} s")
        return status
    command = ["yade", "-n", "-x", f"-j{threads}", str(folder / "script.py")]
    with open(folder / "stdout", "w") as out, open(folder / "stderr", "w") as err:
        return subprocess.run(command, stdout=out, stderr=err, timeout=timeout, cwd=folder).returncode


def _printed(folder):
    return [(folder / name).read_text()[-3000:] for name in ("stdout", "stderr")]


@pytest.hookimpl(tryfirst=True)
def pytest_pyfunc_call(pyfuncitem):
    """Tests marked in_yade run inside YADE, with the values of their fixtures."""
    if pyfuncitem.get_closest_marker("in_yade") is None:
        return None
    names = pyfuncitem._fixtureinfo.argnames
    arguments = {name: pyfuncitem.funcargs[name] for name in names}
    call_in_yade(Path(pyfuncitem.fspath), pyfuncitem.originalname, arguments)
    return True


@pytest.fixture
def yade():
    return run_yade


@pytest.fixture
def program(tmp_path, monkeypatch):
    """program(name, script) makes a shell script that is found before any other program of that name."""
    folder = tmp_path / "bin"
    monkeypatch.setenv("PATH", f"{folder}:{os.environ['PATH']}")

    def made(name, script):
        folder.mkdir(exist_ok=True)
        (folder / name).write_text(f"#!/bin/sh\n{script}\n")
        (folder / name).chmod(0o755)

    return made
