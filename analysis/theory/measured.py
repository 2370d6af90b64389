"""What the runs of this suite measured of aggregates, each a value with its standard error: for codes of discs, comets
and dust that take a formula without one. How the runs were made: analysis/gallery/formulas and analysis/gallery/atlas.

Strengths and conductivity are of BCCA clusters of 1,024 grains of one size that were compressed to a filling factor of
0.03 to 0.4; beyond, the error of a fit is no bound (at 0.5 the conductivity is a fifth higher). The conductivity of
4,096 grains at 0.03 is 1.28 (error 0.11) times what is said here. Ice: that of theory.ICE."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ..arrays import numbers
from . import aggregates
from .pair_constants import GRAIN_RADIUS, ICE, MATERIALS, breaking_velocity, pair_constants

MIDDLE = 0.23  # filling factor: about the geometric mean of those fitted


class Measured(NamedTuple):
    """A value and its standard error, floats or arrays."""

    value: float
    error: float


def _filling(values):
    return numbers("filling", values, positive=True, most=1.0)


def _by_rolling(strength, table, critical_rolling, grain_radius):
    """A Measured strength times the factor of a table of ROLLING_...; beyond its ends as there."""
    ratios, *columns = table
    ratio = np.log(np.divide(critical_rolling, grain_radius))
    factor, error = (np.interp(ratio, np.log(ratios), column) for column in columns)
    return Measured(strength.value * factor, np.hypot(strength.error * factor, strength.value * error))


def _radius(material, grain_radius):
    """[m]; that of ice or silicate where it is None, ValueError for another material."""
    if grain_radius is None:
        found = [GRAIN_RADIUS[name] for name, own in MATERIALS.items() if own == material]
        if not found:
            raise ValueError("grain_radius: must be given with a material of one's own")
        return found[0]
    return grain_radius


@dataclass(frozen=True)
class PowerLaw:
    """value ~ filling^exponent, level at MIDDLE, with standard errors that are independent there."""

    level: float
    level_error: float
    exponent: float
    exponent_error: float

    def times(self, scale, filling):
        """Measured: scale (float or array) times the law."""
        ratio = _filling(filling) / MIDDLE
        value = scale * self.level * ratio**self.exponent
        return Measured(value, value * np.hypot(self.level_error / self.level, np.log(ratio) * self.exponent_error))


# Of ice grains of 0.1 um: the page's fits to 0.1 to 0.4.
TENSILE = PowerLaw(4.366e4, 9.85e2, 2.101, 0.0665)  # Pa
COMPRESSIVE = (  # filling, over T23's formula, error: no power law
    (0.03, 0.1, 0.2, 0.3, 0.4),
    (0.7050, 0.6437, 0.6432, 0.8297, 1.171),
    (0.0685, 0.0427, 0.0315, 0.0456, 0.0367),
)
CONDUCTIVITY = PowerLaw(0.01291, 0.000168, 2.316, 0.035)  # k/k_mat
# What critical rolling over radius does to strengths, beside ice of 0.1 um, of clusters of a filling factor of 0.2:
# ratio, factor, error.
ROLLING_TENSILE = tuple(
    zip((8e-4, 0.868, 0.034), (2e-3, 0.888, 0.044), (8e-3, 1.0, 0.0), (0.016, 1.120, 0.039), (0.032, 1.229, 0.037))
)
ROLLING_COMPRESSIVE = tuple(
    zip((8e-4, 1.412, 0.168), (2e-3, 1.290, 0.055), (8e-3, 1.0, 0.0), (0.016, 0.779, 0.039), (0.032, 0.581, 0.032))
)
# Velocity above which targets lose more than they gain, over v_break and averaged over impact parameters: value, error.
FRAGMENTATION = {"bpca": (11.18, 0.383), "bcca": (7.00, 0.294), "compressed": (15.08, 0.551), "cpe": (17.73, 0.974)}
# Velocity at which half of collisions have stuck when they end; docs/formulas.md says what the errors leave out.
STICKING = {"bpca": (6.88, 0.241), "bcca": (6.35, 0.135), "compressed": (8.82, 0.345), "cpe": (8.30, 0.592)}
RADIUS = GRAIN_RADIUS["ice"]


def tensile_strength(
    filling, surface_energy=ICE.surface_energy, grain_radius=RADIUS, critical_rolling=ICE.critical_rolling
):
    """Largest tension [Pa] of an aggregate that is stretched, by its filling factor before; over a tenth of the strain
    up to it.

    Parameters
    ----------
    filling : float or array
    surface_energy : float [J/m^2]
    grain_radius : float [m]
    critical_rolling : float [m]
        The strength goes as surface_energy/grain_radius (Tatsuuma et al. 2019), times a factor of
        critical_rolling/grain_radius that was measured at a filling factor of 0.2 (ROLLING_TENSILE).

    Returns
    -------
    Measured
    """
    strength = TENSILE.times(surface_energy / ICE.surface_energy * RADIUS / grain_radius, filling)
    return _by_rolling(strength, ROLLING_TENSILE, critical_rolling, grain_radius)


def compressive_strength(filling, material=ICE, grain_radius=None):
    """Pressure [Pa] of a quasistatic compression at a filling factor: that of Tatsuuma et al. (2023), corrected by a
    factor between those measured, NaN beyond them, and by that of ROLLING_COMPRESSIVE.

    Parameters
    ----------
    filling : float or array
    material : theory.Material
        Of which the rolling energy is taken.
    grain_radius : float [m], optional
        By default that of the material in theory.GRAIN_RADIUS.

    Returns
    -------
    Measured
    """
    grain_radius = _radius(material, grain_radius)
    energy = aggregates.rolling_energy(material.surface_energy, grain_radius, material.critical_rolling)
    scale = aggregates.strength_scale(energy, grain_radius)
    filling, (fillings, *factors) = _filling(filling), COMPRESSIVE
    formula = aggregates.compressive_strength_dense(filling, scale)
    strength = Measured(*(formula * np.interp(filling, fillings, own, np.nan, np.nan) for own in factors))
    return _by_rolling(strength, ROLLING_COMPRESSIVE, material.critical_rolling, grain_radius)


def conductivity(filling, material=ICE, grain_radius=None):
    """Thermal conductivity through contacts over that of the grains' material, k/k_mat.

    Parameters
    ----------
    filling : float or array
    material : theory.Material
    grain_radius : float [m], optional
        By default that of the material in theory.GRAIN_RADIUS. The conductivity goes as the radius of a contact at rest
        over that of a grain.

    Returns
    -------
    Measured
    """
    neck = lambda *grains: pair_constants(*grains).equilibrium_contact_radius / grains[1]
    return CONDUCTIVITY.times(neck(material, _radius(material, grain_radius)) / neck(ICE, RADIUS), filling)


def fragmentation_velocity(structure="bpca", material=ICE, grain_radius=None):
    """Velocity [m/s] above which targets lose more mass than they gain, over all impact parameters, of pairs of 64 to
    4,096 grains; bpca: with mass ratios of 1/4 to 1, others with all.

    Parameters
    ----------
    structure : str
        Of FRAGMENTATION; ValueError for another.
    material : theory.Material
    grain_radius : float [m], optional
        By default that of the material in theory.GRAIN_RADIUS.

    Returns
    -------
    Measured
    """
    return _velocity(FRAGMENTATION, structure, material, grain_radius)


def sticking_velocity(structure="bpca", material=ICE, grain_radius=None):
    """Velocity [m/s] at which half of collisions stick, over all impact parameters, of the same pairs; arguments and
    what is returned as of fragmentation_velocity(). Slower close-packed aggregates (cpe) bounce now and then.
    The error leaves out undecided runs and the fitted range (docs/formulas.md). theory.sticking_velocity() is of two
    grains."""
    return _velocity(STICKING, structure, material, grain_radius)


def _velocity(table, structure, material, grain_radius):
    if structure not in table:
        raise ValueError(f"structure = {structure!r}: must be one of {', '.join(table)}")
    scale = breaking_velocity(material, _radius(material, grain_radius))
    return Measured(*(scale * number for number in table[structure]))
