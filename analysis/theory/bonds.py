"""The bond of two equal sintered grains (S17 section 3), S17 = Sirono & Ueno 2017."""

from dataclasses import dataclass
from math import pi

from .pair_constants import Material


@dataclass(frozen=True)
class BondConstants:
    """Constants of a sintered bond, SI. Field by field names of the plugin's bondConstants(), written with underscores."""

    neck_radius: float  # a [m]
    neck_length: float  # d [m], S17 eqs 1, 2
    normal_stiffness: float  # k_ss [N/m], S17 eq 3
    sliding_stiffness: float  # k_st [N/m], S17 eq 4
    breaking_energy: float  # [J], S17 eq 6


def bond_constants(material: Material, radius: float, neck: float) -> BondConstants:
    """BondConstants of two grains of a radius [m] before they sintered; neck: beta, the neck's radius over theirs.

    An elastic disk of radius a and length d; a fillet of radius x = beta^2/(2 (1 - beta)) grain radii bounds it.
    """
    fillet = neck**2 / (2.0 * (1.0 - neck))
    length = 2.0 * radius * fillet / (1.0 + fillet)
    area = pi * (neck * radius) ** 2
    return BondConstants(
        neck_radius=neck * radius,
        neck_length=length,
        normal_stiffness=area * material.young / length,
        sliding_stiffness=area * material.shear / length,
        breaking_energy=area * material.surface_energy,
    )
