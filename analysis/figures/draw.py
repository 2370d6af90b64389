"""All figures of a run. A new one: its function, which takes a RunFolder, and a line in FIGURES."""

from pathlib import Path

from ..progress import progress
from ..runs.files import make_folder, replacing
from ..runs.format import COLLISION, COMPRESSION
from ..runs.measured import are_equal
from .collision import forces_figure, grains_figure, motion_figure
from .energy import compression_figure, energy_figure

# (name, function, whether a run has it)
FIGURES = (
    ("motion", motion_figure, lambda run: run.kind is COLLISION and are_equal(run)),
    ("energy", energy_figure, lambda run: run.kind is not COMPRESSION),  # which begins almost at rest
    ("grains", grains_figure, lambda run: run.kind is COLLISION),
    ("forces", forces_figure, lambda run: run.kind is COLLISION),
    ("compression", compression_figure, lambda run: run.kind is COMPRESSION),
)


def figures_of(run):
    """{name: function of the run that makes the figure} of the figures that a RunFolder has."""
    return {name: make for name, make, has in FIGURES if has(run)}


def draw_all(run, folder):
    """Draw every figure of a RunFolder into `folder` (made if missing) as NAME.png; yields the path of each file.

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
