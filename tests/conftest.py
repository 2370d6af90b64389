"""Shared by all tests: the repository's top on sys.path, and YADE runs in a process of their own."""

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


def run_yade(script, parameters=None, threads=1, timeout=300, environment=None):
    """Run Python source `script` inside YADE (headless) and return what it stored in the dict `result`.

    The script sees `parameters` (a dict), the contact law's classes and YADE's own names. numpy arrays in `result` come
    back as lists. Raises YadeFailed when YADE ends with a non-zero status.
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
        command = ["yade", "-n", "-x", f"-j{threads}", str(path)]
        done = subprocess.run(
            command,
            capture_output=True,
            text=True,
            timeout=timeout,
            cwd=folder,
            env={**os.environ, **(environment or {})},
        )
        if done.returncode or not answer.exists():
            raise YadeFailed(f"status {done.returncode}\n{done.stdout[-3000:]}\n{done.stderr[-3000:]}")
        return json.loads(answer.read_text())


@pytest.fixture
def yade():
    return run_yade
