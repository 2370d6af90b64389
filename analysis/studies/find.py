"""Studies and their figures, found by their folders, or by the path of a file of one's own."""

import pkgutil
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from traceback import extract_tb

from .. import studies
from ..printable import suggested
from ..runs.script import module_of

SAYS = "must be as analysis/STUDIES.md says"


class NoSuchStudy(Exception):
    """No study of that name, or no file that defines one, or one that fails; the message is one line."""


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
    own = _is_own(study)
    if not own and not _has(f"{study.name}.figures"):
        return []
    module = _own(study.folder) if own else _module(f"{study.name}.figures")
    return sorted(getattr(module, "FIGURES", ()), key=lambda figure: (not figure.name.startswith("fig"), figure.name))


def _own(file):
    if not file.is_file():
        raise NoSuchStudy(f"{file}: no such file")
    with _in_one_line(file):
        module = module_of(str(file), f"own_study_{file.stem}")
    if not hasattr(module, "STUDY"):
        raise NoSuchStudy(f"{file}: defines no STUDY; {SAYS}")
    return module


def own_errors(study):
    """Context in which an error becomes NoSuchStudy where the study is a file of one's own."""
    return _in_one_line(study.folder) if _is_own(study) else nullcontext()


@contextmanager
def _in_one_line(file):
    try:
        yield
    except (Exception, SystemExit) as error:
        if type(error).__module__.startswith("analysis."):  # its message is one line
            raise
        frames, own = extract_tb(error.__traceback__), file.resolve()
        lines = [frame.lineno for frame in frames if Path(frame.filename).resolve() == own]
        lines += [error.lineno] if isinstance(error, SyntaxError) else []
        text = error.args[0] if isinstance(error, KeyError) and error.args else error  # in quotes otherwise
        said, where = " ".join(str(text).split()), f" at line {lines[-1]}" if lines else ""
        raise NoSuchStudy(f"{file}: {type(error).__name__}{where}: {said}; {SAYS}") from None


def _is_own(study):
    return study.folder is not None and study.folder.suffix == ".py"


def _module(name):
    return import_module(f"{studies.__name__}.{name}")


def _has(name):
    return find_spec(f"{studies.__name__}.{name}") is not None
