"""Runs rows of studies one after another, for batch.Worker, which starts it:

    yade -n -x worker.py NUMBER       the number of a file descriptor, one end of a multiprocessing.Pipe

YADE and what runs need are loaded once. Each row is the run of a fork of this process: it has an interpreter, a scene
and signals of its own as if YADE had been started for it, leaves nothing to the next one, and may crash. What is sent
back: (its process id, None) when it can be stopped, and (its process id, its exit status)."""

import ctypes
import gc
import importlib
import os
import signal
import sys
import traceback
from contextlib import suppress
from multiprocessing.connection import Connection

TOP = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(sys.argv[0]))))
LOADED = (
    "contact_law",
    "yade_scripts.experiments.collision",
    "yade_scripts.experiments.compression",
    "yade_scripts.packings.ballistic_hits",
    "yade_scripts.run.scene",
    "yade_scripts.run.script",
    "multiprocessing.synchronize",
)


def serve(connection):
    """Run what comes, until the other end is closed."""
    for number in (signal.SIGINT, signal.SIGTERM):  # these are for the run, if they are sent to all processes
        signal.signal(number, signal.SIG_IGN)
    with suppress(Exception):  # a plugin that isn't built: each run says so itself
        for name in LOADED:
            importlib.import_module(name)
        sys.modules["yade_scripts.packings.ballistic"].bpca(3, 1e-7, 0.0, seed=1)  # numba loads what it needs at a call
    gc.freeze()  # what is loaded is not garbage, and memory that isn't looked at stays shared with the runs
    with suppress(EOFError, ConnectionError):
        while True:
            row = connection.recv()
            sys.stdout.flush()
            run = os.fork()
            if not run:
                _become(connection, **row)
            connection.send((run, os.waitstatus_to_exitcode(os.waitpid(run, 0)[1])))


def _become(connection, script, arguments, threads, log):
    """Be the process of a run, whose output goes to the file log, to its end."""
    libc, status = ctypes.CDLL(None), 1
    try:
        output = os.open(log, os.O_WRONLY | os.O_APPEND)
        os.dup2(output, 1)
        os.dup2(output, 2)
        libc.prctl(1, signal.SIGTERM)  # PR_SET_PDEATHSIG: at the death of its parent
        signal.signal(signal.SIGINT, signal.default_int_handler)
        signal.signal(signal.SIGTERM, signal.SIG_DFL)
        connection.send((os.getpid(), None))
        connection.close()
        if threads > 1:
            _use_threads(threads)
        sys.argv[:] = [script, *arguments]
        with open(script) as file:
            exec(compile(file.read(), script, "exec"), vars(sys.modules["__main__"]))
        status = 0
    except SystemExit as end:
        status = end.code or 0
        if not isinstance(status, int):  # a text, which Python prints
            print(status, file=sys.stderr)
            status = 1
    except BaseException:
        traceback.print_exc()
    finally:
        with suppress(Exception):
            sys.stdout.flush()
            libc.fflush(None)
        os._exit(status & 0xFF)  # not by what the process that was forked does at its end


def _use_threads(number):
    """Have YADE's own loop use that many threads; a process that has used more than one can't be forked."""
    from yade.wrapper import Omega

    ctypes.CDLL("libgomp.so.1").omp_set_num_threads(number)
    Omega().reset()  # whose forces are kept by thread


if __name__ == "__main__":
    sys.path.insert(0, TOP)
    serve(Connection(int(sys.argv[1])))
    os._exit(0)
