"""Andrews's model of two equal elastoplastic spheres that collide head on (A24 eqs 23-33, appendix B).

delta is the compression length, R* = R_eff/2 the reduced radius, rho the density of a sphere, sigma the yield stress,
E* the reduced Young's modulus, delta_c the compression at yield. All integrals of the model are closed, and are used
in that form; they scale as delta ~ R* and time ~ R*/v.

Three things to know:

- eq 18 prints delta_offset = c2 r/(2 - c1/2). Eqs 14, 15, 17 and 19 give c2 r/(2 - c1), and only that gives
  the printed 0.271 r (the printed form gives 0.267 r). studies.elastoplastic uses that.
- eq 29 takes the mass of spheres of radius R_eff = R + delta_offset; what collides is phi rho_p of radius R.
  K_ini differs by (1 + delta_offset/R)^3, 2 % at R = 40 r. Kept as printed, because the paper's fits use it.
- After B21 the stress is cut at sigma_inner only inside a_max, so that a collision that stayed elastic
  (delta_max <= delta_c) has delta_return = 0, not B24's negative value, and B23 becomes B15.
"""

from dataclasses import dataclass

import numpy as np
from scipy.special import hyp2f1


@dataclass(frozen=True)
class Spheres:
    """R* [m], density rho [kg/m^3], yield stress sigma [Pa] and E* [Pa]: floats, or arrays that broadcast. sigma =
    inf is Hertz's elastic sphere, E* = inf the rigid-plastic one."""

    reduced_radius: float
    density: float
    yield_stress: float
    young: float


def critical_compression(spheres):
    """delta_crit [m] at which the centre of the contact yields: eq 24 (B17)."""
    return (np.pi * spheres.yield_stress / (2.0 * spheres.young)) ** 2 * spheres.reduced_radius


def elastic_compression(velocity, spheres):
    """delta_max [m] of spheres that never yield: eq 30."""
    return (5.0 * np.pi * spheres.density / spheres.young) ** 0.4 * velocity**0.8 * spheres.reduced_radius


def plastic_compression(velocity, spheres):
    """delta_max [m] in the rigid-plastic limit E* -> infinity: eq 31."""
    return 4.0 / np.sqrt(3.0) * np.sqrt(spheres.density / spheres.yield_stress) * velocity * spheres.reduced_radius


def elastic_time(velocity, spheres):
    """tau_max [s] of spheres that never yield: eq 32, C_H = 2F1(1/2, 2/5; 7/5; 1) = 1.47."""
    return _HERTZ * elastic_compression(velocity, spheres) / velocity


def young_if_elastic(ratio, velocity, density):
    """E* [Pa] of spheres that never yield, from delta_max/R* at velocity [m/s]: eq 30."""
    return 5.0 * np.pi * density * velocity**2 / ratio**2.5


def stress_if_rigid(ratio, velocity, density):
    """sigma [Pa] in the rigid-plastic limit, from delta_max/R* at velocity [m/s]: eq 31."""
    return 16.0 / 3.0 * density * velocity**2 / ratio**2


def largest_compression(velocity, spheres):
    """delta_max [m] at a collision velocity [m/s]: the root of eq 28, eq 30 where nothing yields."""
    critical = critical_compression(spheres)
    rigid = plastic_compression(velocity, spheres)
    with np.errstate(invalid="ignore"):
        plastic = critical / 3.0 + np.sqrt(np.maximum(rigid**2 - 4.0 / 45.0 * critical**2, 0.0))
    return np.where(_stays_elastic(critical, rigid), elastic_compression(velocity, spheres), plastic)


def time_of_largest_compression(velocity, spheres):
    """tau_max [s] from first contact to the largest compression, at a collision velocity [m/s].

    The elastic phase is an incomplete beta function of the fraction of K_ini that it takes, the plastic phase a
    quarter (or less) of a harmonic oscillation about delta_crit/3."""
    critical = critical_compression(spheres)
    rigid = plastic_compression(velocity, spheres)
    elastic = _stays_elastic(critical, rigid)
    # In what follows the plastic case alone.
    critical, rigid = np.where(elastic, 0.0, critical), np.where(elastic, 1.0, rigid)
    fraction = 8.0 / 15.0 * critical**2 / rigid**2
    until_yield = critical / velocity * hyp2f1(0.5, 0.4, 1.4, np.minimum(fraction, 1.0))
    amplitude = np.sqrt(np.maximum(rigid**2 - 4.0 / 45.0 * critical**2, 0.0))
    angle = np.arccos(np.minimum(2.0 / 3.0 * critical / amplitude, 1.0))
    return np.where(elastic, elastic_time(velocity, spheres), until_yield + angle * rigid / velocity)


def restitution(velocity, spheres):
    """Coefficient of restitution: (work given back/K_ini)^(1/2), 1 where nothing yields. The same for every size (A24
    section 5.3)."""
    critical = critical_compression(spheres)
    rigid = plastic_compression(velocity, spheres)
    elastic = _stays_elastic(critical, rigid)
    critical, rigid = np.where(elastic, 0.0, critical), np.where(elastic, 1.0, rigid)
    apart = largest_compression(velocity, spheres) - critical
    square = 4.0 / 3.0 * (0.4 * critical**2 + apart * critical) / rigid**2
    return np.where(elastic, 1.0, np.sqrt(square))


_HERTZ = float(hyp2f1(0.5, 0.4, 1.4, 1.0))


def _stays_elastic(critical, rigid):
    """Whether K_ini is used up at delta_crit or before: 8/15 (delta_crit/delta_max of eq 31)^2 >= 1."""
    return 8.0 * critical**2 >= 15.0 * rigid**2
