"""Properties of aggregates: elastic constants (A24 section 5.1), strength and coordination number of other
preparations (section 5.2). Lengths in m, stresses in Pa."""

from math import pi, sqrt

import numpy as np


def fcc_filling(grain_radius, overlap):
    """phi_fcc, the largest filling factor of the lattice whose neighbours overlap by `overlap`: eq 40."""
    return pi / (3.0 * sqrt(2.0)) * (2.0 * grain_radius / (2.0 * grain_radius - overlap)) ** 3


def cpe_coordination(filling, grain_radius, overlap):
    """Z_CPE, the mean number of contacts of a grain inside a CPE aggregate: eq 39."""
    return 12.0 * np.asarray(filling) / fcc_filling(grain_radius, overlap)


def bcca_coordination(filling):
    """Z_BCCA of compressed BCCA aggregates: eq 45."""
    return 2.0 + 9.38 * np.asarray(filling) ** 1.62


def bcca_strength(filling):
    """sigma_BCCA [Pa], quasistatic compressive strength of compressed BCCA aggregates of ice: eq 44."""
    return 0.47e6 * (1.0 / np.asarray(filling) - 1.0 / 0.74) ** -3.0


def contact_stiffness(pull_off_force, overlap):
    """k_JKR = 6 F_c/(5 delta_0) [N/m] at equilibrium: after eq 38."""
    return 1.2 * pull_off_force / overlap


def bulk_modulus(filling, coordination, grain_radius, overlap, pull_off_force):
    """K_agg [Pa] for a mean coordination number Z: eqs 36-38. With Z = cpe_coordination it is eq 41."""
    shrink = (2.0 * grain_radius - overlap) / (2.0 * grain_radius)
    pressure_per_force = coordination * filling / (4.0 * pi * grain_radius**2) * shrink
    return (2.0 * grain_radius - overlap) / 3.0 * pressure_per_force * contact_stiffness(pull_off_force, overlap)


def poisson_ratio(young, modulus):
    """nu_agg from E* and K_agg [Pa]: the root of eq 42 between -1 and 1/2."""
    e = np.asarray(young) / modulus
    return (3.0 - np.sqrt(9.0 - 6.0 * e + 4.0 * e**2)) / (2.0 * e)
