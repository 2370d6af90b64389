"""Andrews's model against a numerical integration of its motion, its stresses, its limits and A24's numbers."""

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

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
    """(tau_max, delta_max, time of parting, restitution) from the force alone, by Runge and Kutta's method."""
    mass, scale = andrews.reduced_mass(spheres), spheres.reduced_radius

    def until_largest(t, y):
        return [y[1], -andrews.compression_force(y[0] * scale, spheres) / (mass * scale)]

    stop = lambda t, y: y[1]  # noqa: E731
    stop.terminal, stop.direction = True, -1
    options = {"rtol": 1e-11, "atol": 1e-13 * V / scale, "method": "DOP853"}
    down = solve_ivp(until_largest, (0, 1e-5), [0.0, V / scale], events=stop, max_step=2e-9, **options)
    tau, largest = down.t[-1], down.y[0, -1]

    def until_parting(t, y):
        return [y[1], -andrews.return_force(y[0] * scale, largest * scale, spheres) / (mass * scale)]

    apart = andrews.return_compression(spheres, largest * scale) / scale
    out = lambda t, y: y[0] - apart  # noqa: E731
    out.terminal, out.direction = True, -1
    back = solve_ivp(until_parting, (tau, tau + 1e-5), [largest, 0.0], events=out, max_step=2e-9, **options)
    return tau, largest * scale, back.t[-1], -back.y[1, -1] * scale / V


def test_closed_forms_agree_with_the_integrated_motion(spheres):
    tau, largest, parting, restitution = integrate(spheres)
    assert andrews.largest_compression(V, spheres) == pytest.approx(largest, rel=1e-8)
    assert andrews.time_of_largest_compression(V, spheres) == pytest.approx(tau, rel=1e-6)
    assert andrews.restitution(V, spheres) == pytest.approx(restitution, rel=1e-6)
    assert motion(V, spheres).time_of_parting == pytest.approx(parting, rel=1e-5)
    for function in (andrews.largest_compression, andrews.time_of_largest_compression, andrews.restitution):
        assert function(np.array([V, 2 * V]), spheres)[0] == pytest.approx(float(function(V, spheres)))


def test_motion_obeys_the_force_and_its_phases_join(spheres):
    course = motion(V, spheres)
    assert course.largest == pytest.approx(float(andrews.largest_compression(V, spheres)), rel=1e-12)
    assert course.time_of_largest == pytest.approx(float(andrews.time_of_largest_compression(V, spheres)), rel=1e-9)
    t = np.linspace(-0.2, 1.3, 4001) * course.time_of_parting
    delta, v, step = course.compression(t), course.velocity(t), t[1] - t[0]
    assert np.abs(np.diff(delta)).max() < 1.01 * V * step and np.abs(np.diff(v)).max() < 0.02 * V
    # v is the rate of delta, and m dv/dt the force, by central differences.
    assert np.abs((delta[2:] - delta[:-2]) / (2 * step) - v[1:-1]).max() < 2e-3 * V
    force = andrews.compression_force(delta, spheres)
    force = np.where(t > course.time_of_largest, andrews.return_force(delta, course.largest, spheres), force)
    force = np.where(t > course.time_of_parting, 0.0, force)
    rate = andrews.reduced_mass(spheres) * (v[2:] - v[:-2]) / (2 * step)
    away = np.abs(t[1:-1] - course.time_of_parting) > 10 * step  # there the force falls like a square root
    assert np.abs(rate + force[1:-1])[away].max() < 0.02 * force.max()
    assert v[-1] == pytest.approx(-float(andrews.restitution(V, spheres)) * V, rel=1e-6)
    assert course.compression(-1e-8) == pytest.approx(-V * 1e-8)


def test_force_and_work_are_continuous_and_work_is_the_integral_of_the_force():
    for spheres in (PAPER, CASES["yielding"]):
        critical = andrews.critical_compression(spheres)
        largest = float(andrews.largest_compression(V, spheres))
        for function in (andrews.compression_force, andrews.compression_work):
            below, above = (function(critical * (1 + e), spheres) for e in (-1e-9, 1e-9))
            assert above == pytest.approx(below, rel=1e-8)
        there = lambda d: andrews.compression_force(d, spheres)
        back = lambda d: andrews.return_force(d, largest, spheres)
        assert back(largest) == pytest.approx(float(there(largest)), rel=1e-12)
        precisely = {"epsabs": 0, "epsrel": 1e-11}
        work = quad(there, 0, largest, points=[critical], **precisely)[0]
        assert andrews.compression_work(largest, spheres) == pytest.approx(work, rel=1e-9)
        assert work == pytest.approx(andrews.initial_kinetic_energy(V, spheres), rel=1e-9)  # eq 28
        returned = quad(back, andrews.return_compression(spheres, largest), largest, **precisely)[0]
        assert andrews.returned_work(largest, largest, spheres) == pytest.approx(returned, rel=1e-8)


# ---- the normal stress in the contact, of which the forces are integrals (A24 B13-B22) ----


def elastic_stress(delta, distance, spheres):
    """Hertz's stress [Pa] at a distance [m] from the centre of the contact: B14; 0 outside a = (R* delta)^(1/2)."""
    inside = np.maximum(1.0 - distance**2 / (spheres.reduced_radius * delta), 0.0)
    return 2.0 * spheres.young * np.sqrt(delta) / (np.pi * np.sqrt(spheres.reduced_radius)) * np.sqrt(inside)


def compression_stress(delta, distance, spheres):
    """Stress [Pa] while the compression grows: B16."""
    return np.minimum(elastic_stress(delta, distance, spheres), spheres.yield_stress)


def return_stress(delta, distance, largest, spheres):
    """Stress [Pa] while the spheres part after the largest compression [m]: B21, B22."""
    yielded = plastic_radius(largest, spheres)
    inner = elastic_stress(delta, yielded, spheres)
    elastic = elastic_stress(delta, distance, spheres)
    return np.where(distance < yielded, np.minimum(elastic, inner), elastic)


def plastic_radius(delta, spheres):
    """Radius [m] of the yielded part of the contact: B18, B20; 0 below delta_crit."""
    return np.sqrt(spheres.reduced_radius * andrews.return_compression(spheres, delta))


def contact_force(stress, delta, spheres, nodes=4000):
    """F [N] = integral of 2 pi a' stress(a') over the contact: B13, by the midpoint rule in a'^2."""
    square = (np.arange(nodes) + 0.5) / nodes * spheres.reduced_radius * delta
    return np.pi * spheres.reduced_radius * delta * np.mean(stress(np.sqrt(square)))


def test_forces_are_integrals_of_the_stresses():
    largest, critical = 0.113 * PAPER.reduced_radius, andrews.critical_compression(PAPER)
    assert elastic_stress(critical, 0.0, PAPER) == pytest.approx(PAPER.yield_stress, rel=1e-12)  # B17
    assert compression_stress(largest, plastic_radius(largest, PAPER), PAPER) == pytest.approx(PAPER.yield_stress)
    for delta in (0.5 * critical, critical, largest):
        force = contact_force(lambda a: compression_stress(delta, a, PAPER), delta, PAPER)
        assert force == pytest.approx(float(andrews.compression_force(delta, PAPER)), rel=1e-5)
    apart = andrews.return_compression(PAPER, largest)
    for delta in (largest, 0.5 * (largest + apart)):
        force = contact_force(lambda a: return_stress(delta, a, largest, PAPER), delta, PAPER)
        assert force == pytest.approx(float(andrews.return_force(delta, largest, PAPER)), rel=1e-4)


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
