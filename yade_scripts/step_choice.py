"""The longest step that keeps the energy ledger of a collision within a tolerance (stepFraction=auto).

The ledger closes with second order in the step s [t0]. What is left of the largest |E(t) - E(0)|/K(0) of a run
has two sources (e = F_c delta_c, the scale of a contact's energy; K(0): of all grains together; N: their number):

- Contacts that are born or broken, or begin to slip, in the midst of a step. Each leaves an error of the order
  e s^2, and their number grows with the energy that there is for them, as 1 + x with x = K(0)/e. Of random sign
  they would leave s^2 (1 + x)^(1/2)/x of K(0), of one sign s^2 (1 + x)/x; measured is a power in between:
  EVENTS s^2 (1 + 1/x)^(1/2) x^-DECAY.
- The curvature of the normal force along the way that grains make in a step: SPEED s^2 k/(1 + k)^(4/5), where
  k = K(0)/(N e) is the relative velocity squared over 8 e/m. For small k this goes with the square of the
  overlap travelled in a step; for large k a contact lasts as long as Hertz's, ~ v^(-1/5), and the step over that
  time squared goes with k^(1/5).

The constants are such that 95 % of collisions stay below the sum. They were fitted by quantile regression to the 98 %
level of a grid of collisions: what was fitted to 95 % held for 90 % only of random scenes, which vary more, and
this holds for 96 % of them (tests/benchmarks/step_choice.py measures and fits; results/step_choice.md has fit and
scatter, step_choice.csv the data: 50 to 86,400 grains in an aggregate, fillings 0.2 to 0.65, 0.3 to 80 m/s, ice and
silicate, T_vis up to 6 ps). The typical error is a quarter of it. Filling and drag are left out: with drag errors are
somewhat smaller.
"""

import math

AUTO = "auto"
EVENTS, DECAY, SPEED = 0.056, 0.36, 0.0101
SHORTEST = 0.01  # t0: below, rather another tolerance


class ToleranceTooTight(ValueError):
    """No sensible step keeps to a tolerance; the message is one line: what, and what is allowed."""


def choose(values, constants, limit):
    """The step [t0], rounded down to two digits: the longest that keeps to values['tolerance'], at most limit.

    values: parameters as parse() gives them; constants: the plugin's pairConstants of two grains; limit:
    parameters.step_limit. Raises ToleranceTooTight when the step would be shorter than SHORTEST.
    """
    events, speed = coefficients(*energies(values, constants))
    step = math.sqrt(values["tolerance"] / (events + speed))
    if step < SHORTEST:
        least = _rounded((events + speed) * SHORTEST**2, math.ceil)
        raise ToleranceTooTight(
            f'tolerance = {values["tolerance"]:g}: would take a step of {step:.2g} t0 at '
            f'{values["velocity"]:.3g} m/s; allowed: at least {least:g} K(0) in this scene, '
            f'for {SHORTEST:g} t0, or stepFraction as a number'
        )
    return min(limit, _rounded(step, math.floor))


def energies(values, constants):
    """(K(0), the same for a grain), both over F_c delta_c."""
    contact = constants["pullOffForce"] * constants["pullOffOverlap"]
    grain = constants["reducedMass"] * (values["velocity"] / 2) ** 2 / contact  # a grain's mass is 2 m*
    return 2 * values["grains"] * grain, grain


def coefficients(kinetic, of_grain, events=EVENTS, decay=DECAY, speed=SPEED):
    """(of events, of speed): error of the ledger [K(0)] over the square of the step [t0], 95 % level.

    kinetic, of_grain: as energies() gives them, numbers or arrays.
    """
    return events * (1 + 1 / kinetic) ** 0.5 * kinetic**-decay, speed * of_grain / (1 + of_grain) ** 0.8


def reason(values, constants, limit):
    """Which step complete() chose and why, in one line."""
    events, speed = coefficients(*energies(values, constants))
    step = values["stepFraction"]
    drag = f'T_vis = {values["viscoelasticTime"] * 1e12:.3g} ps' if values["viscoelasticTime"] else "no drag"
    if step == limit:
        why = f"set by the limit of stability, where {(events + speed) * step**2:.1g} is expected"
    else:
        source = "contacts' births and breaks" if events > speed else "the speed of the impact"
        why = f"set by {source}; limit of stability {limit:.3g} t0"
    return (
        f'{step:.3g} t0 for a ledger error of at most {values["tolerance"]:g} K(0) in 95 % of runs, '
        f'{2 * values["grains"]} grains at {values["velocity"]:.3g} m/s, {drag} ({why})'
    )


def _rounded(x, direction):
    """x at two significant digits, by math.floor or math.ceil."""
    unit = 10.0 ** (math.floor(math.log10(x)) - 1)
    return float(f"{direction(round(x / unit, 9)) * unit:.2g}")
