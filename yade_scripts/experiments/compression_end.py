"""When a compression turns into the stretching, and when it ends; how the cell is made to deform (K13 section 2)."""

import numpy as np

from analysis.measures.periodic_compression import AVERAGED, pressure_at_end
from yade_scripts.parameters.errors import tell

LOOSE = 0.3  # filling at which stretching ends, over that at which it begins; stress is largest at about 0.5 (T19)
OF_PRESSURE = ("time", "filling", "pressure", "boundaryWork", "constraintWork", "edge_x", "edge_y", "edge_z")
AXES = {"no": (), "x": (0,), "xyz": (0, 1, 2)}


def deform(rates):
    """Have the edges along x, y, z follow dL/dt = rate L from now on."""
    from yade.minieigenHP import Matrix3
    from yade.wrapper import Omega

    x, y, z = rates
    Omega().cell.velGrad = Matrix3(x, 0, 0, 0, y, 0, 0, 0, z)


def rates():
    """Present rates (3,) [1/s] of the edges' logarithms."""
    from yade.wrapper import Omega

    gradient = Omega().cell.velGrad
    return np.array([gradient[axis, axis] for axis in range(3)])


class Ending:
    """Turns the compression into the stretching, and ends the run: Scene.control. time_unit: t0 [s]; rate [1/s]."""

    def __init__(self, parameters, time_unit, rate):
        self.parameters, self.rate = parameters, rate
        self.window = AVERAGED * time_unit
        self._loose = parameters.stretchFilling

    def __call__(self, recorder, state):
        filling = recorder.recent("filling")[-1]
        if rates().max() > 0:
            if self._loose is None:
                self._loose = LOOSE * recorder.recent("filling", np.inf).max()
            return filling <= self._loose
        if not self.is_pressed(recorder):
            return False
        axes = AXES[self.parameters.stretch]
        if not axes:
            return True
        if self._loose is not None and filling <= self._loose:
            tell(
                f"stretchFilling = {self._loose:g}: the pressure was reached at a filling of {filling:.3g}; "
                "the cell is not stretched"
            )
            return True
        deform([self.rate * (axis in axes) for axis in range(3)])
        return False

    def is_pressed(self, recorder):
        """Whether the final filling or the final pressure is reached."""
        return recorder.recent("filling")[-1] >= self.parameters.finalFilling or self._pressed(recorder)

    def ended_by(self, recorder):
        """Which parameter ended the run, and where."""
        filling = recorder.recent("filling")[-1]
        where = f"at a filling of {filling:.3g}"
        if not recorder.finished:
            return f"duration, {where}"
        if rates().max() > 0:
            return f"stretchFilling, {where}"
        if filling >= self.parameters.finalFilling:
            return f"finalFilling, {where}"
        return f"finalPressure, {where} and {self._pressure(recorder):.3g} Pa over the last {AVERAGED:g} t0"

    def _pressed(self, recorder):
        limit = self.parameters.finalPressure
        if limit is None or recorder.recent("time")[-1] < self.window:
            return False
        return self._pressure(recorder) >= limit

    def _pressure(self, recorder):
        """By the work of the grains on the boundaries, which they do not do before the aggregate meets its images: the virial of an
        aggregate that still swings from the start is not zero."""
        return pressure_at_end({name: recorder.recent(name, self.window) for name in OF_PRESSURE}, self.window)
