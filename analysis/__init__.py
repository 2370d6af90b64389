"""Analysis of runs of cohesive dust aggregates: run folders in, numbers and figures out. Needs no YADE.

    from analysis import open_run, summarise
    summarise(open_run("runs/demo"))["d_max"]

`analysis.__version__` and `analysis.commit` say which sources these are.

A24 = Arakawa et al. 2024 (elastoplastic collisions), A22 = Arakawa et al. 2022 (viscous dissipation), K13 =
Kataoka et al. 2013 (static compression). Everything is in SI units."""

from importlib import import_module

# Loaded when they are first asked for: the scripts that yade runs import analysis.runs.format only.
_PLACES = {
    "RunFolder": ".runs.folder",
    "RunFolderError": ".runs.arrays",
    "State": ".runs.folder",
    "open_run": ".runs.folder",
    "summarise": ".report.summary",
}
__all__ = sorted(_PLACES)


def __getattr__(name):
    if name in ("__version__", "commit"):
        from . import version

        return version.version() if name == "__version__" else version.commit()
    if name not in _PLACES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_PLACES[name], __name__), name)
