"""Head-on collision of two grains with JKR force and drag (A22 eqs 4-10 and 30), integrated to high accuracy.

Units inside: overlap in delta0, velocity in (F_c delta0/m*)^(1/2), time in (m* delta0/F_c)^(1/2). The overlap is
counted from the pull-off, h = delta/delta0 + (9/16)^(1/3), where the force has its square-root branch point."""

from dataclasses import dataclass
from math import inf, isfinite, sqrt

import numpy as np
from scipy.integrate import solve_ivp

from .jkr import ENERGY_SCALE, PULL_OFF_OVERLAP, _root_from_distance

ENERGY_AT_PULL_OFF = 4.0 / 45.0  # U_n(-delta_c)/(F_c delta_c), A22 eq 10
ENERGY_AT_CONTACT = -8.0 / 15.0 * 2.0 ** (2.0 / 3.0)  # U_n(0)/(F_c delta_c), A22 eq 9
_TOLERANCES = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-13}
_LONGEST = 1e4  # in time units: far longer than any collision, a guard against an endless integration


@dataclass(frozen=True)
class PairCollision:
    """Outcome of a head-on collision: sticks, rebound_velocity [m/s] (0 when it sticks), restitution (rebound over
    impact velocity), duration [s] from first contact to separation (infinite when it sticks), largest_overlap [m]."""

    sticks: bool
    rebound_velocity: float
    restitution: float
    duration: float
    largest_overlap: float


class _PairMotion:
    """A22 eq 30 without dimensions: h'' = -F/F_c."""

    def __init__(self, pair):
        self.length = pair.equilibrium_overlap
        self.velocity = sqrt(pair.pull_off_force * self.length / pair.reduced_mass)
        self.time = self.length / self.velocity
        unit = self.velocity / pair.pull_off_force
        self.contact_drag = pair.drag_per_contact_radius * pair.equilibrium_contact_radius * unit
        self.linear_drag = pair.linear_drag * unit

    def forces(self, h, rate):
        u = float(_root_from_distance(max(h, 0.0)))
        return 4.0 * u**3 * (u**3 - 1.0), (self.contact_drag * u * u + self.linear_drag) * rate

    def forward(self, _, state):
        elastic, drag = self.forces(*state)
        return state[1], -elastic - drag

    def backward(self, _, state):
        rate, acceleration = self.forward(_, state)
        return -rate, -acceleration

    @staticmethod
    def energy_above_pull_off(h, rate):
        """Kinetic energy plus U_n minus U_n(-delta_c), in units of F_c delta0."""
        u = float(_root_from_distance(max(h, 0.0)))
        potential = ENERGY_SCALE * u**4 * (0.8 * u**6 - 4.0 / 3.0 * u**3 + 1.0 / 3.0)
        return 0.5 * rate * rate + PULL_OFF_OVERLAP * (potential - ENERGY_AT_PULL_OFF)


def sticking_velocity_without_drag(pair):
    """Largest impact velocity [m/s] at which two perfectly elastic grains stick, closed form: the kinetic energy at
    first contact equals what connection and disconnection take, m* v^2/2 = (8/15 2^(2/3) + 4/45) F_c delta_c (A22 eqs
    9, 10)."""
    lost = (ENERGY_AT_PULL_OFF - ENERGY_AT_CONTACT) * pair.pull_off_force * pair.pull_off_overlap
    return sqrt(2.0 * lost / pair.reduced_mass)


def sticking_velocity(pair):
    """Largest impact velocity [m/s] at which a head-on pair sticks, with the pair's drag; infinite when it always
    sticks.

    The threshold trajectory arrives at the pull-off at rest, and only one does: it is followed backward in time from
    there (A22 eq 30) to the first contact, delta = 0, where its velocity is the threshold."""
    motion = _PairMotion(pair)

    first_contact = _event(lambda _, state: state[0] - PULL_OFF_OVERLAP)
    runs_away = _event(lambda _, state: state[0] - 1e8, direction=0)
    path = solve_ivp(motion.backward, (0.0, _LONGEST), (0.0, 0.0), events=(first_contact, runs_away), **_TOLERANCES)
    return path.y_events[0][0][1] * motion.velocity if len(path.t_events[0]) else inf


def _start(velocity, pair):
    if not (isfinite(velocity) and velocity > 0):
        raise ValueError(f"impact velocity must be positive and finite, got {velocity!r}")
    motion = _PairMotion(pair)
    return motion, (PULL_OFF_OVERLAP, velocity / motion.velocity)


def _event(function, direction=-1):
    function.terminal, function.direction = True, direction
    return function


def _compress(motion, start):
    """The way in, from first contact to the largest overlap, or to rest where drag lets the pair creep into
    equilibrium."""
    turning = _event(lambda _, state: state[1])
    bottom = motion.energy_above_pull_off(1.0 + PULL_OFF_OVERLAP, 0.0)
    rest = _event(lambda _, state: motion.energy_above_pull_off(*state) - bottom - 1e-14)
    path = solve_ivp(motion.forward, (0.0, _LONGEST), start, events=(turning, rest), **_TOLERANCES)
    return path.t[-1], path.y[:, -1]


def collide_pair(velocity, pair):
    """PairCollision of two grains meeting head-on with relative velocity [m/s] > 0 (A22 eq 30); ValueError otherwise.

    Separation is at delta = -delta_c; the pair has stuck as soon as its energy no longer reaches the pull-off."""
    motion, start = _start(velocity, pair)
    time_in, top = _compress(motion, start)
    largest = (top[0] - PULL_OFF_OVERLAP) * motion.length
    if motion.energy_above_pull_off(*top) > 0:
        separation = _event(lambda _, state: state[0])
        captured = _event(lambda _, state: motion.energy_above_pull_off(*state))
        path = solve_ivp(motion.forward, (0.0, _LONGEST), top, events=(separation, captured), **_TOLERANCES)
        if len(path.t_events[0]):
            rebound = -path.y[1, -1] * motion.velocity
            return PairCollision(False, rebound, rebound / velocity, (time_in + path.t[-1]) * motion.time, largest)
    return PairCollision(True, 0.0, 0.0, inf, largest)


def pair_motion(velocity, pair, times):
    """Overlap [m] (T,) and its rate [m/s] (T,) of a head-on pair at times [s] (T,) after first contact (A22 eq 30).

    velocity [m/s] > 0 is the relative velocity at first contact; after a separation both are NaN.
    """
    motion, start = _start(velocity, pair)
    times = np.asarray(times, dtype=float) / motion.time
    separation = _event(lambda _, state: state[0])
    path = solve_ivp(
        motion.forward, (0.0, max(times.max(), 1e-9)), start, events=separation, dense_output=True, **_TOLERANCES
    )
    h, rate = path.sol(np.minimum(times, path.t[-1]))
    apart = times > path.t[-1]
    return (
        np.where(apart, np.nan, (h - PULL_OFF_OVERLAP) * motion.length),
        np.where(apart, np.nan, rate * motion.velocity),
    )
