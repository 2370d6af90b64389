"""Studies and their figures, found by their folders, or by the path of a file of one's own."""

import pkgutil
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from traceback import extract_tb

from .. import studies
from ..runs.named import suggested
from ..runs.script import module_of


class NoSuchStudy(Exception):
    """No study of that name, or no file that defines one; the message is one line."""


def names():
    """Names of all studies, sorted."""
    return sorted(m.name for m in pkgutil.iter_modules(studies.__path__) if m.ispkg and _has(f"{m.name}.study"))


def find(name):
    """definition.Study of that name, or of a file NAME.py that defines STUDY (and FIGURES, if it has any); NoSuchStudy."""
    if name.endswith(".py"):
        return replace(_own(Path(name)).STUDY, name=Path(name).stem, folder=Path(name).resolve())
    if name not in names():
        raise NoSuchStudy(f"no study {name}{suggested(name, names())}, or a file NAME.py of one's own")
    return replace(_module(f"{name}.study").STUDY, name=name, folder=Path(studies.__path__[0]) / name)


def figures(study):
    """Figures (definition.StudyFigure, curve_figure.CurveFigure) of a study, those of the paper (figNN_...) first, then by name."""
    own = study.folder.suffix == ".py"
    if not own and not _has(f"{study.name}.figures"):
        return []
    module = _own(study.folder) if own else _module(f"{study.name}.figures")
    return sorted(getattr(module, "FIGURES", ()), key=lambda figure: (not figure.name.startswith("fig"), figure.name))


def _own(file):
    if not file.is_file():
        raise NoSuchStudy(f"{file}: no such file")
    try:
        module = module_of(str(file), f"own_study_{file.stem}")
    except (Exception, SystemExit) as error:
        where = error.lineno if isinstance(error, SyntaxError) else extract_tb(error.__traceback__)[-1].lineno
        said = " ".join(str(error).split())
        raise NoSuchStudy(f"{file}: {type(error).__name__} at line {where}: {said}; must define STUDY") from None
    if not hasattr(module, "STUDY"):
        raise NoSuchStudy(f"{file}: defines no STUDY; must be as analysis/STUDIES.md says")
    return module


def _module(name):
    return import_module(f"{studies.__name__}.{name}")


def _has(name):
    return find_spec(f"{studies.__name__}.{name}") is not None
