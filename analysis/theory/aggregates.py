"""Properties of aggregates in closed form: elastic constants and coordination numbers (A24 section 5), strength against
the filling factor. Lengths in m, stresses in Pa.

T19: Tatsuuma, Kataoka & Tanaka 2019 (arXiv 1902.08356). T23: Tatsuuma et al. 2023 (arXiv 2306.09259)."""

from math import pi, sqrt

import numpy as np

DENSEST = 0.74  # phi_max of T23: spheres of one size, closest packed


def fcc_filling(grain_radius, overlap):
    """phi_fcc, the largest filling factor of the lattice whose neighbours overlap by `overlap`: A24 eq 40."""
    return pi / (3.0 * sqrt(2.0)) * (2.0 * grain_radius / (2.0 * grain_radius - overlap)) ** 3


def cpe_coordination(filling, grain_radius, overlap):
    """Z_CPE, the mean number of contacts of a grain inside a CPE aggregate: A24 eq 39."""
    return 12.0 * np.asarray(filling) / fcc_filling(grain_radius, overlap)


def bcca_coordination(filling):
    """Z_BCCA of compressed BCCA aggregates: A24 eq 45."""
    return 2.0 + 9.38 * np.asarray(filling) ** 1.62


def contact_stiffness(pull_off_force, overlap):
    """k_JKR = 6 F_c/(5 delta_0) [N/m] at equilibrium: after A24 eq 38."""
    return 1.2 * pull_off_force / overlap


def bulk_modulus(filling, coordination, grain_radius, overlap, pull_off_force):
    """K_agg [Pa] for a mean coordination number Z: A24 eqs 36-38. With Z = cpe_coordination it is eq 41."""
    shrink = (2.0 * grain_radius - overlap) / (2.0 * grain_radius)
    pressure_per_force = coordination * filling / (4.0 * pi * grain_radius**2) * shrink
    return (2.0 * grain_radius - overlap) / 3.0 * pressure_per_force * contact_stiffness(pull_off_force, overlap)


def poisson_ratio(young, modulus):
    """nu_agg from E* and K_agg [Pa]: the root of A24 eq 42 between -1 and 1/2."""
    e = np.asarray(young) / modulus
    return (3.0 - np.sqrt(9.0 - 6.0 * e + 4.0 * e**2)) / (2.0 * e)


def rolling_energy(surface_energy, grain_radius, critical_rolling):
    """E_roll = 6 pi^2 gamma r0 xi_crit [J], of rolling by 90 degrees: K13 eq 1."""
    return 6.0 * pi**2 * surface_energy * grain_radius * critical_rolling


def strength_scale(energy, grain_radius):
    """P0 = E_roll/r0^3 [Pa]: K13 section 3.1."""
    return energy / grain_radius**3


def compressive_strength(filling, scale):
    """P = P0 phi^3 [Pa] with scale = P0: K13 eq 25, for filling factors below 0.1."""
    return scale * np.asarray(filling, dtype=float) ** 3


def compressive_strength_dense(filling, scale, densest=DENSEST):
    """P = P0 (1/phi - 1/phi_max)^-3 [Pa]: T23, for any filling factor below phi_max; K13's for small ones."""
    return scale * (1.0 / np.asarray(filling, dtype=float) - 1.0 / densest) ** -3.0


def bcca_strength(filling):
    """sigma_BCCA [Pa], quasistatic compressive strength of compressed BCCA aggregates of ice: A24 eq 44."""
    return compressive_strength_dense(filling, 0.47e6)


def tensile_strength(filling, surface_energy, grain_radius):
    """0.6 MPa (gamma/0.1 J/m^2) (r0/0.1 um)^-1 phi^1.8 [Pa], phi before the stretching: T19.

    That paper's text was not at hand; Pamdeas (a program for dust in discs, disruption.cpp) quotes the same from it."""
    scale = 6e5 * (surface_energy / 0.1) / (grain_radius / 1e-7)
    return scale * np.asarray(filling, dtype=float) ** 1.8


def conductivity(filling, contact_radius, grain_radius):
    """k/k_mat = 2 (a_c/r) phi^((1 + alpha)/(3 - D)) of compressed BCCA clusters, D = 1.88 and alpha = 1.34: Arakawa et
    al. (2017, 2019), as others quote them."""
    return 2.0 * contact_radius / grain_radius * np.asarray(filling, dtype=float) ** (2.34 / 1.12)


def bcca_filling(grains):
    """phi_BCCA = (3/5)^(3/2) N^(-1/2) of a cluster of N grains: K13 eq 24."""
    return 0.6**1.5 * np.asarray(grains, dtype=float) ** -0.5


def boundary_speed(filling, strain_rate, grains, grain_radius, time_unit):
    """v_d [m/s], by which two opposite boundaries approach: K13 eq 26."""
    edge = (4.0 / 3.0 * pi * grain_radius**3 * grains / np.asarray(filling, dtype=float)) ** (1.0 / 3.0)
    return 2.0 * strain_rate / time_unit * edge


def sound_speed(filling, energy, grain_mass):
    """c_s,eff = (E_roll/m0)^(1/2) phi [m/s]: K13 eq 27."""
    return (energy / grain_mass) ** 0.5 * np.asarray(filling, dtype=float)


def static_from(strain_rate, grains, grain_radius, time_unit, energy, grain_mass):
    """The filling factor above which boundaries move slower than sound, v_d < c_s,eff: K13 section 3.2."""
    at_one = boundary_speed(1.0, strain_rate, grains, grain_radius, time_unit)
    return (at_one / sound_speed(1.0, energy, grain_mass)) ** 0.75
