"""Of which grains a run is: the constants that tell them apart, in one list; columns, keys and labels follow from it."""

from math import isclose

from ..theory import GRAIN_RADIUS, MATERIALS
from .columns import constant, parameter, row_of
from .definition import NotMeasured

# Name: unit and meaning of the column; symbol, unit in which it is shown, and that unit in SI.
_CONSTANTS = {
    "grainRadius": ("m", "radius of a grain", "r0", " um", 1e-6),
    "young": ("Pa", "Young's modulus", "E", " GPa", 1e9),
    "poisson": ("", "Poisson's ratio", "nu", "", 1.0),
    "density": ("kg/m^3", "density of a grain", "rho", " kg/m^3", 1.0),
    "surfaceEnergy": ("J/m^2", "gamma", "gamma", " J/m^2", 1.0),
    "criticalRolling": ("m", "xi_crit", "xi_crit", " Å", 1e-10),
    "slidingStiffnessFactor": ("", "k_s over Wada's", "k_s factor", "", 1.0),
}
*OF_MATERIAL, SLIDING = OF_GRAINS = tuple(_CONSTANTS)
GRAINS = (
    *(constant(name, *_CONSTANTS[name][:2]) for name in OF_MATERIAL),
    parameter(SLIDING, *_CONSTANTS[SLIDING][:2], usual=1.0),
)


def _of_paper(material, radius):
    values = (radius, material.young, material.poisson, material.density, material.surface_energy)
    return dict(zip(OF_GRAINS, (*values, material.critical_rolling, 1.0)))


# Kataoka et al. (2013), Table 1 and section 2.1; its ice is that of Arakawa et al. (2022, 2024) too.
PAPERS = {name: _of_paper(material, GRAIN_RADIUS[name]) for name, material in MATERIALS.items()}


def other_grains(parameters):
    """[name] of what differs from the papers' grains of that material, parameters: a mapping with material and OF_GRAINS;
    all names for a material that they do not have."""
    theirs = PAPERS.get(parameters["material"], {})
    return [n for n in OF_GRAINS if n not in theirs or not isclose(parameters[n], theirs[n], rel_tol=1e-6)]


def require_papers_grains(run, but=()):
    """NotMeasured, with what differs, for a RunFolder of other grains than the papers' of its material, but for the names
    `but`: a study without grains in its key would take such runs for seeds or duplicates of others."""
    parameters = {"material": run.parameters["material"], **row_of(GRAINS, run)}
    others = [name for name in other_grains(parameters) if name not in but]
    if others:
        values = ", ".join(f"{name} = {parameters[name]:g}" for name in others)
        raise NotMeasured(f"{run.path}: other grains than the paper's ({values})")


def grains_text(parameters, but=()):
    """The material, and in brackets what differs from the papers' grains of it, without the names `but`."""
    others = []
    for name in (name for name in other_grains(parameters) if name not in but):
        *_, symbol, unit, si = _CONSTANTS[name]
        others.append(f"{symbol} = {parameters[name] / si:.4g}{unit}")
    return parameters["material"] + (f" ({', '.join(others)})" if others else "")
