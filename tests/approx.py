"""pytest.approx without the absolute tolerance of 1e-12 that it adds to every relative one: in SI units energies, masses, times and
torques of grains are smaller than that, and would equal any other."""

import pytest


def without_absolute_tolerance():
    """From now on; what is compared with 0 must give an `abs` of its own."""
    type(pytest.approx(1.0)).DEFAULT_ABSOLUTE_TOLERANCE = 0.0
