"""What aggregates are said to be like (A24 section 5), against the paper's numbers and other ways to them."""

import numpy as np
import pytest

from analysis.studies.elastoplastic.andrews_fit import PRINTED
from analysis.theory import ICE, aggregates, pair_constants

R = 1e-7
PAIR = pair_constants(ICE, R)
OVERLAP, FORCE = PAIR.equilibrium_overlap, PAIR.pull_off_force


def test_numbers_of_the_paper():
    coordination = aggregates.cpe_coordination(0.4, R, OVERLAP)
    modulus = aggregates.bulk_modulus(0.4, coordination, R, OVERLAP, FORCE)
    assert modulus == pytest.approx(74.3e6, rel=1e-3)  # eq 41
    assert aggregates.poisson_ratio(PRINTED[0.4][1], modulus) == pytest.approx(0.443, abs=5e-4)  # eq 43
    assert aggregates.bcca_coordination(0.0) == 2.0
    for filling, (stress, *_) in PRINTED.items():  # Fig. 11: above the quasistatic strength
        assert 3 < stress / aggregates.bcca_strength(filling) < 10


def test_poissons_ratio_and_modulus_are_inverse_and_the_densest_lattice_has_twelve_contacts():
    poisson = np.linspace(-0.9, 0.49, 30)
    young = aggregates.reduced_young(poisson, 70e6)
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
