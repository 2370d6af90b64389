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


@pytest.mark.parametrize("name", COMMANDS)
def test_ctrl_c_during_the_imports(tmp_path, name):
    command, module = COMMANDS[name]
    (tmp_path / f"{module}.py").write_text(SLOW)
    importing = tmp_path / "importing"
    os.mkfifo(importing)
    process = start(tmp_path, *command, env=environment(PYTHONPATH=f"{tmp_path}:{TOP}", IMPORTING=str(importing)))
    with open(importing):  # waits for the other end
        process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=50)
    assert process.returncode in (130, -signal.SIGINT)
    assert not [line for line in errors.splitlines() if "Traceback" in line or "Interrupt" in line], errors
