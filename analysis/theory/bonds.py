"""The bond of two sintered grains (Sirono & Ueno 2017, S17, section 3). neck: beta, its radius over theirs, R_g.

Of unlike grains R_g = 2 r1 r2/(r1 + r2), and half of the elastic disk is of either material."""

from dataclasses import dataclass
from math import asin, pi, sqrt

from .pair_constants import Material, mixed_surface_energy


@dataclass(frozen=True)
class BondConstants:
    """Constants of a sintered bond, SI: field by field those of the plugin's bondConstants(), with underscores."""

    neck_radius: float  # a [m]
    neck_length: float  # d [m], S17 eqs 1, 2
    normal_stiffness: float  # k_ss [N/m], S17 eq 3
    sliding_stiffness: float  # k_st [N/m], S17 eq 4
    rolling_stiffness: float  # k_sr/R^2 [N/m] on xi, S17 eq 5; R = r1 r2/(r1 + r2)
    twisting_stiffness: float  # k_sw [N m], of the disk's polar moment
    breaking_energy: float  # [J], S17 eq 6


def bond_constants(
    material: Material,
    radius: float,
    neck: float,
    material2: Material | None = None,
    radius2: float | None = None,
    mixed_factor: float = 1.0,
) -> BondConstants:
    """BondConstants of two grains of radii [m] before they sintered; the second equals the first if left out.

    mixed_factor: gamma of unlike materials over the geometric mean of theirs."""
    both = (material, material2 or material)
    reduced = 1.0 / (1.0 / radius + 1.0 / (radius2 or radius))
    young, shear = (2.0 / sum(1.0 / getattr(m, name) for m in both) for name in ("young", "shear"))
    a, length = neck * 2.0 * reduced, neck_length(neck, 2.0 * reduced)
    area, surface_energy = pi * a**2, mixed_surface_energy(*both, mixed_factor)
    return BondConstants(
        neck_radius=a,
        neck_length=length,
        normal_stiffness=area * young / length,
        sliding_stiffness=area * shear / length,
        rolling_stiffness=area * a**2 * young / (4.0 * length * reduced**2),
        twisting_stiffness=area * a**2 * shear / (2.0 * length),
        breaking_energy=breaking_energy(neck, 2.0 * reduced, surface_energy),
    )


def neck_length(neck, radius):
    """d [m] of a neck, bounded by a fillet of radius beta^2/(2 (1 - beta)) grain radii: S17 eqs 1, 2."""
    fillet = neck**2 / (2.0 * (1.0 - neck))
    return 2.0 * radius * fillet / (1.0 + fillet)


def breaking_energy(neck, radius, surface_energy):
    """E_sint = pi gamma (beta R)^2 [J]: S17 eq 6."""
    return pi * (neck * radius) ** 2 * surface_energy


def stretching_period(pair):
    """Period [s] of two equal grains that vibrate along an unsintered contact, S17's unit of time; pair:
    PairConstants. At equilibrium dF/d(delta) = (6/5) F_c/delta_0 (S17 eqs 8, 9)."""
    return 2.0 * pi * sqrt(pair.reduced_mass * pair.equilibrium_overlap / (1.2 * pair.pull_off_force))


def shrunk_radius(neck):
    """R'/R_g of a grain that has given two necks their volume, that between fillet and spheres (S17 3.3, Fig. 4)."""
    if neck == 0:
        return 1.0
    x, half = neck**2 / (2.0 * (1.0 - neck)), neck_length(neck, 1.0) / 2.0
    c = neck + x  # the fillet is a circle of radius x about the distance c from the axis
    sector = half * sqrt(x**2 - half**2) + x**2 * asin(half / x)
    fillet = 2.0 * pi * (half * c**2 - c * sector + x**2 * half - half**3 / 3.0)
    spheres = 2.0 * pi * half**2 * (1.0 - half / 3.0)
    return (1.0 - 2.0 * (fillet - spheres) / (4.0 / 3.0 * pi)) ** (1.0 / 3.0)
