"""Analysis of runs of cohesive dust aggregates: run folders in, tables, numbers and figures out. Needs no YADE.

    import analysis
    run = analysis.open_run("runs/demo")        # run.parameters["velocity"], run.history["d"], run.last.position
    run.last.fragments()                        # DataFrame, a row a piece
    runs = analysis.table("runs/**")            # DataFrame, a row a run
    analysis.plot("sticking", runs, x="velocity").savefig("sticking.png")

dir(analysis) lists all names; docstrings say shapes and units. Functions of measures take plain arrays, such as
analysis.fragment_labels(grains, contact_pairs), and raise ValueError for arrays of wrong shapes or with gaps.
`analysis.__version__` and `analysis.commit` identify the sources.

A24 = Arakawa et al. 2024 (elastoplastic collisions), A22 = Arakawa et al. 2022 (viscous dissipation), K13 =
Kataoka et al. 2013 (static compression), S17 = Sirono & Ueno 2017 (sintered aggregates). Everything is in SI units.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .public import *  # noqa: F403


def __getattr__(name):
    # Loaded when they are first used: the scripts that yade runs do without pandas and matplotlib, which take a second.
    if name in ("__version__", "commit"):
        sources = import_module(".version", __name__)
        return sources.version() if name == "__version__" else sources.commit()
    public = import_module(".public", __name__)
    if name == "__all__" or name in public.__all__:
        return getattr(public, name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__():
    return [*__getattr__("__all__"), "__version__", "commit"]
