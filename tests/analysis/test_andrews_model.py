"""Andrews's model against a numerical integration of its motion, its limits and A24's numbers."""

import numpy as np
import pytest
from made_collisions import integrated

from analysis.theory import andrews
from analysis.theory.andrews import Spheres

V = 10**0.5
PAPER = Spheres(0.5 * 80.271e-7, 400.0, 2.25e6, 15.7e6)
# Mostly plastic, as the paper's, just beyond yield, and elastic throughout.
CASES = {
    "plastic": Spheres(2e-6, 400.0, 1.7e6, 80e6),
    "paper": PAPER,
    "yielding": Spheres(4e-6, 400.0, 3.2e6, 15.7e6),
    "elastic": Spheres(4e-6, 300.0, 9e6, 5e6),
}


@pytest.mark.parametrize("spheres", CASES.values(), ids=CASES)
def test_closed_forms_agree_with_the_integrated_force(spheres):
    there, back = integrated(V, spheres)
    assert andrews.largest_compression(V, spheres) == pytest.approx(there[1][-1], rel=1e-8)
    assert andrews.time_of_largest_compression(V, spheres) == pytest.approx(there[0][-1], rel=1e-6)
    assert andrews.restitution(V, spheres) == pytest.approx(-back[2][-1] / V, rel=1e-6)
    for function in (andrews.largest_compression, andrews.time_of_largest_compression, andrews.restitution):
        assert function(np.array([V, 2 * V]), spheres)[0] == pytest.approx(float(function(V, spheres)))


def test_limits_are_reached():
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


def test_numbers_of_the_paper():
    """Its best fits give its delta_max/R* (eqs 19, 21), and section 4.3.2 the ends of Fig. 10."""
    assert andrews.largest_compression(V, PAPER) / PAPER.reduced_radius == pytest.approx(0.113, abs=5e-4)
    loose = Spheres(1.0, 300.0, 0.428e6, 4.96e6)
    assert andrews.largest_compression(V, loose) == pytest.approx(0.199, abs=5e-4)
    assert andrews.young_if_elastic(0.113, V, 400.0) == pytest.approx(14.6e6, abs=0.05e6)
    assert andrews.stress_if_rigid(0.113, V, 400.0) == pytest.approx(1.67e6, abs=0.005e6)
