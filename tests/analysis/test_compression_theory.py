"""The formulae of K13, T23 and A24 against the papers' own numbers and each other."""

import numpy as np
import pytest

from analysis.theory import ICE, SILICATE, pair_constants
from analysis.theory.aggregates import bcca_strength
from analysis.theory.compression import *

ENERGY = rolling_energy(0.1, 1e-7, 0.8e-9)
SCALE = strength_scale(ENERGY, 1e-7)
UNIT = pair_constants(ICE, 1e-7).time_unit
MASS = 4 / 3 * np.pi * 1e-21 * 1000


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


def test_the_derivation_gives_eq_25():
    """Eqs 30-34, step by step: each quantity follows from the ones before it."""
    filling = np.array([1e-3, 1e-2, 0.1])
    cluster = weakest_cluster(filling, ENERGY, 1e-7)
    assert cluster.pressure == pytest.approx(compressive_strength(filling, SCALE), rel=1e-12)
    assert cluster.grains * (1e-7 / cluster.radius) ** 3 == pytest.approx(filling, rel=1e-12)
    assert cluster.force * cluster.radius == pytest.approx(ENERGY * np.ones(3), rel=1e-12)


def test_formulae_for_any_filling():
    thin, dense = 1e-4, 0.6
    assert compressive_strength_dense(thin, SCALE) == pytest.approx(compressive_strength(thin, SCALE), rel=1e-3)
    assert compressive_strength_dense(dense, 0.47e6) == pytest.approx(float(bcca_strength(dense)), rel=1e-12)
    for densest, formula in ((None, compressive_strength), (0.74, compressive_strength_dense)):
        assert filling_at(formula(0.3, SCALE), SCALE, densest) == pytest.approx(0.3, rel=1e-12)
