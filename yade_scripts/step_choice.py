"""The longest time step for a tolerance (stepFraction=auto), from measured errors of the energy ledger.

Steps are in units of t0 (Kataoka et al. 2013, K13, eq 2). The ledger closes with second order in the step s, in every kind of
run that was measured. So an error is a sum of causes, each a number times s^2, and the longest step follows. What each causes, of the
largest |E(t) - E(0)|/K(0) of a collision (e = F_c delta_c, the scale of a contact's energy; K(0): of all grains together
in their centre of mass; N: their number):

- Contacts that form or break, or begin to slip, within a step. Each leaves an error of the order e s^2, and their number
  grows with the energy that there is for them, as 1 + x with x = K(0)/e. Of random sign they would leave
  s^2 (1 + x)^(1/2)/x of K(0), of one sign s^2 (1 + x)/x; measured is a power in between:
  EVENTS s^2 (1 + 1/x)^(1/2) x^-DECAY.
- The curvature of the normal force along the way that grains make in a step: SPEED s^2 k/(1 + k)^(4/5), where
  k = K(0)/(N e) is the relative velocity squared over 8 e/m. For small k this goes with the square of the overlap
  travelled in a step; for large k a contact lasts as long as Hertz's, ~ v^(-1/5), and the step over that time squared
  goes with k^(1/5).
- Sintered bonds that break. They are events too, of the energy b = pi a^2 gamma of a bond (Sirono & Ueno 2017, eq 6) and of
  its frequency: BREAKING (s/s_b)^2 (1 + 1/x_b)^(1/2) x_b^-DECAY, x_b = K(0)/b, s_b the step at which bonds become unstable.
  Few break where the grains' energy is far below a bond's: times k_b^2/(k_b^2 + FEW^2), k_b = K(0)/(N b).
  In BCCA and BPCA aggregates, of two bonds a grain, BREAKING_FLUFFY takes the place of BREAKING.

The first two are those of CPE aggregates in space. In a plane, and for BCCA and BPCA aggregates, which have fewer contacts
to share an impact and come to rest less soon, they are FLUFFY times as large; where springs are cut at their limits
(limit = cut), each cut an event more, CUT times. An aggregate that meets a plate counts as one of a pair at twice its velocity,
PLATE times: of 112 such runs (CPE, BCCA and BPCA of 60 to 700 grains, ice and silicate, 0.3 to 30 m/s, steps of 0.1 and 0.2 t0) 98 %
are below; without PLATE 90 %, and most of the others are of ice, at up to 3 m/s. A contact with a plate (R* = r, not r/2) has 2^(4/3) the energy
and 2^(7/6) the time of one of two grains: its events leave more, its curvature less. Of 16 more runs, with the step that this chooses, all
are below, the largest at 0.89 (tests/scripts/test_step_choice.py).

In a compression nothing has a speed of its own. What counts is the error over the work of the boundaries until the end.
Both grow with the contacts that have formed, the work faster: FINAL s^2 exp(-DENSER phi), phi the filling at the end.
Grains that nothing damps vibrate on: UNDAMPED times. The work goes with the rolling energy: where that is less than ice's
of K13, which is ROLLING_OF_ICE e, errors are larger by the ratio to the power of 2/3. The rate, which was 3e-7 to 1e-4 of 1/t0, and the
number of grains matter little. Dense silicate and springs that are cut leave much larger errors: refused. Under a piston the errors are
no larger: 41 of 42 layers of 64 to 1000 grains are below, half of them below 0.22 (final fillings of 0.2 to 0.5, rates of 1e-5 to 3e-4/t0,
steps of 0.1 to 0.3 t0), and of 4 more, with the step that this chooses, all are, the largest at 0.56.

The constants are such that 95 % of runs stay below the sum. They were fitted to the 98 % level of grids of runs and
judged by runs drawn at random (docs/measurements.md says by how many, and where the data are). The typical error is a quarter of it.
Drag leaves somewhat smaller errors and is left out, but where it limits the step (stability.step_limit).
"""

import math

from yade_scripts.packings.aggregate import EQUAL
from yade_scripts.parameters import ParameterError
from yade_scripts.stability import AUTO, bond_step

SHORTEST = 0.01  # t0: below, rather another tolerance
EVENTS, DECAY, SPEED = 0.056, 0.36, 0.0101
FLUFFY, CUT, PLATE = 3.0, 6.0, 1.6
BREAKING, BREAKING_FLUFFY, FEW = 0.12, 0.037, 0.15
FINAL, DENSER, UNDAMPED = 0.05, 7.75, 3.0
DAMPED = 0.01  # the least linearDamping that was measured to be as good as more
FILLINGS, LEAST_GRAINS, ROLLINGS = (0.1, 0.5), 64, (2.5, 60.0)  # of compressions that were measured
ROLLING_OF_ICE = 12.0  # F_c delta_c


def require_measured(parameters):
    """Raise ParameterError for a collision of which nothing was measured."""
    if parameters.packing == "file":
        _refuse("packing = file")
    _require_usual_sliding(parameters)
    if parameters.sizes != EQUAL:
        _refuse(f"sizes = {parameters.sizes}")
    if parameters.initialOverlap != 1:
        _refuse(f"initialOverlap = {parameters.initialOverlap:g}")


def require_measured_compression(parameters, constants):
    """Raise ParameterError for a compression of which nothing was measured."""
    _require_usual_sliding(parameters)
    if parameters.finalPressure is not None:
        _refuse("finalPressure, which may end a run at any filling")
    if not FILLINGS[0] <= parameters.finalFilling <= FILLINGS[1]:
        _refuse(f"finalFilling = {parameters.finalFilling:.3g}, only {FILLINGS[0]:g} to {FILLINGS[1]:g}")
    if parameters.grains < LEAST_GRAINS:
        _refuse(f"fewer than {LEAST_GRAINS} grains")
    if parameters.limit == "cut":
        _refuse("limit = cut in a compression")
    if not ROLLINGS[0] <= rolling_energy(constants) <= ROLLINGS[1]:
        _refuse(
            f"a rolling energy of {rolling_energy(constants):.3g} F_c delta_c, only {ROLLINGS[0]:g} to {ROLLINGS[1]:g} "
            "(other than ice, or another criticalRolling)"
        )


def _require_usual_sliding(parameters):
    if parameters.slidingStiffnessFactor != 1:
        _refuse(f"slidingStiffnessFactor = {parameters.slidingStiffnessFactor:g}")


def _refuse(what):
    raise ParameterError(f"stepFraction = {AUTO}: not measured with {what}; must be a number [t0] here")


def longest_step(errors, parameters, limit):
    """The step [t0], rounded down to two digits: the longest that keeps to parameters.tolerance, at most limit.

    errors: {cause: error over the square of the step}. Raises ParameterError when the step would be shorter than SHORTEST.
    """
    per_square = sum(errors.values())
    step = math.sqrt(parameters.tolerance / per_square)
    if step < SHORTEST:
        least = _rounded(per_square * SHORTEST**2, math.ceil)
        raise ParameterError(
            f"tolerance = {parameters.tolerance:g}: would take a step of {step:.2g} t0; must be at least {least:g} "
            f"in this scene, for {SHORTEST:g} t0, or stepFraction a number"
        )
    return min(limit, _rounded(step, math.floor))


def collision_errors(parameters, constants):
    """{cause: error of a collision's ledger [K(0)] over the square of the step [t0]}, 95 % level.

    constants: of a contact, with those of a bond under "bond" where grains are sintered.
    """
    kinetic, of_grain = energies(parameters, constants)
    events, speed = ledger_errors(kinetic, of_grain)
    factor = scene_factor(parameters)
    found = {"forming and breaking contacts": factor * events, "the speed of the impact": factor * speed}
    bond = constants.get("bond")
    if bond:
        over = bond["breakingEnergy"] / (constants["pullOffForce"] * constants["pullOffOverlap"])
        breaking = BREAKING if parameters.packing == "cpe" else BREAKING_FLUFFY
        found["breaking bonds"] = bond_errors(kinetic / over, of_grain / over, breaking) / bond_step(constants) ** 2
    return found


def energies(parameters, constants):
    """(K(0), the same for a grain) of a collision, both over F_c delta_c."""
    return energies_of(constants, (parameters.grains, parameters.of_projectile().grains), parameters.velocity)


def energies_of(constants, grains, velocity):
    """energies() of a pair of so many grains (target, projectile)."""
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


def ledger_errors(kinetic, of_grain, events=EVENTS, decay=DECAY, speed=SPEED):
    """(of events, of speed): error of the ledger [K(0)] over the square of the step [t0], 95 % level.

    kinetic, of_grain: as energies() gives them, numbers or arrays. Of CPE aggregates in space.
    """
    return events * (1 + 1 / kinetic) ** 0.5 * kinetic**-decay, speed * of_grain / (1 + of_grain) ** 0.8


def bond_errors(kinetic, of_grain, breaking):
    """Error of breaking bonds [K(0)] over the square of the step [stability.bond_step].

    kinetic, of_grain: as energies() gives them, over the energy that breaks a bond; numbers or arrays.
    """
    return breaking * (1 + 1 / kinetic) ** 0.5 * kinetic**-DECAY * of_grain**2 / (of_grain**2 + FEW**2)


def compression_errors(parameters, constants):
    """{cause: error of a compression's ledger [work of the boundaries] over the square of the step [t0]}, 95 % level."""
    damped = 1.0 if parameters.linearDamping >= DAMPED else UNDAMPED
    easily_rolled = max(1.0, ROLLING_OF_ICE / rolling_energy(constants)) ** (2 / 3)
    return {"the contacts that form": FINAL * math.exp(-DENSER * parameters.finalFilling) * damped * easily_rolled}


def rolling_energy(constants):
    """E_roll = 6 pi^2 gamma R xi_crit (K13 eq 1), R the radius of a grain, over F_c delta_c; F_c = 3 pi gamma R/2."""
    return 4 * math.pi * constants["criticalRolling"] / constants["pullOffOverlap"]


def collision_reason(parameters, constants, limit):
    """Why a collision's parameters.stepFraction is what longest_step() gave, in one line."""
    drag = f"T_vis = {parameters.viscoelasticTime * 1e12:.3g} ps" if parameters.viscoelasticTime else "no drag"
    necks = f", necks of {parameters.neck:g}" if parameters.neck else ""
    grains = parameters.grains + parameters.of_projectile().grains
    scene = f"{grains} grains at {parameters.velocity:.3g} m/s, {drag}{necks}"
    return _reason(collision_errors(parameters, constants), parameters, limit, "of K(0)", scene)


def compression_reason(parameters, constants, limit):
    """The same of a compression."""
    scene = f"to a filling of {parameters.finalFilling:.3g}, k_n = {parameters.linearDamping:g}"
    return _reason(compression_errors(parameters, constants), parameters, limit, "of the work of the boundaries", scene)


def _reason(errors, parameters, limit, unit, scene):
    step = parameters.stepFraction
    if step == limit:
        why = f"set by the limit of stability, where {sum(errors.values()) * step**2:.1g} is expected"
    else:
        why = f"set by {max(errors, key=errors.get)}; limit of stability {limit:.3g} t0"
    return (
        f"{step:.3g} t0 for a ledger error of at most {parameters.tolerance:g} {unit} in 95 % of runs, {scene} ({why})"
    )


def _rounded(x, direction):
    """x at two significant digits, by math.floor or math.ceil."""
    unit = 10.0 ** (math.floor(math.log10(x)) - 1)
    return float(f"{direction(round(x / unit, 9)) * unit:.2g}")
