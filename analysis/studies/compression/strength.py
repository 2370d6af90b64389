"""Sets of compressions against the filling factor: which clusters and filling factors count, and power laws of the pressure."""

import numpy as np
import pandas

from ...theory.compression import bcca_filling, compressive_strength, static_from, strength_scale
from ..curves import power
from ..grains import grains_text
from .curve import FILLINGS, HALF_BINS
from .measure import COORDINATIONS, PRESSURES

# What the clusters of a set have in common; their seeds and the ends of the compressions differ.
SET = ("material", "grains", "stepFraction", "linearDamping", "criticalRolling", "strainRate")
VALID_TO = 0.1  # the filling factor up to which K13 eq 25 holds
FEWEST_BINS = 3
ROUNDING = 1.0 + 1e-9


def named(table):
    """The table with materials named by what differs from K13's grains, xi_crit left out: other grains make sets of their own."""
    return table.assign(material=[grains_text(row, but=("criticalRolling",)) for row in table.to_dict("records")])


def furthest(table):
    """A row a cluster of each set: of several compressions that which went furthest."""
    own = table.sort_values("largest_filling", kind="stable")
    return own.drop_duplicates([*SET, "seed"], keep="last").sort_index()


def by_filling(clusters):
    """A row a cluster and filling factor `filling`: its `pressure` [Pa], that `over` K13 eq 25, its `coordination`; of each set the filling factors
    at which all clusters that went so far have a pressure.

    `settled`: every cluster of the set is denser than a free one (K13 eq 24) there, boundaries are slower than sound (eqs 26, 27), and contacts connect
    the cell with its images along all axes, without which it bears no load along some axis. `shared`: all clusters of the set came there, so that a
    fit along the filling factor is of the same clusters everywhere."""
    of_run = clusters.grainRadius, clusters.time_unit, clusters.rolling_energy, clusters.grain_mass
    static = np.maximum(bcca_filling(clusters.grains), static_from(clusters.strainRate, clusters.grains, *of_run))
    of_set = [clusters[name] for name in SET]
    scale, spanned = strength_scale(clusters.rolling_energy, clusters.grainRadius), clusters.spanned_from.fillna(0.0)
    parts = []
    for filling, half, pressure, contacts in zip(FILLINGS, HALF_BINS, PRESSURES.values(), COORDINATIONS.values()):
        there = clusters.largest_filling * ROUNDING >= filling * half
        own = clusters.assign(
            filling=filling,
            pressure=clusters[pressure],
            over=clusters[pressure] / compressive_strength(filling, scale),
            coordination=clusters[contacts],
            shared=there.groupby(of_set).transform("all"),
            settled=(filling * ROUNDING >= static) & (filling / half * ROUNDING >= spanned),
        )
        parts.append(own[there])
    rows = pandas.concat(parts, ignore_index=True)
    sets = rows.groupby([*SET, "filling"])
    rows["settled"] = sets.settled.transform("all")
    return rows[sets.pressure.transform("count") == sets.pressure.transform("size")]


def exponent(filling, over):
    """n of P ~ phi^n (K13 eq 23) from P over phi^3, over (..., K) at filling factors (K,): curves.power()."""
    return 3.0 + power(filling, over)


def level(filling, over):
    """P0 r0^3/E_roll with n = 3 (K13 eq 25): the geometric mean of over (..., K); NaN where one is not positive.

    >>> float(level([0.01, 0.1], [1.0, 4.0]).round(9))
    2.0
    """
    over = np.asarray(over, dtype=float)
    return np.exp(np.log(np.where(over > 0, over, np.nan)).mean(axis=-1))


def with_bins(fit, start=np.inf):
    """A fit (of filling, over) as one that is NaN with fewer than FEWEST_BINS, and where these begin beyond the filling factor `start`."""

    def fitted(filling, over):
        known = len(filling) >= FEWEST_BINS and filling[0] <= start * ROUNDING
        return fit(filling, over) if known else np.full(np.shape(over)[:-1], np.nan)

    return fitted
