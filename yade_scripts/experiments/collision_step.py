"""The time step of a collision: what a run needs of it, and a shorter one at the impact.

Most of the error of a collision's ledger arises while aggregates fly through each other, when many contacts form and
grains meet at the full velocity: of two BPCA of 50,000 grains at 50 m/s, 96 % in the first eighth of A22's time.
"""

from math import ceil

import numpy as np

from yade_scripts import time_step
from yade_scripts.materials import pair_constants, require_small_contacts
from yade_scripts.parameters import ParameterError

LARGEST_NECK = 0.7  # the largest of S17
SHORTEST = 100  # parts of stepFraction: shorter ones would be a slip of the pen, and a run without end
RADII = 4  # of the larger aggregate, that the two move against each other with the shorter step: both diameters


def complete(parameters, constants, threads):
    """The parameters with what depends on the contact (run.scene.pair_constants()) and on YADE's threads. Raises
    ParameterError."""
    require_small_contacts(constants)
    require_sintered(parameters.neck, constants)
    return with_step(parameters, constants).with_threads(threads)


def with_step(parameters, constants):
    """time_step.with_step() of a collision."""
    error = lambda: time_step.collision_error(parameters, constants)
    depends_on = "neck, filling and drag" if parameters.neck else "filling and drag"
    return time_step.with_step(parameters, step_limit(parameters, constants), error, depends_on)


def step_limit(parameters, constants):
    """Largest stable stepFraction [t0] of a collision of grains of one size."""
    filling = time_step.equivalent_filling(parameters.packing, parameters.filling, parameters.planar, constants)
    return time_step.step_limit(constants, filling)


def require_stable_with(parameters, pair):
    """Raise ParameterError when the step is unstable, or contacts too large, for the smallest grain of a pair of
    packings; parameters: complete; pair: list of Packing."""
    radii = np.concatenate([packing.radius for packing in pair])
    smallest, largest = float(radii.min()), float(radii.max())
    if smallest != largest:
        require_small_contacts(pair_constants(parameters, (smallest, smallest)))
        limit = limit_of_unlike(parameters, (smallest, largest))
        time_step.require_stable(parameters.stepFraction, limit, "filling and drag, with grains of these sizes")


def limit_of_unlike(parameters, radius_range):
    """Largest stable stepFraction [t0 of two grains of grainRadius] of aggregates of grains of unlike size.

    radius_range: (smallest, largest) [m]. The fastest vibration is that of the smallest grain among the largest ones:
    its contacts are stiffer than among its own kind."""
    stiffest = pair_constants(parameters, radius_range)
    smallest = pair_constants(parameters, (radius_range[0], radius_range[0]))
    stiffest.update(reducedMass=smallest["reducedMass"], timeUnit=pair_constants(parameters)["timeUnit"])
    return step_limit(parameters, stiffest)


def require_sintered(neck, constants):
    """Raise ParameterError for a neck (radii of a grain) that is thinner than the contact itself."""
    unsintered = constants["equilibriumContactRadius"] / (2 * constants["reducedRadius"])
    if 0 < neck <= unsintered:
        raise ParameterError(
            f"neck = {neck:g}: no thicker than a contact that is not sintered; must be 0 (not sintered), or above "
            f"{unsintered:.4g} and at most {LARGEST_NECK}"
        )


# ---- a shorter step at the impact ----


def require_usable(parameters):
    """Raise ParameterError when parameters.impactStepFraction doesn't go with the others."""
    short, usual = parameters.impactStepFraction, parameters.stepFraction
    if short is None:
        return
    if usual == time_step.AUTO:
        given, must = f"stepFraction = {usual}", "be left out, or stepFraction be a number"
    elif parameters.engine != "fused":
        given, must = f"engine = {parameters.engine}", "be left out: their step stays the same"
    elif not usual / SHORTEST <= short < usual:
        given, must = f"stepFraction = {usual:g}", "be below it and at least a hundredth of it"
    else:
        return
    raise ParameterError(f"impactStepFraction = {short:g}: given with {given}; must {must}")


def duration_of_impact(parameters):
    """How long [s] the shorter step holds from the first touch on; parameters: with the size of the aggregates."""
    return RADII * parameters.radius * parameters.grainRadius / parameters.velocity


def control(parameters, until):
    """Scene.control that sets the small steps between two samples: until that time [s] as many as make none longer
    than impactStepFraction."""
    ratio = parameters.stepFraction / parameters.impactStepFraction

    def set_steps(recorder, state):
        from yade.wrapper import Omega

        usual = recorder.schedule.interval
        begun = state["time"] > until * (1 - 1e-12)
        Omega().engines[0].subSteps = usual if begun else ceil(usual * ratio * (1 - 1e-12))
        return False

    return set_steps
