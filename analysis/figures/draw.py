"""All figures of a run."""

from pathlib import Path

from .energy import energy_figure
from .forces import forces_figure
from .grains import grains_figure
from .motion import motion_figure

FIGURES = {"motion": motion_figure, "energy": energy_figure, "grains": grains_figure, "forces": forces_figure}


def draw_all(run, folder):
    """Draw every figure of a RunFolder into `folder` (made if missing) as NAME.png; yields each file's path
    once written.

    RunFolderError when the run lacks what a figure shows, OSError when the folder can't be written.
    """
    folder = Path(folder)
    folder.mkdir(parents=True, exist_ok=True)
    for name, make in FIGURES.items():
        figure = make(run)
        file = folder / f"{name}.png"
        figure.savefig(file)
        yield file
