"""The theory against the papers' numbers, and against slower ways to the same values."""

from dataclasses import replace
from fractions import Fraction
from math import inf, pi

import numpy as np
import pytest
from scipy.integrate import quad, solve_ivp

from analysis import theory
from analysis.studies.elastoplastic import PRINTED
from analysis.theory import aggregates
from analysis.theory.aggregates import *
from analysis.theory.bonds import stretching_period
from analysis.theory.jkr import PULL_OFF_OVERLAP

PAIR = theory.pair_constants(theory.ICE, 1e-7)
SILICATE_PAIR = theory.pair_constants(theory.SILICATE, 0.6e-6)
# Sliding is the product of A22 eq 21; printed is pi times it.
ENERGIES = """unit 4.0e-17; break 6.1e-17; roll_critical 1.2e-18; roll 4.7e-16; slide_critical 7.3e-18; twist_critical
2.8e-18; twist 4.4e-16; slide 5.4e-15"""


def viscous(picoseconds, radius=1e-7):
    return theory.pair_constants(replace(theory.ICE, viscoelastic_time=picoseconds * 1e-12), radius)


def test_energies_of_a22_table_2_and_k13():
    found = theory.interaction_energies(PAIR)
    for name, printed in map(str.split, ENERGIES.split(";")):
        assert f"{found[name]:.1e}" == printed, name
    assert f"{found['roll']:.2e}" == "4.74e-16" and f"{SILICATE_PAIR.time_unit:.2e}" == "1.71e-09"
    assert f"{theory.interaction_energies(SILICATE_PAIR)['roll']:.2e}" == "1.42e-15"


def test_unlike_pair_follows_the_rules():
    one, other = replace(theory.ICE, viscoelastic_time=1e-12), replace(theory.SILICATE, viscoelastic_time=5e-12)
    pair = theory.pair_constants(one, 1e-7, other, 3e-7)
    assert pair.reduced_radius == pytest.approx(0.75e-7)
    young = 1 / ((1 - 0.25**2) / 7e9 + (1 - 0.17**2) / 54e9)
    assert pair.reduced_young == pytest.approx(young)
    assert pair.pull_off_force == pytest.approx(3 * pi * (0.1 * 0.02) ** 0.5 * 0.75e-7)
    assert pair.critical_rolling == pytest.approx(1.4e-9)
    assert pair.drag_per_contact_radius == pytest.approx(young * (1e-12 / 0.25**2 + 5e-12 / 0.17**2))
    shear = [7e9 / 2.5, 54e9 / 2.34]
    assert pair.reduced_shear == pytest.approx(1 / (1.75 / shear[0] + 1.83 / shear[1]))
    # k_s zeta_crit = 8 a0 G* (G'/G*) a0/(16 pi)
    twisting = 1 / (1 / shear[0] + 1 / shear[1])
    assert pair.sliding_stiffness * pair.critical_sliding == pytest.approx(
        twisting * pair.equilibrium_contact_radius**2 / (2 * pi)
    )


def test_linear_damping_of_k13_equation_4_and_strong_drag():
    pair = theory.pair_constants(theory.ICE, 1e-7, linear_damping=0.01)
    grain_mass = 4 / 3 * pi * 1000 * 1e-7**3
    assert pair.linear_drag == pytest.approx(0.01 * grain_mass / 1.9365e-10, rel=1e-4)
    assert theory.sticking_velocity(pair) > theory.sticking_velocity_without_drag(pair)
    pair, overdamped = viscous(6), viscous(20)
    assert theory.sticking_velocity(pair) / theory.sticking_velocity_without_drag(pair) == pytest.approx(10, rel=0.15)
    assert theory.sticking_velocity(overdamped) == inf and theory.collide_pair(300.0, overdamped).sticks


def test_constants_of_ice_and_of_exchanged_grains():
    there = theory.pair_constants(theory.ICE, 1e-7, theory.SILICATE, 3e-7, 0.01)
    back = theory.pair_constants(theory.SILICATE, 3e-7, theory.ICE, 1e-7, 0.01)
    assert vars(there) == pytest.approx(vars(back), rel=1e-14)
    assert vars(PAIR) == vars(theory.pair_constants(theory.ICE, 1e-7, theory.ICE, 1e-7))
    ice = dict(equilibrium_contact_radius=12.3712e-9, equilibrium_overlap=1.02031e-9, pull_off_force=47.1239e-9)
    ice |= dict(sliding_stiffness=79.176, rolling_stiffness=3.7699, twisting_stiffness=1.41372e-14)
    ice |= dict(critical_sliding=0.43071e-9, critical_rolling=0.8e-9, critical_twisting=1 / (16 * pi))
    assert {name: getattr(PAIR, name) for name in ice} == pytest.approx(ice, rel=1.5e-5)
    assert PAIR.time_unit == pytest.approx(1.936e-10, rel=3e-4)


def test_contact_radius_to_the_last_digits():
    """In exact fractions 3 u^4 - 2 u passes the overlap within 1e-15 of the root."""
    for above_pull_off in (2e-16, 5e-16, 1e-13, 1e-9, 1e-5, 1e-2, 0.3, 0.8254818, 1.0, 1.8254818, 5.0, 300.0):
        overlap = -PULL_OFF_OVERLAP + above_pull_off
        u = theory.contact_radius_root(overlap)
        below, above = (3 * side**4 - 2 * side for side in (Fraction(u * (1 - 1e-15)), Fraction(u * (1 + 1e-15))))
        assert below < Fraction(overlap) < above, above_pull_off


def test_force_and_energy_at_the_papers_points():
    delta_c, delta0 = PAIR.pull_off_overlap, PAIR.equilibrium_overlap
    unit = PAIR.pull_off_force * delta_c
    assert theory.normal_force(-delta_c, PAIR) == pytest.approx(-5 / 9 * PAIR.pull_off_force, rel=1e-7)
    # The strongest pull, F_c, is at u^3 = 1/2, before the pull-off.
    assert theory.normal_force((3 * 2 ** (-4 / 3) - 2 ** (2 / 3)) * delta0, PAIR) == pytest.approx(-PAIR.pull_off_force)
    assert theory.normal_force(np.linspace(-1, 1, 10001) * delta_c, PAIR).min() >= -PAIR.pull_off_force * (1 + 1e-15)
    assert abs(theory.normal_force(delta0, PAIR)) < 1e-14 * PAIR.pull_off_force
    assert theory.normal_force(0.0, PAIR) == pytest.approx(-8 / 9 * PAIR.pull_off_force, rel=1e-14)
    assert theory.normal_energy(0.0, PAIR) == pytest.approx(-8 / 15 * 2 ** (2 / 3) * unit, rel=1e-14)  # A22 eq 9
    assert theory.normal_energy(-delta_c, PAIR) == pytest.approx(4 / 45 * unit, rel=1e-7)  # A22 eq 10
    assert theory.normal_energy(delta0, PAIR) == pytest.approx(-0.8 * 6 ** (1 / 3) * unit, rel=1e-14)  # A22 eq 11
    assert theory.contact_radius(delta0, PAIR) == pytest.approx(PAIR.equilibrium_contact_radius, rel=1e-15)


def test_energy_is_the_integral_of_the_force_which_ends_at_the_pull_off():
    for overlap in (-0.8, -0.3, 0.0, 0.9, 4.0):
        work, error = quad(theory.normalised_force, 1.0, overlap, epsabs=1e-13, epsrel=1e-12)
        # F_c delta0 against F_c delta_c
        rise = (theory.normalised_energy(overlap) - theory.normalised_energy(1.0)) * PULL_OFF_OVERLAP
        assert rise == pytest.approx(work, abs=1e-11 + error), overlap
    for function in (theory.normal_force, theory.normal_energy, theory.contact_radius):
        assert function(-1.0001 * PAIR.pull_off_overlap, PAIR) == 0


def test_sticking_and_elastic_rebound_of_ice_grains():
    assert theory.sticking_velocity_without_drag(PAIR) == pytest.approx(5.95, abs=0.005)
    assert theory.sticking_velocity(PAIR) == pytest.approx(theory.sticking_velocity_without_drag(PAIR), rel=1e-10)
    velocity, threshold = 8.0, theory.sticking_velocity_without_drag(PAIR)
    collision = theory.collide_pair(velocity, PAIR)
    assert collision.rebound_velocity == pytest.approx((velocity**2 - threshold**2) ** 0.5, rel=1e-9)


def as_printed(velocity, time, pair):
    """(velocity of parting or None, duration) of a pair by A22 eqs 4, 7, 30 in SI units and another integrator; time:
    T_vis."""

    def motion(_, state):
        drag = 2 * time * pair.reduced_young / 0.25**2 * theory.contact_radius(state[0], pair) * state[1]
        return state[1], -(theory.normal_force(state[0], pair) + drag) / pair.reduced_mass

    def separation(_, state):
        return state[0] + pair.pull_off_overlap

    separation.terminal, separation.direction = True, -1
    tolerances = {"rtol": 1e-9, "atol": (1e-18, 1e-9)}
    path = solve_ivp(motion, (0.0, 4e-9), (0.0, velocity), "LSODA", events=separation, **tolerances)
    return (-path.y[1, -1], path.t[-1]) if len(path.t_events[0]) else (None, None)


@pytest.mark.parametrize("picoseconds, scale", [(0.5, 1), (6, 1), (3, 2)])
def test_sticking_and_rebound_with_drag_against_the_equation_as_printed(picoseconds, scale):
    """A thousandth less than the threshold a pair sticks, a thousandth more it parts; grains of `scale` times 0.1
    um."""
    time, pair = picoseconds * 1e-12, viscous(picoseconds, scale * 1e-7)
    threshold = theory.sticking_velocity(pair)
    assert threshold > theory.sticking_velocity_without_drag(pair)
    assert as_printed(0.999 * threshold, time, pair)[0] is None
    assert as_printed(1.001 * threshold, time, pair)[0] > 0
    assert theory.collide_pair(threshold * (1 - 1e-7), pair).sticks
    assert not theory.collide_pair(threshold * (1 + 1e-7), pair).sticks
    rebound, duration = as_printed(2 * threshold, time, pair)
    collision = theory.collide_pair(2 * threshold, pair)
    assert (collision.rebound_velocity, collision.duration) == pytest.approx((rebound, duration), rel=1e-6)


# ---- aggregates: K13, T23, A24, S17 ----


R = 1e-7  # of grains [m]
OVERLAP, FORCE, UNIT = PAIR.equilibrium_overlap, PAIR.pull_off_force, PAIR.time_unit
ENERGY = rolling_energy(0.1, R, 0.8e-9)
SCALE = strength_scale(ENERGY, R)
MASS = 4 / 3 * np.pi * theory.ICE.density * R**3


def test_numbers_of_k13():
    """And of section 3.7, silicate: v_d = 4.01 cm/s and c_s = 0.77 cm/s at a filling of 0.01, equal at 0.034."""
    assert SCALE == pytest.approx(4.74e5, rel=1e-3)
    assert bcca_filling(16384) == pytest.approx(3.63e-3, rel=1e-3)
    for filling, speed in ((1e-3, 0.127), (1e-2, 0.059), (1e-1, 0.027)):  # section 3.2
        assert boundary_speed(filling, 3e-7, 16384, 1e-7, UNIT) == pytest.approx(speed, rel=0.02)
    assert sound_speed(1.0, ENERGY, MASS) == pytest.approx(11.0, rel=0.04)  # eq 28
    unit, mass = theory.pair_constants(theory.SILICATE, 0.6e-6).time_unit, 4 / 3 * np.pi * (0.6e-6) ** 3 * 2650
    energy = rolling_energy(0.02, 0.6e-6, 2e-9)
    assert boundary_speed(0.01, 3e-7, 16384, 0.6e-6, unit) == pytest.approx(0.0401, rel=0.01)
    assert sound_speed(0.01, energy, mass) == pytest.approx(0.0077, rel=0.01)
    assert static_from(3e-7, 16384, 0.6e-6, unit, energy, mass) == pytest.approx(0.034, rel=0.02)


def test_strength_of_dense_aggregates_is_k13s_where_they_are_thin_and_t23s_else():
    thin, dense = 1e-4, 0.6
    assert compressive_strength_dense(thin, SCALE) == pytest.approx(compressive_strength(thin, SCALE), rel=1e-3)
    assert compressive_strength_dense(dense, 0.47e6) == pytest.approx(float(aggregates.bcca_strength(dense)), rel=1e-12)


def test_numbers_of_a24():
    coordination = aggregates.cpe_coordination(0.4, R, OVERLAP)
    modulus = aggregates.bulk_modulus(0.4, coordination, R, OVERLAP, FORCE)
    assert modulus == pytest.approx(74.3e6, rel=1e-3)  # eq 41
    assert aggregates.poisson_ratio(PRINTED[0.4][1], modulus) == pytest.approx(0.443, abs=5e-4)  # eq 43
    assert aggregates.bcca_coordination(0.0) == 2.0
    for filling, (stress, *_) in PRINTED.items():  # Fig. 11: above the quasistatic strength
        assert 3 < stress / aggregates.bcca_strength(filling) < 10


def test_poissons_ratio_and_modulus_are_inverse_and_the_densest_lattice_has_twelve_contacts():
    poisson = np.linspace(-0.9, 0.49, 30)
    young = 1.5 * (1 - 2 * poisson) / (1 - poisson**2) * 70e6  # eq 42
    assert aggregates.poisson_ratio(young, 70e6) == pytest.approx(poisson, abs=1e-12)
    densest = aggregates.fcc_filling(R, OVERLAP)
    assert aggregates.fcc_filling(R, 0.0) == pytest.approx(np.pi / 18**0.5) and densest > np.pi / 18**0.5
    assert aggregates.cpe_coordination(densest, R, OVERLAP) == pytest.approx(12.0)


def test_bulk_modulus_is_that_of_springs_on_the_lattice():
    """A uniform strain e of the densest lattice stretches each of its six contacts a grain by the distance times e:
    9/2 K e^2 times the volume of a grain's cell is 6 k (e distance)^2/2."""
    distance = 2 * R - OVERLAP
    stiffness = aggregates.contact_stiffness(FORCE, OVERLAP)
    cell = 4 / 3 * np.pi * R**3 / aggregates.fcc_filling(R, OVERLAP)
    expected = 6 * 0.5 * stiffness * distance**2 / (4.5 * cell)
    found = aggregates.bulk_modulus(aggregates.fcc_filling(R, OVERLAP), 12.0, R, OVERLAP, FORCE)
    assert found == pytest.approx(expected, rel=1e-12)


def test_period_is_that_of_small_vibrations():
    """Against the JKR force's slope at equilibrium, by differences."""
    step = 1e-5 * PAIR.equilibrium_overlap
    below, above = (theory.normal_force(PAIR.equilibrium_overlap + change, PAIR) for change in (-step, step))
    slope = (above - below) / (2 * step)
    assert stretching_period(PAIR) == pytest.approx(2 * np.pi * np.sqrt(PAIR.reduced_mass / slope), rel=1e-6)
    assert 20_000 * stretching_period(PAIR) == pytest.approx(24.4e-6, rel=2e-3)
