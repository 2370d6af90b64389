"""In YADE, with the contact law loaded: calls the function of a test module that conftest.py asks for, and leaves what it returns."""

import importlib.util
import os
import pickle
import sys
import traceback

from approx import without_absolute_tolerance


def answer():
    """Read `call` in this folder (pickle: file, name and arguments of the function), and write `answer` (pickle: what it returned).

    Whatever it raises is told on stderr, with the variables of the last function, and ends the process with status 1.
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
        told = traceback.TracebackException.from_exception(error, capture_locals=True)
        for frame in told.stack:
            short = {name: text[:200] for name, text in (frame.locals or {}).items() if not name.startswith("__")}
            frame.locals = short if frame is told.stack[-1] else None
        sys.stderr.write("".join(told.format()))
        sys.exit(1)
    with open(place, "wb") as file:
        pickle.dump(returned, file)


def _module(path):
    name = os.path.basename(path).removesuffix(".py")
    spec = importlib.util.spec_from_file_location(name, path)
    module = sys.modules[name] = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module
