"""Studies and their figures, found by their folders."""

import pkgutil
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec

from .. import studies


def names():
    """Names of all studies, sorted."""
    return sorted(m.name for m in pkgutil.iter_modules(studies.__path__) if m.ispkg and _has(f"{m.name}.study"))


def find(name):
    """definition.Study of that name; KeyError when there is none."""
    if name not in names():
        raise KeyError(name)
    return replace(_module(f"{name}.study").STUDY, name=name)


def figures(name):
    """definition.StudyFigure of a study, those of the paper (figNN_...) first, then by name."""
    if not _has(f"{name}.figures"):
        return []
    package = _module(f"{name}.figures")
    modules = [package]
    for module in pkgutil.iter_modules(getattr(package, "__path__", ())):
        modules.append(_module(f"{name}.figures.{module.name}"))
    found = [figure for module in modules for figure in getattr(module, "FIGURES", ())]
    return sorted(found, key=lambda figure: (not figure.name.startswith("fig"), figure.name))


def _module(name):
    return import_module(f"{studies.__name__}.{name}")


def _has(name):
    return find_spec(f"{studies.__name__}.{name}") is not None
