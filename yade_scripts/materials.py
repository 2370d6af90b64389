"""The materials of the papers, and the grains of a run: SI units, with sources."""

from dataclasses import asdict, dataclass
from functools import lru_cache

from analysis import theory
from analysis.theory.pair_constants import GRAIN_RADII
from yade_scripts.parameters import (
    NOT_NEGATIVE,
    POSITIVE,
    SWITCH,
    ParameterError,
    Parameters,
    Usual,
    between,
    one_of,
    parameter,
)


@dataclass(frozen=True)
class Material:
    """What a grain is made of, and how large it is in the paper that the row is from."""

    grainRadius: float  # m
    young: float  # Pa
    poisson: float  # 1
    density: float  # kg/m^3
    surfaceEnergy: float  # J/m^2
    criticalRolling: float  # m


# of the papers, which analysis.theory names
MATERIALS = {
    name: Material(theory.GRAIN_RADIUS[name], of.young, of.poisson, of.density, of.surface_energy, of.critical_rolling)
    for name, of in theory.MATERIALS.items()
}
VALUES = "; ".join(
    f"{name}: " + ", ".join(f"{key} {value:g}" for key, value in asdict(of).items()) for name, of in MATERIALS.items()
)
_pair_constants, _bond_constants = lru_cache(theory.pair_constants), lru_cache(theory.bond_constants)

GRAINS = Usual(*GRAIN_RADII, "smallest soot monomers to chondrules")
YOUNG = Usual(1e6, 1.3e12, "rubber to diamond")
DENSITY = Usual(100, 23_000, "aerogel to osmium")
SURFACE = Usual(1e-3, 10, "liquid gases to clean metals")
ROLLING = Usual(1e-11, 1e-7, "0.2 to 3.2 nm: Dominik & Tielens 1997, Heim et al. 1999")
DRAG = Usual(1e-15, 1e-6, "1 to 6 ps: A22")


@dataclass(frozen=True)
class GrainParameters(Parameters):
    """The grains. Each property is that of `material` unless it is given."""

    material: str = parameter(
        "ice", one_of(list(MATERIALS)), f"whose properties the grains have, each unless it is given below ({VALUES})"
    )
    grainRadius: float | None = parameter(None, POSITIVE, "radius of a grain", "m", usual=GRAINS)
    young: float | None = parameter(None, POSITIVE, "Young's modulus", "Pa", usual=YOUNG)
    poisson: float | None = parameter(None, between(0, 0.5), "Poisson's ratio", "1")
    density: float | None = parameter(None, POSITIVE, "density", "kg/m^3", usual=DENSITY)
    surfaceEnergy: float | None = parameter(None, POSITIVE, "surface energy gamma", "J/m^2", usual=SURFACE)
    criticalRolling: float | None = parameter(None, POSITIVE, "critical displacement of rolling", "m", usual=ROLLING)
    viscoelasticTime: float = parameter(0.0, NOT_NEGATIVE, "T_vis of drag (A22 eq 7); 0: no drag", "s", usual=DRAG)
    unusual: int = parameter(0, SWITCH, "1: values outside of their usual ranges are meant", of_consequence=False)

    def filled_in(self):
        """The material's properties where none are given."""
        of_material = asdict(MATERIALS[self.material])
        grains = self.changed(**{name: value for name, value in of_material.items() if getattr(self, name) is None})
        if grains.viscoelasticTime and not grains.poisson:
            raise ParameterError("poisson = 0: with viscous drag must be > 0 (A22 eq 7 divides by its square)")
        return super(GrainParameters, grains).filled_in()


def pair_constants(grains, radii=None, neck=0.0, linearDamping=0.0):
    """Constants of a contact of two grains, where no YADE runs. A run takes them from the plugin; a test compares.

    grains: with the attributes of Material, perhaps viscoelasticTime [s] and slidingStiffnessFactor; radii: of the two
    [m], both grainRadius if left out; neck: beta of sintered grains; linearDamping: k_n. Returns {name: value} by the
    plugin's names, SI; with a neck those of a bond, of two grains of grainRadius, as "bond".
    """
    names = ("young", "poisson", "density", "surfaceEnergy", "criticalRolling")
    properties = [float(getattr(grains, name)) for name in names]
    material = theory.Material(*properties, getattr(grains, "viscoelasticTime", 0.0))
    first, second = radii or (grains.grainRadius, grains.grainRadius)
    sliding = getattr(grains, "slidingStiffnessFactor", 1.0)
    found = _by_plugins_names(_pair_constants(material, first, material, second, linearDamping, sliding))
    if neck:
        found["bond"] = _by_plugins_names(_bond_constants(material, grains.grainRadius, neck))
    return found


def _by_plugins_names(constants):
    """{equilibriumOverlap: value} of an object with equilibrium_overlap."""
    camel_case = lambda name: name[0] + name.title().replace("_", "")[1:]
    return {camel_case(name): value for name, value in vars(constants).items()}


def equilibrium_overlap(grains):
    """Overlap [m] at which the JKR force between two of these grains vanishes (A22 after eq 2)."""
    return pair_constants(grains)["equilibriumOverlap"]


def require_small_contacts(constants):
    """Raise ParameterError when adhesion presses grains together so much that the JKR theory means nothing."""
    radius, contact = 2 * constants["reducedRadius"], constants["equilibriumContactRadius"]
    if contact >= 0.5 * radius:
        given = f"grainRadius = {radius:g}: contacts at rest have a radius of {contact / radius:.2g} grain radii"
        raise ParameterError(f"{given}; must be less than 0.5, with larger or stiffer grains or less surfaceEnergy")
