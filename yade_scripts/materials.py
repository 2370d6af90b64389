"""The materials of the papers, in SI units, with their sources."""

from dataclasses import dataclass
from math import pi


@dataclass(frozen=True)
class Material:
    """One row: what a grain is made of, and how large it is in the paper that the row is from."""

    young: float  # Pa
    poisson: float  # 1
    surfaceEnergy: float  # J/m^2
    density: float  # kg/m^3
    criticalRolling: float  # m
    grainRadius: float  # m
    source: str


MATERIALS = {
    "ice": Material(
        young=7e9,
        poisson=0.25,
        surfaceEnergy=0.1,
        density=1000.0,
        criticalRolling=0.8e-9,
        grainRadius=0.1e-6,
        source="Arakawa et al. 2022, Table 1 (and Kataoka et al. 2013, Table 1)",
    ),
    "silicate": Material(
        young=54e9,
        poisson=0.17,
        surfaceEnergy=0.02,
        density=2650.0,
        criticalRolling=2e-9,
        grainRadius=0.6e-6,
        source="Kataoka et al. 2013, Table 1",
    ),
}


def equilibrium_overlap(material, radius=None):
    """Overlap [m] at which the JKR force between two equal grains of this radius [m] vanishes.

    a0^2/(3R) with a0 = (9 pi gamma R^2/E*)^(1/3), R = radius/2, E* = E/[2(1-nu^2)] (A22 eq 1 and text below
    eq 2). For packings made without YADE; a run takes the number from the plugin (a test holds the two
    together).
    """
    radius = material.grainRadius if radius is None else radius
    reduced_radius = radius / 2
    reduced_young = material.young / (2 * (1 - material.poisson**2))
    contact_radius = (9 * pi * material.surfaceEnergy * reduced_radius**2 / reduced_young) ** (1 / 3)
    return contact_radius**2 / (3 * reduced_radius)
