"""One YADE that has started, and runs every test's script in a process forked from it: a start takes longer than most scripts.

In YADE: `yade -n -x yade_server.py REQUESTS ANSWERS` reads one request a line from the file descriptor REQUESTS ({"script", "folder",
"timeout"}: a Python file, where to run it, seconds), runs it as YADE's own main script would be, and writes a line to ANSWERS:
its status as subprocess has it, a signal's number negative. What the script prints is in FOLDER/stdout and FOLDER/stderr.
"""

import json
import os
import signal
import sys
import traceback

import pytest  # noqa: F401 (what many tests import: once, before they are forked)


def serve(requests, answers):
    """Answer requests until their writer closes."""
    for line in requests:
        request = json.loads(line)
        child = os.fork()
        if child == 0:
            requests.close()
            answers.close()
            os._exit(run(**request))
        _, status = os.waitpid(child, 0)
        print(os.waitstatus_to_exitcode(status), file=answers, flush=True)


def run(script, folder, timeout):
    """Run a script in its folder and return the exit status; the process is the script's own."""
    signal.alarm(timeout)  # ends the process
    os.chdir(folder)
    for number, name in ((1, "stdout"), (2, "stderr")):
        os.dup2(os.open(name, os.O_CREAT | os.O_WRONLY), number)
    main = vars(sys.modules["__main__"])
    try:
        with open(script) as file:
            exec(compile(file.read(), script, "exec"), main)
        status = 0
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else int(end.code is not None)
    except BaseException:
        traceback.print_exc()
        status = 1
    sys.stdout.flush()
    sys.stderr.flush()
    return status


if __name__ == "__main__":
    serve(os.fdopen(int(sys.argv[1])), os.fdopen(int(sys.argv[2]), "w"))
