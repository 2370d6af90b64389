"""A kind of run of a user's own: 27 grains on a cubic lattice in a periodic cell that shrinks, whose boundaries do many
times the work that the contacts held at the start. `yade -n -x shrinking_cell.py rate=3e-4`; YADE runs it, and tests
import SHRINK, its path."""

import os
import sys
from dataclasses import dataclass

SHRINK = os.path.realpath(sys.argv[0] if __name__ == "__main__" else __file__)  # YADE has a __file__ of its own
sys.path.insert(0, os.path.dirname(os.path.dirname(os.path.dirname(SHRINK))))
import numpy as np

from analysis.runs.format import Quantity, RunKind
from yade_scripts import packings
from yade_scripts.materials import GrainParameters, pair_constants
from yade_scripts.parameters import POSITIVE, parameter
from yade_scripts.run import script
from yade_scripts.run.kind import Estimate, Kind, Scene
from yade_scripts.run.parameters import RunParameters


@dataclass(frozen=True)
class ShrinkParameters(GrainParameters, RunParameters):
    """The cell."""

    rate: float = parameter(3e-4, POSITIVE, "rate at which each edge shrinks", "1/t0")
    duration: float = parameter(20e-9, POSITIVE, "time that is simulated", "s")

    def title(self):
        return f"shrink-{self.material}-{self.rate:g}", ("material", "rate")


def prepare(parameters, threads):
    from yade.minieigenHP import Matrix3
    from yade.wrapper import Omega

    from yade_scripts.run import scene as yade_scene

    constants = yade_scene.pair_constants(parameters)
    parameters = parameters.with_threads(threads)
    spacing = 2 * parameters.grainRadius - constants["equilibriumOverlap"]
    sites = spacing * (np.stack(np.meshgrid(*3 * [np.arange(3)]), axis=-1).reshape(-1, 3) + 0.5)
    packing = packings.Packing(sites, np.full(27, parameters.grainRadius), 0)

    def build():
        omega = Omega()
        omega.periodic = True
        omega.cell.setBox(3 * spacing, 3 * spacing, 3 * spacing)
        omega.cell.homoDeform = 0
        omega.cell.velGrad = Matrix3.Identity * -(parameters.rate / constants["timeUnit"])
        yade_scene.add_bodies([packing], [(0, 0, 0)], yade_scene.material_of(parameters))

    def series(state):
        return {"filling": 27 * 4 / 3 * np.pi * parameters.grainRadius**3 / np.prod(state["cell_size"])}

    return Scene(parameters, constants, {"spacing": spacing}, np.zeros(27, int), build, series)


def estimate(parameters):
    steps = parameters.duration / pair_constants(parameters)["timeUnit"] / parameters.stepFraction
    return Estimate(27, 81, steps)


KIND = Kind(
    RunKind("shrink", (Quantity("filling", ("T",), "1", "volume filling factor"),)), ShrinkParameters, prepare, estimate
)

if __name__ == "__main__":
    script.main(KIND, "Shrink a periodic cell.")
