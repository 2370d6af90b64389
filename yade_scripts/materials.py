"""The materials of the papers and of one's own, and the grains of a run: SI units, with sources."""

from dataclasses import asdict, dataclass
from functools import lru_cache
from math import pi

import numpy as np

from analysis import theory
from analysis.printable import suggested
from analysis.runs.status import changed
from analysis.theory.pair_constants import GRAIN_RADII
from yade_scripts.parameters import (
    NOT_NEGATIVE,
    POSITIVE,
    SWITCH,
    Check,
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
ADHESIVE = Check(  # as JKRMat
    "> 0 (all limits of this law follow from adhesion; "
    "of grains without, YADE's Law2_ScGeom_MindlinPhys_Mindlin is the law)",
    lambda x: x > 0,
)
MIXED, CORE, HALVES, PAIR = LAYOUTS = ("mixed", "core-mantle", "halves", "target-projectile")
MIXED_FACTOR = "mixedSurfaceEnergyFactor"
# What a run gives all its pairs, in the order of theory.pair_constants(), and what is usual.
OF_PAIRS = {"slidingStiffnessFactor": 1.0, "rollingStiffnessFactor": 1.0, "springDamping": 0.0, MIXED_FACTOR: 1.0}
# What run.json has of a material, a contact and a bond, under `derived`.
OF_MATERIAL = ("young", "poisson", "surfaceEnergy", "density", "criticalRolling", "viscoelasticTime")
OF_CONTACT = ("equilibriumContactRadius", "equilibriumOverlap", "pullOffOverlap", "pullOffForce", "timeUnit")
OF_BOND = (
    *("shrunkRadius", "neckRadius", "neckLength", "normalStiffness", "slidingStiffness"),
    *("rollingStiffness", "twistingStiffness", "breakingEnergy"),
)
PROPERTIES = ("young", "poisson", "density", "surfaceEnergy", "criticalRolling")


@dataclass(frozen=True)
class GrainParameters(Parameters):
    """The grains. Each property is that of `material` unless it is given."""

    material: str = parameter(
        "ice",
        Check(
            "a material, or two unlike ones with a comma between",
            lambda text: len(_names(text)) == len({*_names(text)}) <= 2,
        ),
        f"whose properties the grains have, each unless it is given below ({VALUES}); ice,silicate: of either",
    )
    materials: str | None = parameter(
        None,
        Check("a file with a section [NAME] a material", lambda text: text != ""),
        f"file (TOML) of materials of one's own, each with {', '.join(PROPERTIES)}, perhaps grainRadius",
    )
    materialFraction: float | None = parameter(
        None, between(0, 1), "of the grains, those of the second material; left out where a file has them", "1"
    )
    layout: str | None = parameter(
        None,
        one_of(LAYOUTS),
        f"of two materials: {MIXED} at random (if left out), the second one outside, at the larger x, or the whole "
        "projectile of it",
    )
    mixedSurfaceEnergyFactor: float = parameter(
        1.0, POSITIVE, "surface energy of a contact of two unlike materials over the geometric mean of theirs", "1"
    )
    grainRadius: float | None = parameter(None, POSITIVE, "radius of a grain", "m", usual=GRAINS)
    young: float | None = parameter(None, POSITIVE, "Young's modulus", "Pa", usual=YOUNG)
    poisson: float | None = parameter(None, between(0, 0.5), "Poisson's ratio", "1")
    density: float | None = parameter(None, POSITIVE, "density", "kg/m^3", usual=DENSITY)
    surfaceEnergy: float | None = parameter(None, ADHESIVE, "surface energy gamma", "J/m^2", usual=SURFACE)
    criticalRolling: float | None = parameter(None, POSITIVE, "critical displacement of rolling", "m", usual=ROLLING)
    viscoelasticTime: float = parameter(0.0, NOT_NEGATIVE, "T_vis of drag (A22 eq 7); 0: no drag", "s", usual=DRAG)
    unusual: int = parameter(0, SWITCH, "1: values outside of their usual ranges are meant", of_consequence=False)

    def filled_in(self):
        """The material's properties where none are given; of two, those of the first one."""
        known = known_materials(self.materials)
        for name in self.material_names:
            if name not in known:
                raise ParameterError(f"material = {name}: no such material{suggested(name, known)}")
        of_first = asdict(known[self.material_names[0]])
        if len(self.material_names) == 1:
            self._require_left_out("with one material", ("materialFraction", "layout"))
            if (factor := self.mixedSurfaceEnergyFactor) != 1:
                raise ParameterError(
                    f"mixedSurfaceEnergyFactor = {factor:g}: given with one material; must be left out"
                )
            found = self
        else:
            self._require_left_out("with two materials, whose own it is", PROPERTIES)
            by_file = getattr(self, "packing", None) == "file" and self.materialFraction is None
            found = self if by_file else self.changed(layout=self.layout or MIXED)  # a file may have either of its own
            if found.layout == PAIR:
                self._require_left_out(f"with layout = {PAIR}", ("materialFraction",))
            elif found.materialFraction is None and not by_file:
                raise ParameterError("materialFraction: not given with two materials; must be 0 to 1")
        grains = found.changed(**{name: value for name, value in of_first.items() if getattr(found, name) is None})
        if grains.grainRadius is None:
            raise ParameterError(f"grainRadius: neither given nor in {self.materials}; must be > 0 [m]")
        if grains.viscoelasticTime and not all(grains.poisson for grains in grains.of_each()):
            raise ParameterError("poisson = 0: with viscous drag must be > 0 (A22 eq 7 divides by its square)")
        return super(GrainParameters, grains).filled_in()

    def _require_left_out(self, given, names):
        for name in names:
            if (value := getattr(self, name)) is not None:
                value = value if isinstance(value, str) else f"{value:g}"
                raise ParameterError(f"{name} = {value}: given {given}; must be left out")

    @property
    def material_names(self):
        """Names of the materials, one or two."""
        return _names(self.material)

    def of_each(self):
        """The same parameters for grains of each material alone, in a list; of one material these."""
        known, each = known_materials(self.materials), [self.changed(material=self.material_names[0])]
        for name in self.material_names[1:]:
            each.append(self.changed(material=name, **{key: getattr(known[name], key) for key in PROPERTIES}))
        return each


def _names(text):
    return [name.strip() for name in text.split(",")]


def known_materials(file=None):
    """{name: Material} of the papers, and of one's own in a TOML file, a section a material. Raises ParameterError."""
    return {**MATERIALS, **(_materials_as_written(file, changed(file)) if file else {})}


@lru_cache
def _materials_as_written(file, _when):
    import tomllib  # which Python 3.10 lacks

    try:
        with open(file, "rb") as opened:
            sections = tomllib.load(opened)
    except (OSError, ValueError) as error:
        must = "must be TOML, a section [NAME] a material"
        raise ParameterError(f"materials = {file}: {' '.join(str(error).split())}; {must}") from None
    found, columns = {}, GrainParameters.columns()
    for name, own in sections.items():
        where, missing = f"{file}: [{name}]", set(PROPERTIES) - set(own if isinstance(own, dict) else ())
        if missing:
            raise ParameterError(f"{where}: no {min(missing)}; must have {', '.join(PROPERTIES)}")
        if unknown := set(own) - {*PROPERTIES, "grainRadius"}:
            raise ParameterError(f"{where}: {min(unknown)}: no property{suggested(min(unknown), PROPERTIES)}")
        try:
            values = {key: columns[key].value(value) for key, value in own.items()}
            for key in values:
                columns[key].require_usual(values[key])
        except ParameterError as problem:
            raise ParameterError(f"{where}: {problem}") from None
        found[name] = Material(**{"grainRadius": None, **values})
    return found


def pair_constants(grains, radii=None, neck=0.0, linearDamping=0.0, other=None):
    """Constants of a contact of two grains, where no YADE runs. A run takes them from the plugin; a test compares.

    grains: with the attributes of Material, perhaps viscoelasticTime [s] and OF_PAIRS; other: likewise, of the
    second grain where it is of another material; radii: of the two [m], both grainRadius if left out; neck: beta
    of sintered grains; linearDamping: k_n. Returns {name: value} by the plugin's names, SI; with a neck those of a
    bond, of two grains of grainRadius, as "bond".
    """
    both = [_material_of(of) for of in (grains, other or grains)]
    first, second = radii or (grains.grainRadius, grains.grainRadius)
    options = [getattr(grains, name, usual) for name, usual in OF_PAIRS.items()]
    found = _by_plugins_names(_pair_constants(both[0], first, both[1], second, linearDamping, *options))
    if neck:
        found["bond"] = _by_plugins_names(_bond_constants(both[0], grains.grainRadius, neck))
        found["bond"]["shrunkRadius"] = grains.grainRadius * theory.shrunk_radius(neck)
    return found


def _material_of(grains):
    properties = [float(getattr(grains, name)) for name in PROPERTIES]
    return theory.Material(*properties, getattr(grains, "viscoelasticTime", 0.0))


def _by_plugins_names(constants):
    """{equilibriumOverlap: value} of an object with equilibrium_overlap."""
    camel_case = lambda name: name[0] + name.title().replace("_", "")[1:]
    return {camel_case(name): value for name, value in vars(constants).items()}


def equilibrium_overlap(grains):
    """Overlap [m] at which the JKR force between two of these grains vanishes (A22 after eq 2)."""
    return pair_constants(grains)["equilibriumOverlap"]


def of_pairs(each, of):
    """Matrix (K, K) of a function of pair_constants(), of two grains of grainRadius of every pair of K materials
    (objects with the attributes of Material)."""
    return np.array([[of(pair_constants(one, other=other)) for other in each] for one in each])


def overlaps(each):
    """The same of the overlap at rest [m]."""
    return of_pairs(each, lambda pair: pair["equilibriumOverlap"])


def derived_grains(each, constants):
    """What run.json has, under `derived`, of grains of these materials: constants (of a contact) of the first.

    each: a list of objects with the attributes OF_MATERIAL, grainRadius and `material`, the name."""
    first = each[0]
    return {
        **{name: getattr(first, name) for name in (*OF_MATERIAL, "grainRadius")},
        "grainMass": 4 / 3 * pi * first.grainRadius**3 * first.density,
        **{name: constants[name] for name in OF_CONTACT},
        **derived_materials(each),
    }


def derived_materials(each):
    """The same of several materials: their properties, the factor of unlike ones, and F_c delta_c [J] of each pair of
    two grains of grainRadius; {} of one."""
    if len(each) == 1:
        return {}
    energy = lambda pair: pair["pullOffForce"] * pair["pullOffOverlap"]
    materials = [{"name": own.material, **{name: getattr(own, name) for name in PROPERTIES}} for own in each]
    factor = getattr(each[0], MIXED_FACTOR, 1.0)
    return {"materials": materials, MIXED_FACTOR: factor, "pullOffEnergies": of_pairs(each, energy).tolist()}


def require_small_contacts(grains, radius=None):
    """Raise ParameterError when adhesion presses grains of a radius [m] (grainRadius) together so much that the JKR
    theory means nothing. grains: GrainParameters."""
    radius = radius or grains.grainRadius
    for own in grains.of_each():
        contact = pair_constants(own, (radius, radius))["equilibriumContactRadius"]
        if contact >= 0.5 * radius:
            given = f"grainRadius = {radius:g}: contacts at rest have a radius of {contact / radius:.2g} grain radii"
            raise ParameterError(f"{given}; must be less than 0.5, with larger or stiffer grains or less surfaceEnergy")
