"""Runs the scripts in YADE as a user does, each run in a process forked from one YADE, whose start takes longer than many.

    yade -n -x -j1 yade_errors.py RUNS.json    a list of [script, argument, ...]

Exit statuses are not told; what run k prints is in the file k.txt of the folder in which YADE was started.
"""

import json
import os
import sys
import traceback

with open(sys.argv[1]) as file:
    runs = json.load(file)
for number, arguments in enumerate(runs):
    child = os.fork()
    if child == 0:
        printed = os.open(f"{number}.txt", os.O_CREAT | os.O_WRONLY | os.O_APPEND)
        os.dup2(printed, 1), os.dup2(printed, 2)
        sys.argv = arguments
        try:
            with open(arguments[0]) as script:
                exec(compile(script.read(), arguments[0], "exec"), vars(sys.modules["__main__"]))
        except SystemExit:
            pass
        except BaseException:
            traceback.print_exc()
        sys.stdout.flush(), sys.stderr.flush()
        os._exit(0)
    os.waitpid(child, 0)
sys.exit(0)
