"""The time step of a collision: what a run needs of it, how stepFraction=auto is chosen, and the step that is expected."""

import numpy as np

from yade_scripts import stability, step_choice
from yade_scripts.experiments import plate
from yade_scripts.materials import pair_constants, require_small_contacts
from yade_scripts.packings.aggregate import EQUAL
from yade_scripts.parameters import ParameterError
from yade_scripts.stability import AUTO

LARGEST_NECK = 0.7  # the largest of S17


def complete(parameters, constants, threads):
    """The parameters with what depends on the contact and on YADE's threads: stepFraction and threads.

    constants: as run.scene.pair_constants() gives them; threads: of YADE. Raises ParameterError.
    """
    require_small_contacts(constants)
    if parameters.sizes != EQUAL:
        smallest = parameters.radius_range()[0]
        require_small_contacts(pair_constants(parameters, (smallest, smallest)))
    require_sintered(parameters.neck, constants)
    limit = step_limit(parameters, constants)
    if parameters.stepFraction == AUTO:
        parameters = parameters.changed(stepFraction=_longest_step(parameters, constants, limit))
    sintered = "neck, filling and drag" if parameters.neck else "filling and drag"
    stability.require_stable(parameters.stepFraction, limit, sintered)
    if parameters.duration is not None:
        stability.require_countable(parameters.duration, parameters.stepFraction, constants["timeUnit"])
    return parameters.with_threads(threads)


def step_limit(parameters, constants):
    """Largest stable stepFraction [t0] of a collision."""
    filling = stability.equivalent_filling(parameters.packing, parameters.filling, parameters.planar, constants)
    limit = stability.step_limit(constants, filling)
    if parameters.sizes == EQUAL:
        return limit
    return min(limit, stability.limit_of_unlike(parameters, constants, parameters.radius_range()))


def require_step_of_files(parameters, constants, pair):
    """Raise ParameterError when the step is unstable for the smallest grain of packings from files, whose radii are known
    only now, or contacts of such grains are too large.

    parameters: complete; constants: as for complete(); pair: of Packing.
    """
    radii = np.concatenate([packing.radius for packing in pair])
    smallest, largest = float(radii.min()), float(radii.max())
    if parameters.packing != "file" or smallest == largest:
        return
    require_small_contacts(pair_constants(parameters, (smallest, smallest)))
    unlike = stability.limit_of_unlike(parameters, constants, (smallest, largest), parameters.packing)
    stability.require_stable(
        parameters.stepFraction,
        min(step_limit(parameters, constants), unlike),
        "filling and drag, with the radii of the files",
    )


def reason_of_step(parameters, constants):
    """How complete() came to parameters.stepFraction, in one line."""
    if parameters.tolerance is None:
        return "as given"
    return step_choice.collision_reason(plate.as_pair(parameters), constants, step_limit(parameters, constants))


def expected_step(parameters, constants):
    """stepFraction as a run will have it."""
    if parameters.stepFraction != AUTO:
        return parameters.stepFraction
    try:
        return _longest_step(parameters, constants, step_limit(parameters, constants))
    except ParameterError:  # the run will say what is wrong
        return step_choice.SHORTEST


def _longest_step(parameters, constants, limit):
    step_choice.require_measured(plate.as_pair(parameters))
    return step_choice.longest_step(
        step_choice.collision_errors(plate.as_pair(parameters), constants), parameters, limit
    )


def require_sintered(neck, constants):
    """Raise ParameterError for a neck (radii of a grain) that is thinner than the contact itself."""
    unsintered = constants["equilibriumContactRadius"] / (2 * constants["reducedRadius"])
    if 0 < neck <= unsintered:
        raise ParameterError(
            f"neck = {neck:g}: no thicker than a contact that is not sintered; must be 0 (not sintered), or above "
            f"{unsintered:.4g} and at most {LARGEST_NECK}"
        )
