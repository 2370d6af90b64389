"""All results of a set of compressions."""

from dataclasses import dataclass

import numpy as np
import pandas

from ...theory.compression import bcca_filling, static_from, strength_scale
from . import paper
from .curve import FILLINGS, HALF_BINS
from .measure import COORDINATIONS, DIMENSIONS, ENERGIES, PRESSURES, TWISTING
from .scene import KEYS
from .strength_fit import StrengthFit, fit_strength


@dataclass(frozen=True)
class Group:
    """Runs of one set of parameters: parameters (dict, scene.KEYS), table (a row a seed, the run that went furthest),
    pressure and coordination (S, K) at FILLINGS, scale (E_roll/r0^3 [Pa] of these grains), fit (StrengthFit), static_from
    (the filling factor above which boundaries are slower than sound, K13 eqs 26, 27)."""

    parameters: dict
    table: pandas.DataFrame
    pressure: np.ndarray
    coordination: np.ndarray
    scale: float
    fit: StrengthFit
    static_from: float

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
        """(S,) what a channel has lost until a filling factor of measure.ENERGY_FILLINGS [J]; NaN where a run ends before."""
        return self.table[ENERGIES[channel, filling]].to_numpy(dtype=float)

    def twisting_from(self, share):
        """Filling factors (n,) from which on twisting has lost `share`, one of measure.TWISTING_SHARES, of what rolling has,
        of the seeds where it is passed."""
        return self.table[TWISTING[share]].dropna().to_numpy(dtype=float)

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
        """Groups of a material, those without a fit included; those of K13's grains first."""
        own = [group for group in self.groups if group.parameters["material"] == material]
        return tuple(sorted(own, key=lambda group: not paper.has_k13s_grains(group.parameters)))

    @property
    def of_k13s_grains(self):
        """Groups of K13's ice and damping, of any number of grains and C_v; all of ice, or all, where there are none."""
        of_ice = self.of("ice") or self.groups
        return tuple(group for group in of_ice if paper.has_fiducial_grains(group.parameters)) or of_ice

    @property
    def main(self):
        """The group that is shown first: of of_k13s_grains that of the most clusters, then the largest and slowest; one
        that was fitted if there is one."""
        return max(
            self.of_k13s_grains, key=lambda group: (group.fit.reason is None, group.seeds, *_size_and_rate(group))
        )

    @property
    def larger(self):
        """The group of of_k13s_grains with the most grains, if that has more than main; None otherwise."""
        largest = max(self.of_k13s_grains, key=lambda group: (group.parameters["grains"], group.seeds))
        return largest if largest.parameters["grains"] > self.main.parameters["grains"] else None

    @property
    def shown(self):
        """(main,), or (main, larger)."""
        return (self.main,) if self.larger is None else (self.main, self.larger)


def _size_and_rate(group):
    return group.parameters["grains"], -group.parameters["strainRate"], group.parameters["stepFraction"]


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
    scale = strength_scale(first.rolling_energy, first.grainRadius)
    static = static_from(
        first.strainRate, first.grains, first.grainRadius, first.time_unit, first.rolling_energy, first.grain_mass
    )
    low = max(float(bcca_filling(first.grains)), static, _spanned_from(furthest))
    return Group(
        parameters,
        furthest,
        pressure,
        furthest[list(COORDINATIONS)].to_numpy(dtype=float),
        scale,
        fit_strength(FILLINGS, pressure, low, paper.VALID_TO),
        static,
    )


def _spanned_from(runs):
    """The loosest filling factor whose bin lies above those at which any run's contacts come to span its cell; 0 where no
    run's states tell."""
    known = runs.spanned_from.dropna()
    return float((FILLINGS[FILLINGS / HALF_BINS >= known.max() * (1.0 - 1e-9)]).min(initial=1.0)) if len(known) else 0.0
