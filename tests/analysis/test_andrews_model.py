"""Andrews's model against a numerical integration of its motion, its limits and A24's numbers."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from analysis.studies.elastoplastic.andrews_fit import degenerate_curve
from analysis.theory import andrews
from analysis.theory.andrews import Spheres
from analysis.theory.andrews_motion import motion, rigid_motion

V = 10**0.5
PAPER = Spheres(0.5 * 80.271e-7, 400.0, 2.25e6, 15.7e6)
# Mostly plastic, as the paper's, just beyond yield, and elastic throughout.
CASES = {
    "plastic": Spheres(2e-6, 400.0, 1.7e6, 80e6),
    "paper": PAPER,
    "yielding": Spheres(4e-6, 400.0, 3.2e6, 15.7e6),
    "elastic": Spheres(4e-6, 300.0, 9e6, 5e6),
}


@pytest.fixture(params=CASES, ids=str)
def spheres(request):
    return CASES[request.param]


def integrate(spheres):
    """(times [s], compressions [m], velocities [m/s]) until the largest compression and from there until parting, from the force alone."""
    mass, scale = andrews.reduced_mass(spheres), spheres.reduced_radius

    def until(end, start, state, force):
        moving = lambda t, y: [y[1], -force(y[0] * scale) / (mass * scale)]
        end.terminal, end.direction = True, -1
        how = {"rtol": 1e-11, "atol": 1e-13 * V / scale, "method": "DOP853", "max_step": 2e-9}
        found = solve_ivp(moving, (start, start + 1e-5), state, events=end, **how)
        return found.t, *(scale * found.y)

    there = until(lambda t, y: y[1], 0.0, [0.0, V / scale], lambda d: andrews.compression_force(d, spheres))
    largest = there[1][-1]
    apart = andrews.return_compression(spheres, largest) / scale
    force = lambda d: andrews.return_force(d, largest, spheres)
    return there, until(lambda t, y: y[0] - apart, there[0][-1], [largest / scale, 0.0], force)


def test_motion_and_closed_forms_agree_with_the_integrated_force(spheres):
    there, back = integrate(spheres)
    course, largest, restitution = motion(V, spheres), there[1][-1], -back[2][-1] / V
    for time, compression, velocity in (there, back):
        assert course.compression(time) == pytest.approx(compression, abs=1e-6 * largest)
        assert course.velocity(time) == pytest.approx(velocity, abs=1e-4 * V)
    assert course.largest == andrews.largest_compression(V, spheres) == pytest.approx(largest, rel=1e-8)
    assert course.time_of_largest == pytest.approx(there[0][-1], rel=1e-6)
    assert andrews.time_of_largest_compression(V, spheres) == pytest.approx(there[0][-1], rel=1e-6)
    assert course.restitution == andrews.restitution(V, spheres) == pytest.approx(restitution, rel=1e-6)
    parting, later = course.time_of_parting, 1.3 * course.time_of_parting
    assert parting == pytest.approx(back[0][-1], rel=1e-5)
    assert course.velocity(later) == pytest.approx(-restitution * V, rel=1e-6)
    assert course.compression(later) == pytest.approx(back[1][-1] - restitution * V * (later - parting), rel=1e-4)
    assert course.compression(-1e-8) == pytest.approx(-V * 1e-8) and course.velocity(-1e-8) == pytest.approx(V)
    for function in (andrews.largest_compression, andrews.time_of_largest_compression, andrews.restitution):
        assert function(np.array([V, 2 * V]), spheres)[0] == pytest.approx(float(function(V, spheres)))


def test_limits_are_reached_and_motion_without_elasticity_is_that_of_a_large_modulus():
    """E* = 1e3 sigma: the same d and v until the largest compression to 1e-4, which is of the order of delta_crit; then rest."""
    elastic, rigid = Spheres(4e-6, 400.0, np.inf, 14.6e6), Spheres(4e-6, 400.0, 1.67e6, np.inf)
    whole, plastic = andrews.elastic_compression(V, elastic), andrews.plastic_compression(V, rigid)
    eq_33 = 2 * np.pi / 3**0.5 * (400 / 1.67e6) ** 0.5 * 4e-6
    limits = (elastic, whole, 1.4716 * whole / V, 1.0), (rigid, plastic, eq_33, 0.0)
    for spheres, largest, time, restitution in limits:
        assert andrews.largest_compression(V, spheres) == pytest.approx(largest)
        assert andrews.time_of_largest_compression(V, spheres) == pytest.approx(time, rel=1e-4)
        assert andrews.restitution(V, spheres) == restitution
    near = Spheres(4e-6, 400.0, 1.67e6, 1e12)
    assert andrews.largest_compression(V, near) == pytest.approx(andrews.largest_compression(V, rigid), rel=1e-6)
    rigid, stiff = Spheres(4e-6, 400.0, 2e6, np.inf), Spheres(4e-6, 400.0, 2e6, 2e9)
    limit, near = rigid_motion(3.0, rigid), motion(3.0, stiff)
    assert (limit.largest, limit.time_of_largest) == pytest.approx((near.largest, near.time_of_largest), rel=1e-4)
    time = np.linspace(-0.5, 1.0, 40) * limit.time_of_largest
    assert limit.compression(time) == pytest.approx(near.compression(time), abs=1e-3 * near.largest)
    assert limit.velocity(time) == pytest.approx(near.velocity(time), abs=3e-3)
    assert limit.velocity(2 * limit.time_of_largest) == 0.0 and limit.restitution == 0.0
    assert limit.compression(2 * limit.time_of_largest) == limit.largest


def test_numbers_of_the_paper():
    """Its best fits give its delta_max/R* (eqs 19, 21), and section 4.3.2 the ends of Fig. 10."""
    assert andrews.largest_compression(V, PAPER) / PAPER.reduced_radius == pytest.approx(0.113, abs=5e-4)
    loose = Spheres(1.0, 300.0, 0.428e6, 4.96e6)
    assert andrews.largest_compression(V, loose) == pytest.approx(0.199, abs=5e-4)
    sigma, compliance = degenerate_curve(0.113, 400.0)
    assert 1.0 / compliance[-1] == pytest.approx(14.6e6, abs=0.05e6) and compliance[0] == 0.0
    assert sigma[[0, -1]] == pytest.approx([1.67e6, 3.13e6], abs=0.005e6)
    with np.errstate(divide="ignore"):
        on_curve = andrews.largest_compression(V, Spheres(1.0, 400.0, sigma, 1.0 / compliance))
    assert on_curve == pytest.approx(np.full(sigma.size, 0.113), rel=1e-9)
