"""Ctrl-C before a run has begun, while Python still imports: the process ends, without a traceback."""

import os
import signal

import pytest
from running import COLLIDE, PYTHON, STUDY, TOP, environment, start

# A module in the place of one that the command imports: tells that it is being imported, and takes its time.
SLOW = "import os, sys, time\nopen(os.environ['IMPORTING'], 'w').close()\ntime.sleep(60)\n"
COMMANDS = {
    "collide": (["yade", "-n", "-x", COLLIDE, "radius=4"], "scipy"),
    "study": ([PYTHON, STUDY, "no.table"], "tqdm"),
    "analysis": ([PYTHON, "-m", "analysis", "summary", "nothing"], "numpy"),
}


def interrupted(command, module, folder):
    """The process, after Ctrl-C while it imported the module."""
    (folder / f"{module}.py").write_text(SLOW)
    importing = folder / "importing"
    os.mkfifo(importing)
    how = {"env": environment(PYTHONPATH=f"{folder}:{TOP}", IMPORTING=str(importing))}
    process = start(folder, *command, **how)
    with open(importing):  # waits for the other end
        process.send_signal(signal.SIGINT)
    output = process.communicate(timeout=50)
    return process.returncode, *output


@pytest.mark.parametrize("name", COMMANDS)
def test_ctrl_c_during_the_imports(tmp_path, name):
    status, _, errors = interrupted(*COMMANDS[name], tmp_path)
    assert status in (130, -signal.SIGINT)
    assert not [line for line in errors.splitlines() if "Traceback" in line or "Interrupt" in line], errors
