"""The motion of Andrews's spheres: compression and velocity against time, through the return phase (A24 Fig.
12)."""

from dataclasses import dataclass

import numpy as np
from scipy.interpolate import CubicHermiteSpline

from .andrews import (
    compression_force,
    compression_work,
    critical_compression,
    initial_kinetic_energy,
    largest_compression,
    plastic_compression,
    plastic_time,
    reduced_mass,
    restitution,
    return_compression,
    return_force,
    returned_work,
)

_CELLS = 200  # of each phase; halving them changes the times by less than 1e-9 of tau_max
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(8)


@dataclass(frozen=True)
class Motion:
    """compression(t) [m] and velocity(t) [m/s] (positive while it grows) of two spheres that touch at t = 0
    [s]; largest [m] at time_of_largest [s]; they part at time_of_parting [s] with the restitution."""

    largest: float
    time_of_largest: float
    time_of_parting: float
    restitution: float
    _velocity: float
    _spline: CubicHermiteSpline
    _speed: CubicHermiteSpline

    def compression(self, time):
        """delta (T,) [m] at times (T,) [s], before contact and after parting too (there on straight
        lines)."""
        time = np.asarray(time, dtype=float)
        after = self._spline(self.time_of_parting) - self.restitution * self._velocity * (time - self.time_of_parting)
        inside = self._spline(np.clip(time, 0.0, self.time_of_parting))
        return np.where(time < 0, self._velocity * time, np.where(time > self.time_of_parting, after, inside))

    def velocity(self, time):
        """v (T,) [m/s] at times (T,) [s]."""
        return self._speed(np.clip(np.asarray(time, dtype=float), 0.0, self.time_of_parting))


@dataclass(frozen=True)
class RigidMotion:
    """The same of spheres without elasticity (E* = inf): a quarter of a harmonic oscillation, and rest."""

    largest: float
    time_of_largest: float
    restitution: float
    _velocity: float

    def compression(self, time):
        """delta (T,) [m] at times (T,) [s]."""
        time = np.asarray(time, dtype=float)
        phase = 0.5 * np.pi * np.clip(time / self.time_of_largest, 0.0, 1.0)
        return np.where(time < 0, self._velocity * time, self.largest * np.sin(phase))

    def velocity(self, time):
        """v (T,) [m/s] at times (T,) [s]."""
        phase = 0.5 * np.pi * np.clip(np.asarray(time, dtype=float) / self.time_of_largest, 0.0, 1.0)
        return self._velocity * np.where(phase < 0.5 * np.pi, np.cos(phase), 0.0)


def rigid_motion(velocity, spheres):
    """RigidMotion of spheres (andrews.Spheres of floats with E* = inf) that collide at velocity [m/s]: with eq 26 and
    delta_crit = 0 the force is that of a spring, pi R* sigma, until v = 0 (eqs 31, 33)."""
    largest = float(plastic_compression(velocity, spheres))
    return RigidMotion(largest, float(plastic_time(velocity, spheres)), 0.0, float(velocity))


def motion(velocity, spheres):
    """Motion of spheres (andrews.Spheres of floats, both moduli finite) that collide at velocity [m/s].

    With delta = delta_max - s^2 the time is the integral of 2 s/|v(delta)| over s, which is smooth, v
    following from the energy; between the nodes delta and v are cubics with the right slopes."""
    largest = float(largest_compression(velocity, spheres))
    yield_at = min(float(critical_compression(spheres)), largest)
    kinetic, mass = initial_kinetic_energy(velocity, spheres), reduced_mass(spheres)
    apart = float(return_compression(spheres, largest))

    def approach(delta):
        return np.sqrt(np.maximum(2.0 * (kinetic - compression_work(delta, spheres)) / mass, 0.0))

    given_back = float(returned_work(largest, largest, spheres))

    def parting(delta):
        return np.sqrt(np.maximum(2.0 * (given_back - returned_work(delta, largest, spheres)) / mass, 0.0))

    down = _nodes(largest, (largest, yield_at, 0.0))
    approaching = _times(down, largest, approach)
    tau = approaching[-1]
    back = _nodes(largest, (largest, apart))
    returning = _times(back, largest, parting)
    time = np.concatenate([tau - approaching[::-1], tau + returning[1:]])
    delta = np.concatenate([(largest - down**2)[::-1], (largest - back**2)[1:]])
    speed = np.concatenate([approach(largest - down**2)[::-1], -parting(largest - back**2)[1:]])
    speed[len(down) - 1] = 0.0
    force = np.concatenate(
        [compression_force((largest - down**2)[::-1], spheres), return_force((largest - back**2)[1:], largest, spheres)]
    )
    return Motion(
        largest,
        float(tau),
        float(time[-1]),
        float(restitution(velocity, spheres)),
        float(velocity),
        CubicHermiteSpline(time, delta, speed),
        CubicHermiteSpline(time, speed, -force / mass),
    )


def _nodes(largest, stops):
    """Values of s = (largest - delta)^(1/2), rising from 0, through each compression in `stops`."""
    s = np.sqrt(np.maximum(largest - np.asarray(stops), 0.0))
    parts = [np.linspace(a, b, _CELLS + 1) for a, b in zip(s[:-1], s[1:]) if b > a]
    return np.unique(np.concatenate(parts))


def _times(s, largest, speed):
    """Time (n,) [s] from delta_max to each node s (n,), by Gauss's rule in each cell."""
    half, middle = 0.5 * np.diff(s), 0.5 * (s[1:] + s[:-1])
    inner = middle[:, None] + half[:, None] * _NODES
    return np.concatenate([[0.0], np.cumsum(half * ((2.0 * inner / speed(largest - inner**2)) @ _WEIGHTS))])
