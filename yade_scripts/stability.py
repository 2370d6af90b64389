"""The time step of a run: its limits, the largest number of steps, and the longest step for a tolerance.

Steps are in units of t0 (K13 eq 2, `timeUnit`). constants: {name: value} of a contact of two grains, as the plugin's
pairConstants or materials.pair_constants give them, with the constants of a bond under "bond" where grains are sintered.

The longest step for a tolerance (stepFraction=auto). The ledger closes with second order in the step s. What is left of
the largest |E(t) - E(0)|/K(0) of a run has two sources (e = F_c delta_c, the scale of a contact's energy; K(0): of all
grains together; N: their number):

- Contacts that form or break, or begin to slip, within a step. Each leaves an error of the order e s^2, and their number
  grows with the energy that there is for them, as 1 + x with x = K(0)/e. Of random sign they would leave
  s^2 (1 + x)^(1/2)/x of K(0), of one sign s^2 (1 + x)/x; measured is a power in between:
  EVENTS s^2 (1 + 1/x)^(1/2) x^-DECAY.
- The curvature of the normal force along the way that grains make in a step: SPEED s^2 k/(1 + k)^(4/5), where
  k = K(0)/(N e) is the relative velocity squared over 8 e/m. For small k this goes with the square of the overlap
  travelled in a step; for large k a contact lasts as long as Hertz's, ~ v^(-1/5), and the step over that time squared
  goes with k^(1/5).

The constants are such that 95 % of collisions stay below the sum. They were fitted by quantile regression to the 98 %
level of a grid of collisions: what was fitted to 95 % held for 90 % only of random scenes, which vary more, and this
holds for 96 % of them (tests/benchmarks/step_choice.py measures and fits; results/step_choice.md has fit and scatter,
step_choice.csv the data: 50 to 86,400 grains in an aggregate, fillings 0.2 to 0.65, 0.3 to 80 m/s, ice and silicate,
T_vis up to 6 ps). The typical error is a quarter of it. Filling and drag are left out: with drag errors are somewhat
smaller.
"""

import math

from yade_scripts.materials import pair_constants
from yade_scripts.packings.filling import maximum_filling
from yade_scripts.parameters import ParameterError

AUTO = "auto"
# Velocity Verlet is stable at 0.4 t0 and blows up at 0.5 t0 on A24's scene, without drag (measured).
STABLE_STEP = 0.4
SAFETY = STABLE_STEP / 0.5
SHORTEST = 0.01  # t0: below, rather another tolerance
# An hour for 50 grains, a week for 6,000: longer than any run on a desk machine.
MOST_STEPS = 1e9
EVENTS, DECAY, SPEED = 0.056, 0.36, 0.0101


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
    normal_stiffness = 1.2 * constants["pullOffForce"] / constants["equilibriumOverlap"]  # A24 eq 38
    sliding_stiffness = constants["slidingStiffness"]
    lattice = maximum_filling(2 * constants["reducedRadius"], constants["equilibriumOverlap"])
    occupied = min(1.0, filling / lattice)
    turning = 2 / math.sqrt(40 * occupied * sliding_stiffness / mass)
    drag = 4 * 8 * (constants["dragPerContactRadius"] * contact_radius + constants["linearDrag"]) / mass
    stiffness = 8 * (normal_stiffness + sliding_stiffness) / mass
    moving = 8 / (drag + math.sqrt(drag**2 + 16 * stiffness))
    steps = [turning, moving]
    if constants.get("bond"):
        bond = constants["bond"]
        steps += [
            2 / math.sqrt(40 * occupied * bond["slidingStiffness"] / mass),
            2 / math.sqrt(8 * (bond["normalStiffness"] + bond["slidingStiffness"]) / mass),
        ]
    return min(STABLE_STEP, SAFETY * min(steps) / constants["timeUnit"])


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


def limit_of_unlike(grains, constants, radius_range):
    """Largest stable stepFraction [t0 of constants] of aggregates of grains of unlike size.

    grains: as for materials.pair_constants; radius_range: (smallest, largest) [m]. The fastest vibration is that of the
    smallest grain among the largest ones: its contacts are stiffer than among its own kind.
    """
    stiffest = pair_constants(grains, radius_range)
    smallest = pair_constants(grains, (radius_range[0], radius_range[0]))
    stiffest.update(reducedMass=smallest["reducedMass"], timeUnit=constants["timeUnit"])
    return step_limit(stiffest, equivalent_filling("bpca", None, False, stiffest))


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


def longest_step(parameters, constants, limit):
    """The step [t0], rounded down to two digits: the longest that keeps to parameters.tolerance, at most limit.

    parameters: of a collision, with velocity, grains and tolerance. Raises ParameterError when the step would be
    shorter than SHORTEST.
    """
    per_square = sum(ledger_errors(*energies(parameters, constants)))
    step = math.sqrt(parameters.tolerance / per_square)
    if step < SHORTEST:
        least = _rounded(per_square * SHORTEST**2, math.ceil)
        raise ParameterError(
            f"tolerance = {parameters.tolerance:g}: would take a step of {step:.2g} t0 at "
            f"{parameters.velocity:.3g} m/s; must be at least {least:g} K(0) in this scene, "
            f"for {SHORTEST:g} t0, or stepFraction a number"
        )
    return min(limit, _rounded(step, math.floor))


def energies(parameters, constants):
    """(K(0), the same for a grain) of a collision, both over F_c delta_c."""
    contact = constants["pullOffForce"] * constants["pullOffOverlap"]
    grain = constants["reducedMass"] * (parameters.velocity / 2) ** 2 / contact  # a grain's mass is 2 m*
    return 2 * parameters.grains * grain, grain


def ledger_errors(kinetic, of_grain, events=EVENTS, decay=DECAY, speed=SPEED):
    """(of events, of speed): error of the ledger [K(0)] over the square of the step [t0], 95 % level.

    kinetic, of_grain: as energies() gives them, numbers or arrays.
    """
    return events * (1 + 1 / kinetic) ** 0.5 * kinetic**-decay, speed * of_grain / (1 + of_grain) ** 0.8


def reason(parameters, constants, limit):
    """Why parameters.stepFraction is what longest_step() gave, in one line."""
    events, speed = ledger_errors(*energies(parameters, constants))
    step, drag = parameters.stepFraction, "no drag"
    if parameters.viscoelasticTime:
        drag = f"T_vis = {parameters.viscoelasticTime * 1e12:.3g} ps"
    if step == limit:
        why = f"set by the limit of stability, where {(events + speed) * step**2:.1g} is expected"
    else:
        source = "forming and breaking contacts" if events > speed else "the speed of the impact"
        why = f"set by {source}; limit of stability {limit:.3g} t0"
    return (
        f"{step:.3g} t0 for a ledger error of at most {parameters.tolerance:g} K(0) in 95 % of runs, "
        f"{2 * parameters.grains} grains at {parameters.velocity:.3g} m/s, {drag} ({why})"
    )


def _rounded(x, direction):
    """x at two significant digits, by math.floor or math.ceil."""
    unit = 10.0 ** (math.floor(math.log10(x)) - 1)
    return float(f"{direction(round(x / unit, 9)) * unit:.2g}")
