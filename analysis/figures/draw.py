"""All figures of a run."""

import pkgutil
from importlib import import_module
from pathlib import Path

from ..progress import progress
from ..runs.files import make_folder, replacing
from . import of_run


def figures_of(run):
    """{name: function of the run that makes the figure} for a RunFolder's kind, found by their modules."""
    modules = {m.name: import_module(f"{of_run.__name__}.{m.name}") for m in pkgutil.iter_modules(of_run.__path__)}
    return {
        name: module.FIGURE
        for name, module in modules.items()
        if run.kind.name in getattr(module, "KINDS", (run.kind.name,))
        and run.kind.name not in getattr(module, "NOT_OF", ())
        and getattr(module, "HAS_MEANING", lambda run: True)(run)
    }


def draw_all(run, folder):
    """Draw every figure of a RunFolder into `folder` (made if missing) as NAME.png; yields each file's path
    once written.

    RunFolderError when the run lacks what a figure shows, OSError when the folder can't be written.
    """
    folder = Path(folder)
    make_folder(folder)
    for name, make in progress(figures_of(run).items(), "drawing"):
        figure = make(run)
        file = folder / f"{name}.png"
        with replacing(file) as out:
            figure.savefig(out, format="png")
        yield file
