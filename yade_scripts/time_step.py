"""The time step of a run: the longest that is stable, and the longest for a tolerance (stepFraction=auto).

Steps are in units of t0 (Kataoka et al. 2013, K13, eq 2; `timeUnit`). constants: {name: value} of a contact of two
grains, as the plugin's pairConstants or materials.pair_constants give them, with the constants of a bond under "bond"
where grains are sintered."""

import math
from functools import partial

from yade_scripts.materials import OF_PAIRS, pair_constants
from yade_scripts.packings.aggregate import EQUAL
from yade_scripts.packings.lattice import maximum_filling
from yade_scripts.parameters import ParameterError

AUTO = "auto"
# Measured: the leapfrog is stable at 0.4 t0 and blows up at 0.5 t0 in the collision of A24, without drag.
STABLE_STEP = 0.4
SAFETY = STABLE_STEP / 0.5
# An hour for 50 grains, a week for 6,000: longer than any run on a desk machine.
MOST_STEPS = 1e9
SHORTEST = 0.01  # t0, of steps that are chosen: below, rather another tolerance


def with_step(parameters, limit, error, depends_on):
    """The parameters with their stepFraction, chosen where it is auto: error() is the ledger's error over the square of
    the step. Raises ParameterError for a step above the limit of stability [t0], which depends_on names in words, for
    auto in a run that was not measured, or with a tolerance that takes steps shorter than SHORTEST."""
    if parameters.stepFraction == AUTO:
        return parameters.changed(stepFraction=longest_step(error(), parameters.tolerance, limit))
    require_stable(parameters.stepFraction, limit, depends_on)
    return parameters


def reason(parameters, limit):
    """Why parameters.stepFraction is what it is, in one line."""
    step, most = parameters.stepFraction, parameters.tolerance
    if most is None:
        return "as given"
    why = "the limit of stability" if step == limit else f"below the limit of stability, {limit:.3g} t0"
    return f"{step:.3g} t0 for a ledger error of at most {most:g} in 95 % of runs ({why})"


def require_countable(duration, time_step):
    """Raise ParameterError when a run [s] would take more than MOST_STEPS steps [s]."""
    most = MOST_STEPS * time_step
    if duration > most:
        raise ParameterError(f"duration = {duration:.6g}: must be at most {MOST_STEPS:g} steps, {most:.3g} s")


# ---- stability (contact_law/MODEL.md, "What packings allow") ----


def require_stable(step, limit, depends_on):
    """Raise ParameterError when a stepFraction is above its limit; depends_on: words for what sets that."""
    if step > limit:
        must = f"must be at most {limit:.3g} [t0]"
        raise ParameterError(f"stepFraction = {step:g}: unstable at this {depends_on}; {must}")


def step_limit(constants, filling):
    """Largest stable stepFraction [t0] of a CPE packing of that filling, or one as stiff against turning
    (equivalent_filling): SAFETY times the step at which the first of these vibrations grows, of contacts or of
    bonds: all grains turning in phase, each against its neighbours, or one moving against its neighbours."""
    mass, contact_radius = 2 * constants["reducedMass"], constants["equilibriumContactRadius"]
    normal_stiffness = 1.2 * constants["pullOffForce"] / constants["equilibriumOverlap"]  # Arakawa et al. (2024), eq 38
    sliding_stiffness = constants["slidingStiffness"]
    lattice = maximum_filling(2 * constants["reducedRadius"], constants["equilibriumOverlap"])
    occupied = min(1.0, filling / lattice)
    damping = constants["springDamping"]
    turning = mass / (occupied * max(40 * sliding_stiffness, 10 * constants["rollingStiffness"]))
    turning = 2 * (math.sqrt(damping**2 + turning) - damping)
    drag = constants["dragPerContactRadius"] * contact_radius + constants["linearDrag"]
    drag = 4 * 8 * (drag + damping * sliding_stiffness) / mass
    stiffness = 8 * (normal_stiffness + sliding_stiffness) / mass
    moving = 8 / (drag + math.sqrt(drag**2 + 16 * stiffness))
    steps = [turning, moving]
    if constants.get("bond"):
        turning_bonds = 2 / math.sqrt(40 * occupied * constants["bond"]["slidingStiffness"] / mass)
        steps += [turning_bonds, bond_step(constants) * constants["timeUnit"]]
    return min(STABLE_STEP, SAFETY * min(steps) / constants["timeUnit"])


def limit_of(grains, constants, filling, radii=None):
    """step_limit() of grains that may be of unlike materials, or of sizes between radii (smallest, largest) [m].

    The fastest vibration is that of the lightest grains among those to which their contacts are stiffest, the largest.
    grains: materials.GrainParameters; constants: of two grains, whose time unit is the run's."""
    each = grains.of_each()
    if radii is None and len(each) == 1:
        return step_limit(constants, filling)
    smallest, largest = radii or 2 * (grains.grainRadius,)
    of = partial(pair_constants, linearDamping=getattr(grains, "linearDamping", 0.0))
    limits = []
    for one in each:
        own = {"reducedMass": of(one, (smallest, smallest))["reducedMass"], "timeUnit": constants["timeUnit"]}
        limits += [step_limit({**of(one, (smallest, largest), other=other), **own}, filling) for other in each]
    return min(limits)


def bond_step(constants):
    """Step [t0] at which a grain vibrates unstably against eight bonded neighbours."""
    bond, mass = constants["bond"], 2 * constants["reducedMass"]
    stiffness = 8 * (bond["normalStiffness"] + bond["slidingStiffness"]) / mass
    return 2 / math.sqrt(stiffness) / constants["timeUnit"]


def equivalent_filling(packing, filling, planar, constants):
    """Filling factor of the CPE packing in space whose grains meet as much resistance when all turn in phase.

    Of 12 contacts of a site in space two thirds resist, of 6 in a plane all (3/4); of BCCA and BPCA aggregates four are
    taken (1/2), more than most grains have; a packing from a file may be as dense as the lattice."""
    radius, overlap = 2 * constants["reducedRadius"], constants["equilibriumOverlap"]
    full = maximum_filling(radius, overlap)
    if packing in ("bcca", "bpca"):
        return 0.5 * full
    if packing == "file":
        return full
    if planar:
        return 0.75 * full * filling / maximum_filling(radius, overlap, planar=True)
    return filling


# ---- errors of the energy ledger (contact_law/MODEL.md, "What an error allows") ----

EVENTS, DECAY, SPEED = 0.056, 0.36, 0.0101
FLUFFY, CUT, PLATE = 3.0, 6.0, 1.6
BREAKING, BREAKING_FLUFFY, FEW = 0.12, 0.037, 0.15
FINAL, DENSER, UNDAMPED = 0.05, 7.75, 3.0
DAMPED = 0.01  # the least linearDamping that was measured to be as good as more
FILLINGS, LEAST_GRAINS, ROLLINGS = (0.1, 0.5), 64, (2.5, 60.0)  # of compressions that were measured
ROLLING_OF_ICE = 12.0  # F_c delta_c


def longest_step(error, tolerance, limit):
    """The longest step [t0] of two digits for a tolerance, at most limit [t0]; error: over the square of the step."""
    step = math.sqrt(tolerance / error)
    if step < SHORTEST:
        least = f"{1.06 * error * SHORTEST**2:.2g} in this scene, for {SHORTEST:g} t0"
        raise ParameterError(f"tolerance = {tolerance:g}: would take a step of {step:.2g} t0; must be at least {least}")
    unit = 10.0 ** (math.floor(math.log10(step)) - 1)
    return min(limit, float(f"{math.floor(round(step / unit, 9)) * unit:.2g}"))


def _require_measured(parameters, *unmeasured):
    """Raise ParameterError for a run that was not measured; (whether it is such a run, what that is), ..."""
    several = (
        (len(parameters.material_names) > 1, "two materials"),
        (not parameters.has_all_springs, "springs left out"),
        *(
            (getattr(parameters, name) != usual, f"{name} = {getattr(parameters, name):g}")
            for name, usual in OF_PAIRS.items()
        ),
    )
    for wrong, what in (*several, *unmeasured):
        if wrong:
            raise ParameterError(f"stepFraction = {AUTO}: not measured with {what}; must be a number [t0] here")


def collision_error(parameters, constants):
    """Error of a collision's ledger [K(0)] over the square of the step [t0], 95 % level. Raises ParameterError."""
    velocity = parameters.velocity
    _require_measured(
        parameters,
        (parameters.packing == "file", "packing = file"),
        (parameters.sizes != EQUAL, f"sizes = {parameters.sizes}"),
        (parameters.initialOverlap != 1, f"initialOverlap = {parameters.initialOverlap:g}"),
    )
    if parameters.target == "wall":  # half of a pair meets its image as an aggregate a plate
        velocity *= 2
    kinetic, of_grain = energies_of(constants, (parameters.grains, parameters.of_projectile().grains), velocity)
    error = scene_factor(parameters) * ledger_error(kinetic, of_grain)
    if bond := constants.get("bond"):
        of_bond = bond["breakingEnergy"] / (constants["pullOffForce"] * constants["pullOffOverlap"])
        breaking = BREAKING if parameters.packing == "cpe" else BREAKING_FLUFFY
        kinetic, of_grain = kinetic / of_bond, of_grain / of_bond
        of_bonds = breaking * (1 + 1 / kinetic) ** 0.5 * kinetic**-DECAY * of_grain**2 / (of_grain**2 + FEW**2)
        error += of_bonds / bond_step(constants) ** 2
    return error


def energies_of(constants, grains, velocity):
    """(K(0), the same for a grain) of a pair of so many grains (target, projectile), both over F_c delta_c."""
    contact = constants["pullOffForce"] * constants["pullOffOverlap"]
    target, projectile = grains
    reduced = 2 * constants["reducedMass"] * target * projectile / (target + projectile)  # a grain's mass is 2 m*
    kinetic = reduced * velocity**2 / 2 / contact
    return kinetic, kinetic / (target + projectile)


def scene_factor(parameters):
    """Errors over those of CPE aggregates in space whose springs are held at their limits."""
    plate = PLATE if parameters.target == "wall" else 1.0
    if parameters.limit == "cut":
        return CUT * plate
    return (FLUFFY if parameters.planar or parameters.packing != "cpe" else 1.0) * plate


def ledger_error(kinetic, of_grain):
    """Error [K(0)] over the square of the step [t0], of CPE aggregates in space; energies of energies_of()."""
    return EVENTS * (1 + 1 / kinetic) ** 0.5 * kinetic**-DECAY + SPEED * of_grain / (1 + of_grain) ** 0.8


def compression_error(parameters, constants):
    """Error of a compression's ledger [work of the boundaries], likewise."""
    # E_roll = 6 pi^2 gamma R xi_crit (K13 eq 1) over F_c delta_c; F_c = 3 pi gamma R/2
    rolling = 4 * math.pi * constants["criticalRolling"] / constants["pullOffOverlap"]
    final = parameters.finalFilling
    range_of_rolling = f"only {ROLLINGS[0]:g} to {ROLLINGS[1]:g} (not ice, or another criticalRolling)"
    _require_measured(
        parameters,
        (parameters.finalPressure is not None, "finalPressure, which may end a run at any filling"),
        (not FILLINGS[0] <= final <= FILLINGS[1], f"finalFilling = {final:.3g}, only {FILLINGS[0]} to {FILLINGS[1]}"),
        (parameters.grains < LEAST_GRAINS, f"fewer than {LEAST_GRAINS} grains"),
        (parameters.limit == "cut", "limit = cut in a compression"),
        (
            not ROLLINGS[0] <= rolling <= ROLLINGS[1],
            f"a rolling energy of {rolling:.3g} F_c delta_c, {range_of_rolling}",
        ),
    )
    damped = 1.0 if parameters.linearDamping >= DAMPED else UNDAMPED
    return FINAL * math.exp(-DENSER * final) * damped * max(1.0, ROLLING_OF_ICE / rolling) ** (2 / 3)
