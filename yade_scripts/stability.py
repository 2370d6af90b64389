"""The limits of a run's time step, and of the number of steps.

Steps are in units of t0 (Kataoka et al. 2013, eq 2; `timeUnit`). constants: {name: value} of a contact of two grains, as the plugin's
pairConstants or materials.pair_constants give them, with the constants of a bond under "bond" where grains are sintered.
"""

import math

from yade_scripts.materials import pair_constants
from yade_scripts.packings.filling import maximum_filling
from yade_scripts.parameters import ParameterError

AUTO = "auto"
# The leapfrog is stable at 0.4 t0 and blows up at 0.5 t0 in the collision of Arakawa et al. (2024), without drag (measured).
STABLE_STEP = 0.4
SAFETY = STABLE_STEP / 0.5
# An hour for 50 grains, a week for 6,000: longer than any run on a desk machine.
MOST_STEPS = 1e9


def step_limit(constants, filling):
    """Largest stable stepFraction [t0].

    filling: of a CPE packing, or of one as stiff against turning (equivalent_filling).

    SAFETY times the step at which the first of two vibrations of a CPE packing grows, each an estimate that
    was compared with runs. All grains turning in phase, against 12 p sliding springs each (p the filling
    relative to the full lattice's): w^2 = 40 p k_s/m, unstable from w dt = 2 on; runs blew up between 0.45
    and 0.5 t0 at filling 0.4, 0.4 and 0.45 at 0.6, 0.35 and 0.4 at 0.74. A grain moving against eight of
    twelve neighbours, each contact at 45 degrees to the motion: w^2 = 8 (k_n + k_s)/m with the drag 8 c/m,
    taken with the velocity extrapolated from the last two half steps: unstable from w^2 dt^2 + 4 (8 c/m) dt =
    4 on; runs with T_vis = 6 ps blew up between 0.25 and 0.3 t0 at filling 0.74.

    Bonds vibrate likewise, with k_ss and k_st for k_n and k_s. At necks of 0.2, 0.5 and 0.7 noise broke them from
    0.15, 0.17 and 0.18 t0 on at filling 0.4 and in a planar packing of filling 0.8, from 0.14, 0.15 and 0.16 at
    0.7, and from 0.21, 0.23 and 0.24 in BCCA.
    """
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
    resist, of 6 in a plane all (a fraction of 3/4); of a BCCA or BPCA aggregate four are taken (1/2), which is more than
    most grains have; a packing from a file may be as dense as the lattice.
    """
    radius, overlap = 2 * constants["reducedRadius"], constants["equilibriumOverlap"]
    full = maximum_filling(radius, overlap)
    if packing in ("bcca", "bpca"):
        return 0.5 * full
    if packing == "file":
        return full
    if planar:
        return 0.75 * full * filling / maximum_filling(radius, overlap, planar=True)
    return filling


def limit_of_unlike(grains, constants, radius_range, packing="bpca"):
    """Largest stable stepFraction [t0 of constants] of aggregates of grains of unlike size.

    grains: as for materials.pair_constants; radius_range: (smallest, largest) [m]; packing: "bcca", "bpca" or "file". The
    fastest vibration is that of the smallest grain among the largest ones: its contacts are stiffer than among its own
    kind.
    """
    stiffest = pair_constants(grains, radius_range)
    smallest = pair_constants(grains, (radius_range[0], radius_range[0]))
    stiffest.update(reducedMass=smallest["reducedMass"], timeUnit=constants["timeUnit"])
    return step_limit(stiffest, equivalent_filling(packing, None, False, stiffest))


def require_stable(step, limit, depends_on):
    """Raise ParameterError when a stepFraction is above its limit; depends_on: words for what sets that."""
    if step > limit:
        raise ParameterError(
            f"stepFraction = {step:g}: unstable at this {depends_on}; must be at most {limit:.3g} [t0]"
        )


def require_countable(duration, step, time_unit):
    """Raise ParameterError when a run [s] would take more than MOST_STEPS steps of `step` [t0]."""
    steps = duration / (step * time_unit) if step * time_unit > 0 else math.inf
    if steps > MOST_STEPS:
        raise ParameterError(
            f"duration = {duration:.6g}: {steps:.2g} steps of {step:g} t0; must be at most {MOST_STEPS:g} steps, "
            f"{MOST_STEPS * step * time_unit:.3g} s with this stepFraction"
        )
