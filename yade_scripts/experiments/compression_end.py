"""How long a compression lasts, when it turns into the stretching, when it ends, and how the cell deforms (K13 section
2)."""

from math import log

import numpy as np

from analysis.measures.periodic_cell import AVERAGED, pressure_at_end
from yade_scripts.parameters import ParameterError, tell

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
    """Scene.control that turns the compression into the stretching, and ends the run; time_unit: t0 [s]."""

    def __init__(self, parameters, time_unit):
        self.parameters, self.rate = parameters, shrinking_rate(parameters, time_unit)
        self.window = AVERAGED * time_unit
        self._loosest = None  # filling at which the stretching ends

    def __call__(self, recorder, state):
        filling, loose = recorder.recent("filling")[-1], self.parameters.stretchFilling
        if rates().max() > 0:
            if self._loosest is None:
                self._loosest = loose or LOOSE * recorder.recent("filling", np.inf).max()
            return filling <= self._loosest
        if not self.is_pressed(recorder):
            return False
        axes = AXES[self.parameters.stretch]
        if not axes:
            return True
        if loose is not None and filling <= loose:
            tell(f"stretchFilling = {loose:g}: the cell is not stretched, the filling is {filling:.3g}")
            return True
        deform([self.rate * (axis in axes) for axis in range(3)])
        return False

    def is_pressed(self, recorder):
        """Whether the final filling or the final pressure is reached."""
        if recorder.recent("filling")[-1] >= self.parameters.finalFilling:
            return True
        limit = self.parameters.finalPressure
        long_enough = limit is not None and recorder.recent("time")[-1] >= self.window
        return long_enough and self._pressure(recorder) >= limit

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

    def _pressure(self, recorder):
        """By the work of the grains on the boundaries, which they do not do before the aggregate meets its images: the
        virial of an aggregate that still swings from the start is not zero."""
        return pressure_at_end({name: recorder.recent(name, self.window) for name in OF_PRESSURE}, self.window)


def with_start(parameters, time_unit):
    """The parameters with a duration; ParameterError where nothing, or no pressure, would be reached."""
    first, final = parameters.initialFilling, parameters.finalFilling
    if final <= first:
        raise ParameterError(f"finalFilling = {final:g}: must be above the {first:.4g} of the start")
    lasts = min(time_to_filling(parameters, time_unit), parameters.duration or np.inf) / time_unit
    if parameters.finalPressure is not None and lasts < AVERAGED:
        given = (
            f"finalPressure = {parameters.finalPressure:g}: a mean over {AVERAGED:g} t0, and the run lasts {lasts:.3g}"
        )
        raise ParameterError(f"{given}; must be left out, or duration be longer and strainRate smaller")
    if parameters.duration is not None:
        return parameters
    return parameters.changed(duration=longest_duration(parameters, time_unit))


def shrinking_rate(parameters, time_unit):
    """Rate [1/s] of lengths L = L0 exp(-rate t) (K13 eq 7)."""
    return 2 * parameters.strainRate / time_unit


def time_to_filling(parameters, time_unit):
    """Time [s] from initialFilling to finalFilling (K13 eq 7)."""
    rate = parameters.axes * shrinking_rate(parameters, time_unit)
    return log(parameters.finalFilling / parameters.initialFilling) / rate


def longest_duration(parameters, time_unit):
    """Time [s] to finalFilling, and to stretchFilling (K13 eq 7 backwards), and 1 % more: Ending ends the run."""
    time, axes = time_to_filling(parameters, time_unit), len(AXES[parameters.stretch])
    if axes:
        loose = parameters.stretchFilling or LOOSE * parameters.finalFilling
        time += log(parameters.finalFilling / loose) / (axes * shrinking_rate(parameters, time_unit))
    return 1.01 * time
