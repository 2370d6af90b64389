"""The bond of two equal sintered grains (Sirono & Ueno 2017, S17, section 3). neck: beta, its radius over theirs."""

from dataclasses import dataclass
from math import pi, sqrt

from .pair_constants import Material


@dataclass(frozen=True)
class BondConstants:
    """Constants of a sintered bond, SI: field by field those of the plugin's bondConstants(), with underscores."""

    neck_radius: float  # a [m]
    neck_length: float  # d [m], S17 eqs 1, 2
    normal_stiffness: float  # k_ss [N/m], S17 eq 3
    sliding_stiffness: float  # k_st [N/m], S17 eq 4
    breaking_energy: float  # [J], S17 eq 6


def bond_constants(material: Material, radius: float, neck: float) -> BondConstants:
    """BondConstants of two grains of a radius [m] before they sintered: of an elastic disk of radius a and length d."""
    area, length = pi * (neck * radius) ** 2, neck_length(neck, radius)
    return BondConstants(
        neck_radius=neck * radius,
        neck_length=length,
        normal_stiffness=area * material.young / length,
        sliding_stiffness=area * material.shear / length,
        breaking_energy=breaking_energy(neck, radius, material.surface_energy),
    )


def neck_length(neck, radius):
    """d [m] of a neck, bounded by a fillet of radius beta^2/(2 (1 - beta)) grain radii: S17 eqs 1, 2.

    >>> round(neck_length(0.5, 1.0), 6)
    0.4
    """
    fillet = neck**2 / (2.0 * (1.0 - neck))
    return 2.0 * radius * fillet / (1.0 + fillet)


def breaking_energy(neck, radius, surface_energy):
    """E_sint = pi gamma (beta R)^2 [J]: S17 eq 6."""
    return pi * (neck * radius) ** 2 * surface_energy


def stretching_period(pair):
    """Period [s] of two equal grains that vibrate along an unsintered contact, S17's unit of time; pair:
    PairConstants. At equilibrium dF/d(delta) = (6/5) F_c/delta_0 (S17 eqs 8, 9)."""
    return 2.0 * pi * sqrt(pair.reduced_mass * pair.equilibrium_overlap / (1.2 * pair.pull_off_force))
