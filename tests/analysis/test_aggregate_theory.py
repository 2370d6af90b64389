"""The formulae of K13, T23 and A24 for aggregates, and S17's unit of time, against the papers' own numbers and each
other."""

import numpy as np
import pytest

from analysis.studies.elastoplastic import PRINTED
from analysis.theory import ICE, SILICATE, aggregates, normal_force, pair_constants
from analysis.theory.bonds import stretching_period
from analysis.theory.compression import *

R = 1e-7  # of grains [m]
PAIR = pair_constants(ICE, R)
OVERLAP, FORCE, UNIT = PAIR.equilibrium_overlap, PAIR.pull_off_force, PAIR.time_unit
ENERGY = rolling_energy(0.1, R, 0.8e-9)
SCALE = strength_scale(ENERGY, R)
MASS = 4 / 3 * np.pi * ICE.density * R**3


def test_numbers_of_k13():
    """And of section 3.7, silicate: v_d = 4.01 cm/s and c_s = 0.77 cm/s at a filling of 0.01, equal at 0.034."""
    assert ENERGY == pytest.approx(4.74e-16, rel=1e-3) and SCALE == pytest.approx(4.74e5, rel=1e-3)
    assert rolling_energy(0.02, 0.6e-6, 2e-9) == pytest.approx(1.42e-15, rel=2e-3)
    assert bcca_filling(16384) == pytest.approx(3.63e-3, rel=1e-3)
    for filling, speed in ((1e-3, 0.127), (1e-2, 0.059), (1e-1, 0.027)):  # section 3.2
        assert boundary_speed(filling, 3e-7, 16384, 1e-7, UNIT) == pytest.approx(speed, rel=0.02)
    assert sound_speed(1.0, ENERGY, MASS) == pytest.approx(11.0, rel=0.04)  # eq 28
    unit, mass = pair_constants(SILICATE, 0.6e-6).time_unit, 4 / 3 * np.pi * (0.6e-6) ** 3 * 2650
    energy = rolling_energy(0.02, 0.6e-6, 2e-9)
    assert boundary_speed(0.01, 3e-7, 16384, 0.6e-6, unit) == pytest.approx(0.0401, rel=0.01)
    assert sound_speed(0.01, energy, mass) == pytest.approx(0.0077, rel=0.01)
    assert static_from(3e-7, 16384, 0.6e-6, unit, energy, mass) == pytest.approx(0.034, rel=0.02)


def test_formulae_for_any_filling():
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
    below, above = (normal_force(PAIR.equilibrium_overlap + change, PAIR) for change in (-step, step))
    slope = (above - below) / (2 * step)
    assert stretching_period(PAIR) == pytest.approx(2 * np.pi * np.sqrt(PAIR.reduced_mass / slope), rel=1e-6)
    assert 20_000 * stretching_period(PAIR) == pytest.approx(24.4e-6, rel=2e-3)
