"""Vibrations of a bonded pair in every mode and of a bonded chain, against closed forms of the springs (S17 eqs 1 to
5), functors and engine."""

from math import pi, sqrt

import pytest
from scenes import *
from scipy.linalg import eigh

pytestmark = pytest.mark.in_yade
# Ice of tests/scenes.py.
YOUNG, SHEAR, DENSITY, RADIUS = 7e9, 2.8e9, 1000.0, 1e-7
MASS = 4 / 3 * pi * DENSITY * RADIUS**3
INERTIA = 0.4 * MASS * RADIUS**2
DISTANCE = 1.99e-7  # of bonded grains' centres [m]
LEVER = 2 * RADIUS / DISTANCE  # sliding displacement a transverse one: zeta0 has the radii, its direction the distance
NECK = 0.5
MOVERS = ["functors", "fused"]


def start(mover, step, count, held=0):
    """A row of bonded grains along x, the first `held` of them without freedom; step in t0."""
    new_scene(step * unit, mover, neck=NECK)
    for k in range(count):
        grain((DISTANCE * k, 0, 0), 1e-7, ice(), blocked="xyzXYZ" if k < held else "")


def sampled(quantity, stride, number):
    """A quantity after every stride-th step."""
    found = []
    for _ in range(number):
        steps(stride)
        found.append(quantity())
    return found


def stiffnesses(neck):
    """(k_ss, k_st, k_sr, k_sw) [N/m, N/m, N m, N m] of a bond: S17 eqs 1 to 5, and the polar moment of the disk."""
    a = neck * RADIUS
    fillet = a**2 / (2 * (RADIUS - a))
    d = 2 * RADIUS * fillet / (RADIUS + fillet)
    return pi * a**2 * YOUNG / d, pi * a**2 * SHEAR / d, pi * a**4 * YOUNG / (4 * d), pi * a**4 * SHEAR / (2 * d)


def frequency(signal, interval):
    """(angular frequency [1/s], largest departure from one sinusoid over its amplitude) of samples at even intervals
    [s]."""
    q = np.asarray(signal)
    sides, middle = q[2:] + q[:-2], q[1:-1]
    cosine = (sides @ middle) / (2 * middle @ middle)
    return np.arccos(cosine) / interval, np.abs(sides - 2 * cosine * middle).max() / np.abs(q).max()


K_STRETCH, K_SLIDE, K_TILT, K_TWIST = stiffnesses(NECK)
SPEED, SPIN = 1e-3, 1e4  # m/s, 1/s: far below what bends the geometry
ACROSS = (0, -2 * LEVER * INERTIA / (MASS * RADIUS) * SPIN, 0)
SLIDES = LEVER**2 / MASS + RADIUS**2 / INERTIA
# Two free grains: initial relative velocity and spins of the mode (sliding: without angular momentum), what is
# watched, omega^2.
PAIR_MODES = {
    "stretching": ((SPEED, 0, 0), (0, 0, 0), (0, 0, 0), "vel", 0, -1, 2 * K_STRETCH / MASS),
    "sliding": (ACROSS, (0, 0, SPIN), (0, 0, SPIN), "angVel", 2, 1, 2 * K_SLIDE * SLIDES),
    "rolling": ((0, 0, 0), (0, 0, SPIN), (0, 0, -SPIN), "angVel", 2, -1, 2 * K_TILT / INERTIA),
    "twisting": ((0, 0, 0), (SPIN, 0, 0), (-SPIN, 0, 0), "angVel", 0, -1, 2 * K_TWIST / INERTIA),
}


@pytest.mark.parametrize("mover", MOVERS)
@pytest.mark.parametrize("mode", PAIR_MODES)
def test_a_bonded_pair_vibrates_in_every_mode(mode, mover):
    """At two steps: a leapfrog's frequency is (2/dt) asin(omega dt/2), too high by (omega dt)^2/24, of second order."""
    velocity, spin1, spin2, watched, axis, sign, square = PAIR_MODES[mode]
    exact, errors = sqrt(square), []
    for step in (0.08, 0.02):
        start(mover, step, 2)
        first, second = (b.state for b in O.bodies)
        second.vel, first.angVel, second.angVel = velocity, spin1, spin2
        steps(3)
        signal = sampled(lambda: getattr(first, watched)[axis] + sign * getattr(second, watched)[axis], 1, 400)
        omega, departure = frequency(signal, O.dt)
        assert departure < 1e-8
        assert omega == pytest.approx(2 / O.dt * np.arcsin(exact * O.dt / 2), rel=1e-7)
        errors.append(omega / exact - 1)
    assert errors[0] / errors[1] == pytest.approx(16, rel=0.05)


def bending_mode(bonds):
    """(omega [1/s], displacements (n,), angles (n,)) of the slowest bending of n grains behind a held one: transverse
    displacements y and angles theta, with zeta = r (theta_k + theta_k+1) - LEVER (y_k+1 - y_k) and the tilt theta_k+1 -
    theta_k of each bond."""
    n = bonds
    slide, tilt = np.zeros((n, 2 * n + 2)), np.zeros((n, 2 * n + 2))
    for k in range(n):
        slide[k, [k, k + 1]] = LEVER, -LEVER
        slide[k, [n + 1 + k, n + 2 + k]] = RADIUS
        tilt[k, [n + 1 + k, n + 2 + k]] = -1, 1
    free = np.r_[1 : n + 1, n + 2 : 2 * n + 2]
    stiffness = (K_SLIDE * slide.T @ slide + K_TILT * tilt.T @ tilt)[np.ix_(free, free)]
    squares, shapes = eigh(stiffness, np.diag(np.repeat([MASS, INERTIA], n)))
    shape = shapes[:, 0] / shapes[n - 1, 0]
    return sqrt(squares[0]), shape[:n], shape[n:]


@pytest.mark.parametrize("mover", MOVERS)
def test_a_bonded_chain_vibrates_as_a_beam(mover):
    """The first bending of eleven grains, the first one held: the eigenvalue of the springs' matrix, and Euler and
    Bernoulli's beam to the half per cent that ten lumps, their spins and their sliding leave."""
    bonds = 10
    omega, shape, angle = bending_mode(bonds)
    start(mover, 0.1, bonds + 1, held=1)
    for k in range(bonds):
        state = O.bodies[k + 1].state
        state.vel, state.angVel = (0, 1e-3 * shape[k], 0), (0, 0, 1e-3 * angle[k])
    steps(3)
    stride = int(2 * pi / (24 * omega * O.dt))
    measured, departure = frequency(sampled(lambda: O.bodies[bonds].state.vel[1], stride, 60), stride * O.dt)
    assert departure < 1e-6 and measured == pytest.approx(omega, rel=1e-6)
    length = (bonds + 0.5) * DISTANCE  # each grain stands for half a distance to either side
    beam = 1.8751**2 / length**2 * sqrt(K_TILT * DISTANCE * DISTANCE / MASS)
    assert omega == pytest.approx(beam, rel=0.005)
