"""What Forks runs in a fork of YADE: a program whose calls injector.so counts. sys.argv[1] is JSON, as Forks.call() has it."""

import ctypes
import json
import os
import runpy
import sys

TOP = os.path.abspath(sys.argv[0]).rpartition("/tests/")[0]

request = json.loads(sys.argv[1])
os.dup2(1, 2)
os.chdir(request["folder"])
os.environ["PATH"] = f"{request['folder']}/bin:{os.environ['PATH']}"
program = request["program"]
path = os.path.join(TOP, program)
sys.argv = [path, *request["arguments"]]
arm = ctypes.CDLL(None).fault_arm
arm.argtypes = (ctypes.c_char_p, ctypes.c_long, ctypes.c_int, ctypes.c_long, ctypes.c_char_p)
arm(request["watched"].encode(), request["call"], request["action"], request["stop"], request["log"].encode())
if program.endswith(".py"):
    runpy.run_path(path, run_name="__main__")
else:
    runpy.run_module(program, run_name="__main__", alter_sys=True)
