"""One YADE that has started, and runs scripts in processes forked from it: a start takes longer than most scripts.

In YADE: `yade -n -x yade_server.py REQUESTS ANSWERS MODULE...` imports the modules, reads one request a line from the
file descriptor REQUESTS ({"script", "folder", "timeout", "arguments", "output"}: a Python file, where to run it,
seconds or 0, what follows the file in sys.argv, a folder), runs it as YADE's own main script would be, and writes a
line to ANSWERS: its status as subprocess has it, a signal's number negative. What the script prints is in OUTPUT/stdout
and OUTPUT/stderr. Without modules a script finds what any script of YADE would.
"""

import atexit
import importlib
import importlib.util
import json
import os
import pickle
import signal
import subprocess
import sys
import traceback

import pytest


class YadeServer:
    """A YADE that starts with the first script, with modules that scripts need, in this environment (None: of this
    process)."""

    def __init__(self, modules=(), environment=None):
        self.modules, self.environment = modules, environment
        self.process = None

    def run(self, script, folder, timeout=0, arguments=(), output=""):
        """Exit status of a script (path) run in a folder, a signal's number negative: SIGALRM's after so many seconds.
        output: the folder of what it prints, of that one's if relative. RuntimeError when the YADE has ended."""
        if self.process is None or self.process.poll() is not None:
            self._start()
        request = dict(script=str(script), folder=str(folder), timeout=timeout, arguments=arguments, output=str(output))
        print(json.dumps(request), file=self.requests, flush=True)
        answer = self.answers.readline()
        if not answer:
            raise RuntimeError("the YADE that scripts are forked from has ended")
        return int(answer)

    def close(self):
        """End YADE."""
        if self.process:
            self.requests.close()
            self.process.wait(timeout=30)

    def _start(self):
        (theirs, ours), (answers, to_us) = os.pipe(), os.pipe()
        command = ["yade", "-n", "-x", "-j1", os.path.abspath(__file__), str(theirs), str(to_us), *self.modules]
        pipes = dict.fromkeys(("stdin", "stdout", "stderr"), subprocess.DEVNULL)
        self.process = subprocess.Popen(command, pass_fds=(theirs, to_us), env=self.environment, **pipes)
        os.close(theirs)
        os.close(to_us)
        self.requests, self.answers = os.fdopen(ours, "w"), os.fdopen(answers)
        atexit.register(self.close)


SERVER = YadeServer()


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


def run(script, folder, timeout, arguments, output):
    """Run a script in its folder as YADE does, and return the exit status; the process is the script's own."""
    signal.alarm(timeout)  # ends the process
    os.chdir(folder)
    sys.argv = [script, *arguments]
    for number, name in ((1, "stdout"), (2, "stderr")):
        os.dup2(os.open(os.path.join(output, name), os.O_CREAT | os.O_WRONLY), number)
    main = vars(sys.modules["__main__"])
    try:  # by sys.exit(), as YADE's program does: record() hears of the end there
        try:
            with open(script) as file:
                exec(compile(file.read(), script, "exec"), main)
        except SystemExit:
            raise
        except BaseException:
            traceback.print_exc()
            sys.exit(1)
        sys.exit(0)
    except SystemExit as end:
        status = end.code if isinstance(end.code, int) else int(end.code is not None)
    sys.stdout.flush()
    sys.stderr.flush()
    return status


# ---- functions of test modules ----


def without_absolute_tolerance():
    """pytest.approx has no absolute tolerance of 1e-12 from now on: energies, masses and torques of grains are smaller
    than that in SI units, and would equal any other. What is compared with 0 must give an `abs` of its own."""
    type(pytest.approx(1.0)).DEFAULT_ABSOLUTE_TOLERANCE = 0.0


def answer():
    """Read `call` in this folder (pickle: file, name and arguments of the function), and write `answer` (pickle: what
    it returned).

    Whatever it raises goes to stderr, with the variables of the last function, and ends the process with status 1.
    """
    place = os.path.abspath("answer")  # the function may go to another folder
    with open("call", "rb") as file:
        path, name, arguments = pickle.load(file)
    sys.path.insert(0, os.path.dirname(path))
    without_absolute_tolerance()
    try:
        import contact_law  # noqa: F401

        returned = getattr(_module(path), name)(**arguments)
    except Exception as error:
        trace = traceback.TracebackException.from_exception(error, capture_locals=True)
        for frame in trace.stack:
            short = {name: text[:200] for name, text in (frame.locals or {}).items() if not name.startswith("__")}
            frame.locals = short if frame is trace.stack[-1] else None
        sys.stderr.write("".join(trace.format()))
        sys.exit(1)
    with open(place, "wb") as file:
        pickle.dump(returned, file)


def _module(path):
    name = os.path.basename(path).removesuffix(".py")
    spec = importlib.util.spec_from_file_location(name, path)
    module = sys.modules[name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


if __name__ == "__main__":
    if sys.argv[3:]:
        sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))
    for name in sys.argv[3:]:
        importlib.import_module(name)
    serve(os.fdopen(int(sys.argv[1])), os.fdopen(int(sys.argv[2]), "w"))
