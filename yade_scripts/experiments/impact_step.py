"""A shorter time step while two aggregates collide.

Most of the error of a collision's ledger arises while they fly through each other, when many contacts form and grains
meet at the full velocity: of two BPCA of 50,000 grains at 50 m/s, 96 % in the first eighth of A22's time.
"""

from math import ceil

from yade_scripts.parameters import ParameterError
from yade_scripts.stability import AUTO

SHORTEST = 100  # parts of stepFraction: shorter ones would be a slip of the pen, and a run without end
RADII = 4  # of the larger aggregate, that the two move against each other with the shorter step: both diameters


def require_usable(parameters):
    """Raise ParameterError when parameters.impactStepFraction doesn't go with the others."""
    step = parameters.impactStepFraction
    if step is None:
        return
    if parameters.stepFraction == AUTO:
        _refuse(step, f"stepFraction = {AUTO}", "be left out, or stepFraction be a number")
    if parameters.engine != "fused":
        _refuse(step, f"engine = {parameters.engine}", "be left out: their step stays the same")
    if not parameters.stepFraction / SHORTEST <= step < parameters.stepFraction:
        _refuse(step, f"stepFraction = {parameters.stepFraction:g}", "be below it and at least a hundredth of it")


def duration(parameters):
    """How long [s] the shorter step holds from the first touch on; parameters: with the size of the aggregates."""
    return RADII * parameters.radius * parameters.grainRadius / parameters.velocity


def more_steps(parameters, touch, end, time_unit):
    """How many more steps than with stepFraction alone a run takes; first touch, end of the run and t0 [s]."""
    until = min(touch + duration(parameters), end)
    return until / time_unit * (1 / parameters.impactStepFraction - 1 / parameters.stepFraction)


def reason(parameters, until):
    """The two steps in one line; until: when the longer one begins [s]."""
    return f"as given: {parameters.impactStepFraction:g} t0 until {until:.4g} s, then {parameters.stepFraction:g} t0"


def control(parameters, until):
    """Scene.control that sets the small steps between two samples: as many as make none longer than it may be."""
    ratio = parameters.stepFraction / parameters.impactStepFraction

    def set_steps(recorder, state):
        from yade.wrapper import Omega

        usual = recorder.schedule.interval
        begun = state["time"] > until * (1 - 1e-12)
        Omega().engines[0].subSteps = usual if begun else ceil(usual * ratio * (1 - 1e-12))
        return False

    return set_steps


def _refuse(step, given, must):
    raise ParameterError(f"impactStepFraction = {step:g}: given with {given}; must {must}")
