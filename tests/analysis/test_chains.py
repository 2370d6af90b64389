"""S17's chain model: its equations among each other, its limits, and what the text says it gives."""

import numpy as np
import pytest

from analysis.theory import ICE, chains, normal_force, pair_constants

RADIUS = 1e-7
MASS = 4 / 3 * np.pi * ICE.density * RADIUS**3
GRAIN = (RADIUS, ICE.young, MASS, ICE.surface_energy)


def test_eq_16_from_counting_grains_and_contacts():
    """3N - 3 contact points of (3N - 5)/2 grains in a cell (S17 eq 15)."""
    for grains in (4.0, 7.0, 50.0):
        assert chains.contacts_of_chain(grains) == pytest.approx((3 * grains - 3) / ((3 * grains - 5) / 2))
        assert chains.chain_of_contacts(chains.contacts_of_chain(grains)) == pytest.approx(grains)
    assert np.isinf(chains.chain_of_contacts(2.0)) and chains.chain_of_contacts(3.0) == pytest.approx(3.0)


def test_neck_of_the_kernel():
    """k_sr = pi a^4 E/(4 d); d = 2 R x/(R + x), worked out by hand for beta = 1/2: x = R/4, d = 2R/5."""
    assert chains.neck_thickness(0.5, RADIUS) == pytest.approx(0.4 * RADIUS)
    expected = np.pi * (0.5 * RADIUS) ** 4 * ICE.young / (4 * 0.4 * RADIUS)
    assert chains.rolling_stiffness(0.5, RADIUS, ICE.young) == pytest.approx(expected)


def test_force_balances_the_kinetic_energy_and_its_limits():
    """k u^2/2 = N m V^2/4 a chain, F = k u."""
    stiffness = chains.chain_stiffness(12.0, 0.6, RADIUS, ICE.young)
    force = chains.largest_force(7.0, 12.0, 0.6, RADIUS, ICE.young, MASS)
    stretch = force / stiffness
    assert 0.5 * stiffness * stretch**2 == pytest.approx(12.0 * MASS * 7.0**2 / 4)
    assert chains.largest_force(10.0, np.inf, 0.7, RADIUS, ICE.young, MASS) == 0
    assert np.isinf(chains.sticking_ratio(10.0, np.inf, 0.7, *GRAIN))
    with pytest.raises(ValueError, match="must be above 3"):
        chains.chain_stiffness(3.0, 0.7, RADIUS, ICE.young)
    thousand = chains.chain_stiffness(np.array([1e3, 2e3]), 0.7, RADIUS, ICE.young)
    assert thousand[0] / thousand[1] == pytest.approx(8.0, rel=0.01)  # bending: as the length's inverse cube


def test_what_the_text_says_of_fig_17():
    """Almost unity with the loops of 44 grains at 10 m/s; BCCA aggregates (N = 100) would stick there."""
    ratio = lambda velocity, grains, beta: chains.sticking_ratio(velocity, grains, beta, *GRAIN)
    assert 0.5 < ratio(10.0, 22.0, 0.7) < 1.0
    assert ratio(10.0, chains.grains_of_chain(100.0, 1.0), 0.7) > 3
    assert ratio(3.0, 5.4, 0.2) == pytest.approx(1.0, abs=0.02) and ratio(1.0, 6.0, 0.7) > 1
    assert chains.bouncing_velocity(22.0, 0.7, *GRAIN) == pytest.approx(10.0 * ratio(10.0, 22.0, 0.7))


def test_period_is_that_of_small_vibrations():
    """Against the JKR force's slope at equilibrium, by differences."""
    pair = pair_constants(ICE, RADIUS)
    step = 1e-5 * pair.equilibrium_overlap
    below, above = (normal_force(pair.equilibrium_overlap + change, pair) for change in (-step, step))
    slope = (above - below) / (2 * step)
    assert chains.stretching_period(pair) == pytest.approx(2 * np.pi * np.sqrt(pair.reduced_mass / slope), rel=1e-6)
    assert 20_000 * chains.stretching_period(pair) == pytest.approx(24.4e-6, rel=2e-3)
