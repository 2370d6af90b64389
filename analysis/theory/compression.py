"""Strength of aggregates against their filling factor, in closed form. Stresses in Pa, lengths in m, SI.

K13: Kataoka et al. 2013. T19: Tatsuuma, Kataoka & Tanaka 2019 (arXiv 1902.08356). T23: Tatsuuma et al. 2023 (arXiv
2306.09259). Of compressed BCCA aggregates of ice there is also aggregates.bcca_strength (A24 eq 44)."""

from math import pi

import numpy as np

DENSEST = 0.74  # phi_max of T23: spheres of one size, closest packed


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


def tensile_strength(filling, surface_energy, grain_radius):
    """0.6 MPa (gamma/0.1 J/m^2) (r0/0.1 um)^-1 phi^1.8 [Pa], phi before the stretching: T19.

    That paper's text was not at hand; Pamdeas (a program for dust in discs, disruption.cpp) quotes the same from it."""
    scale = 6e5 * (surface_energy / 0.1) / (grain_radius / 1e-7)
    return scale * np.asarray(filling, dtype=float) ** 1.8


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
