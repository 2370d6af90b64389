"""In YADE, with the contact law loaded: calls the function of a test module that conftest.py asks for, and leaves what
it returns."""

import importlib.util
import os
import pickle
import sys
import traceback

import pytest


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
