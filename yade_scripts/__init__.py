"""Collisions of dust aggregates with YADE: scripts to run, and what they are made of.

from yade_scripts import collide, compress      # runs from Python: runner/sweep.py"""


def __getattr__(name):
    if name in ("collide", "compress"):
        from analysis.startup import missing_libraries

        if problem := missing_libraries():
            raise ImportError(problem)
        from yade_scripts.runner import sweep

        return getattr(sweep, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
