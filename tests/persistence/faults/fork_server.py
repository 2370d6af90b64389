"""Runs scripts and the analysis many times over from one YADE: a fork for each run, which starts in milliseconds.

    LD_PRELOAD=injector.so yade -n -x -j1 fork_server.py REQUESTS ANSWERS     (numbers of two open pipes)

A request is one line of JSON: folder (to run in, with programs in its bin), program (a script's path in the repository, or a module as of python3 -m), arguments, watched (the
folder whose changes are counted), call, action, stop, log, output (file of stdout and stderr), as fault_arm() in injector.c has them. The answer is one
line of JSON: the exit status, or minus the number of the signal that ended the run. What yade itself does at its end is left out.
"""

import ctypes
import json
import os
import runpy
import signal
import sys

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0])))))
sys.path.insert(0, TOP)
import contact_law  # noqa: F401  (loaded once, for all runs)
from analysis import commands, export, figures  # noqa: F401
from analysis.atlas import model, outcome_table, scores  # noqa: F401
from analysis.commands import study  # noqa: F401
from analysis.export import extended_xyz, film, viewer, vtk_series  # noqa: F401
from yade_scripts.experiments import collision, compression  # noqa: F401
from yade_scripts.run import checkpoint_writer, loop, recorder, report, scene, script  # noqa: F401


def run(request):
    """What a fork does; ends the process."""
    os.chdir(request["folder"])
    output = os.open(request["output"], os.O_CREAT | os.O_WRONLY | os.O_TRUNC, 0o644)
    os.dup2(output, 1)
    os.dup2(output, 2)
    status = 1
    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        os.environ["PATH"] = os.path.join(request["folder"], "bin") + os.pathsep + os.environ["PATH"]
        program = request["program"]
        path = os.path.join(TOP, program)
        sys.argv = [path, *request["arguments"]]
        injector = ctypes.CDLL(None)
        arm = injector.fault_arm
        arm.argtypes = (ctypes.c_char_p, ctypes.c_long, ctypes.c_int, ctypes.c_long, ctypes.c_char_p)
        watched = [request[name].encode() for name in ("watched", "log")]
        arm(watched[0], request["call"], request["action"], request["stop"], watched[1])
        if program.endswith(".py"):
            runpy.run_path(path, run_name="__main__")
        else:
            runpy.run_module(program, run_name="__main__", alter_sys=True)
        status = 0
    except SystemExit as end:
        status = end.code or 0
    except BaseException:
        import traceback

        traceback.print_exc()
    finally:
        try:
            sys.stdout.flush()
            sys.stderr.flush()
        finally:
            os._exit(status)


requests, answers = (os.fdopen(int(number), mode) for number, mode in zip(sys.argv[1:], "rw"))
print("ready", file=answers, flush=True)
for line in requests:
    child = os.fork()
    if child == 0:
        run(json.loads(line))
    print(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), file=answers, flush=True)
os._exit(0)
