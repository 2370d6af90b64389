"""All results of a set of compressions."""

from dataclasses import dataclass

import numpy as np
import pandas

from ...theory.compression import bcca_filling, static_from, strength_scale
from . import paper
from .curve import FILLINGS
from .measure import COORDINATIONS, DIMENSIONS, ENERGIES, PRESSURES
from .strength_fit import StrengthFit, fit_strength

# What a group's runs have in common; seeds and the end of the compression differ.
KEYS = ("material", "grains", "strainRate", "linearDamping", "criticalRolling", "grainRadius", "stepFraction")


@dataclass(frozen=True)
class Group:
    """Runs of one set of parameters: parameters (dict, KEYS), table (a row a seed, the run that went furthest), pressure
    and coordination (S, K) at FILLINGS, scale (E_roll/r0^3 [Pa]), fit (StrengthFit), name (what is special about it)."""

    parameters: dict
    table: pandas.DataFrame
    pressure: np.ndarray
    coordination: np.ndarray
    scale: float
    fit: StrengthFit

    @property
    def seeds(self):
        return len(self.table)

    @property
    def covered(self):
        """(K,) bool: the bins in which every seed has a value."""
        return np.isfinite(self.pressure).all(axis=0)

    @property
    def mean_pressure(self):
        """(K,) [Pa] arithmetic mean over the seeds (K13 section 3.1), NaN where a seed has none."""
        return self.pressure.mean(axis=0)

    def energy(self, channel, filling):
        """Mean over the seeds of what a channel has lost until a filling factor of measure.ENERGY_FILLINGS [J]."""
        return float(self.table[ENERGIES[channel, filling]].mean())

    def dimensions(self):
        """{filling: (S,) fractal dimensions} of the fillings that have some."""
        found = {filling: self.table[name].dropna().to_numpy(dtype=float) for name, filling in DIMENSIONS.items()}
        return {filling: values for filling, values in found.items() if len(values)}


@dataclass(frozen=True)
class Results:
    """table (a row a run, measure.COLUMNS), groups (Group, the largest and slowest first), stretched (table of the runs
    that were stretched)."""

    table: pandas.DataFrame
    groups: tuple
    stretched: pandas.DataFrame

    def of(self, material):
        """Groups of a material, those without a fit included."""
        return tuple(group for group in self.groups if group.parameters["material"] == material)

    @property
    def main(self):
        """The group that is shown first: K13's fiducial one of ice if it is there, else the first that was fitted."""
        of_ice = self.of("ice") or self.groups
        fiducial = [group for group in of_ice if paper.is_fiducial(group.parameters)]
        fitted = [group for group in of_ice if group.fit.reason is None]
        return (fiducial or fitted or of_ice)[0]


def family(results, name):
    """Groups that differ in one parameter of KEYS only, one for each of its values, sorted by it: of several families the
    largest, then the one of the most runs; () where no two groups are such. The step may differ too: of groups with the
    same value that of the most runs is taken."""
    families = {}
    for group in sorted(results.groups, key=lambda group: group.seeds):
        rest = tuple(value for key, value in group.parameters.items() if key not in (name, "stepFraction"))
        families.setdefault(rest, {})[group.parameters[name]] = group
    largest = max(families.values(), key=lambda groups: (len(groups), sum(group.seeds for group in groups.values())))
    return tuple(largest[value] for value in sorted(largest)) if len(largest) > 1 else ()


def make_results(table):
    """Results of a table of runs (measure.COLUMNS), at least one."""
    groups = [_group(dict(zip(KEYS, key)), runs) for key, runs in table.groupby(list(KEYS), sort=True)]
    groups.sort(key=lambda group: (-group.parameters["grains"], group.parameters["strainRate"], -group.seeds))
    return Results(table, tuple(groups), table[table.stretched_axes > 0])


def _group(parameters, runs):
    furthest = runs.sort_values(["seed", "largest_filling"], kind="stable").drop_duplicates("seed", keep="last")
    first = furthest.iloc[0]
    pressure = furthest[list(PRESSURES)].to_numpy(dtype=float)
    low = max(
        float(bcca_filling(first.grains)),
        static_from(
            first.strainRate, first.grains, first.grainRadius, first.time_unit, first.rolling_energy, first.grain_mass
        ),
    )
    return Group(
        parameters,
        furthest,
        pressure,
        furthest[list(COORDINATIONS)].to_numpy(dtype=float),
        strength_scale(first.rolling_energy, first.grainRadius),
        fit_strength(FILLINGS, pressure, low, paper.VALID_TO),
    )
