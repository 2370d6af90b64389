"""The limits of a run's time step, and of the number of steps.

Steps are in units of t0 (Kataoka et al. 2013, eq 2; `timeUnit`). constants: {name: value} of a contact of two grains,
as the plugin's pairConstants or materials.pair_constants give them, with the constants of a bond under "bond" where
grains are sintered."""

import math

from yade_scripts.materials import pair_constants
from yade_scripts.packings.lattice import maximum_filling
from yade_scripts.parameters import ParameterError

AUTO = "auto"
# The leapfrog is stable at 0.4 t0 and blows up at 0.5 t0 in the collision of Arakawa et al. (2024), without drag
# (measured).
STABLE_STEP = 0.4
SAFETY = STABLE_STEP / 0.5
# An hour for 50 grains, a week for 6,000: longer than any run on a desk machine.
MOST_STEPS = 1e9


def step_limit(constants, filling):
    """Largest stable stepFraction [t0].

    filling: of a CPE packing, or of one as stiff against turning (equivalent_filling).

    SAFETY times the step at which the first of two vibrations of a CPE packing grows, of contacts or of bonds: all
    grains turning in phase, or one moving against its neighbours. contact_law/MODEL.md, "What packings allow", has
    them, and the runs that blew up."""
    mass, contact_radius = 2 * constants["reducedMass"], constants["equilibriumContactRadius"]
    normal_stiffness = 1.2 * constants["pullOffForce"] / constants["equilibriumOverlap"]  # Arakawa et al. (2024), eq 38
    sliding_stiffness = constants["slidingStiffness"]
    lattice = maximum_filling(2 * constants["reducedRadius"], constants["equilibriumOverlap"])
    occupied = min(1.0, filling / lattice)
    turning = 2 / math.sqrt(40 * occupied * sliding_stiffness / mass)
    drag = 4 * 8 * (constants["dragPerContactRadius"] * contact_radius + constants["linearDrag"]) / mass
    stiffness = 8 * (normal_stiffness + sliding_stiffness) / mass
    moving = 8 / (drag + math.sqrt(drag**2 + 16 * stiffness))
    steps = [turning, moving]
    if constants.get("bond"):
        turning_bonds = 2 / math.sqrt(40 * occupied * constants["bond"]["slidingStiffness"] / mass)
        steps += [turning_bonds, bond_step(constants) * constants["timeUnit"]]
    return min(STABLE_STEP, SAFETY * min(steps) / constants["timeUnit"])


def bond_step(constants):
    """Step [t0] at which a grain vibrates unstably against eight bonded neighbours, as in step_limit()."""
    bond, mass = constants["bond"], 2 * constants["reducedMass"]
    stiffness = 8 * (bond["normalStiffness"] + bond["slidingStiffness"]) / mass
    return 2 / math.sqrt(stiffness) / constants["timeUnit"]


def equivalent_filling(packing, filling, planar, constants):
    """Filling factor of the CPE packing in space whose grains meet as much resistance when all turn in phase.

    packing: "cpe", "bcca", "bpca" or "file"; filling: of a cpe packing. Of 12 contacts of a site in space two thirds
    resist, of 6 in a plane all (a fraction of 3/4); of a BCCA or BPCA aggregate four are taken (1/2), which is more
    than most grains have; a packing from a file may be as dense as the lattice."""
    radius, overlap = 2 * constants["reducedRadius"], constants["equilibriumOverlap"]
    full = maximum_filling(radius, overlap)
    if packing in ("bcca", "bpca"):
        return 0.5 * full
    if packing == "file":
        return full
    if planar:
        return 0.75 * full * filling / maximum_filling(radius, overlap, planar=True)
    return filling


def limit_of_unlike(parameters, radius_range):
    """Largest stable stepFraction [t0 of two grains of grainRadius] of aggregates of grains of unlike size.

    parameters: of a collision; radius_range: (smallest, largest) [m]. The fastest vibration is that of the smallest
    grain among the largest ones: its contacts are stiffer than among its own kind."""
    stiffest = pair_constants(parameters, radius_range)
    smallest = pair_constants(parameters, (radius_range[0], radius_range[0]))
    stiffest.update(reducedMass=smallest["reducedMass"], timeUnit=pair_constants(parameters)["timeUnit"])
    return step_limit(stiffest, equivalent_filling(parameters.packing, None, False, stiffest))


def require_stable(step, limit, depends_on):
    """Raise ParameterError when a stepFraction is above its limit; depends_on: words for what sets that."""
    if step > limit:
        raise ParameterError(
            f"stepFraction = {step:g}: unstable at this {depends_on}; must be at most {limit:.3g} [t0]"
        )


def require_countable(duration, time_step):
    """Raise ParameterError when a run [s] would take more than MOST_STEPS steps [s]."""
    if duration > MOST_STEPS * time_step:
        raise ParameterError(
            f"duration = {duration:.6g}: must be at most {MOST_STEPS:g} steps, {MOST_STEPS * time_step:.3g} s"
        )
