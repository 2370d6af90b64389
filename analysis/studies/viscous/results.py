"""All results of a set of runs."""

from dataclasses import dataclass
from typing import Mapping

import numpy as np
import pandas

from ...statistics import mean_and_error, resampling_error
from .curves import Curve, curves
from .grid import SAME, time_of_grid
from .impact_mean import Draws, head_on_mean, head_on_runs, offsets_text, whole_impacts
from .measure import DISSIPATION, is_reference, sizes_from_text
from .size_distribution import SizeDistribution, size_distribution
from .threshold import threshold_velocity
from .whole_pairs import offset_squares

LOST = 0.05
SMALL = 10  # grains of a fragment that counts as small
MERGED = 0.5  # f_gro above which two aggregates have merged; two remnants have some 0, all in one piece is 1


@dataclass(frozen=True)
class Growth(Curve):
    """<f_gro>, and what follows: v_fra [m/s] (None: outside the velocities), its error (None: not known at some velocity, or LOST
    of the resamples have none within the velocities) and resamples (B,); sticking_velocity [m/s] of two grains."""

    v_fra: float
    v_fra_error: float
    v_fra_resamples: np.ndarray
    sticking_velocity: float


@dataclass(frozen=True)
class Results:
    """table (a row a run, measure.COLUMNS), and by (grains, T_vis): growth (Growth), where some velocity has B_off from 0 to 1;
    head_on (Curve of f_gro at B_off = 0); small (Curve of the mean over B_off of the mass in small fragments, over that of one
    aggregate), remnants (Curve of <f_gro> and half of that), merging (Curve of the mean over B_off of whether they merge: a
    cross-section over pi b_max^2) and distributions ({velocity: SizeDistribution}; {} where they were not asked for)."""

    table: pandas.DataFrame
    growth: Mapping
    head_on: Mapping
    small: Mapping
    remnants: Mapping
    merging: Mapping
    distributions: Mapping[tuple, Mapping[float, SizeDistribution]]

    @property
    def sizes(self):
        """Numbers of grains that have means over B_off, rising."""
        return sorted({grains for grains, _ in self.growth})

    @property
    def main_size(self):
        """The largest of those with the most T_vis; None without any."""
        return max(self.sizes, key=lambda grains: (len(self.of_size(grains)), grains), default=None)

    def of_size(self, grains):
        """[Growth] of one size, by T_vis."""
        return [self.growth[key] for key in sorted(self.growth) if key[0] == grains]

    @property
    def reference(self):
        """Table of the runs at 50.1 m/s and B_off^2 = 3/12."""
        rows = [is_reference(row) for row in self.table[["velocity", "impact"]].to_dict("records")]
        return self.table[np.array(rows, dtype=bool)]

    @property
    def reference_size(self):
        """The largest size with such runs; None without any."""
        return int(self.reference.grains.max()) if len(self.reference) else None


def picoseconds(viscous_time):
    """T_vis in ps, a plain number.

    >>> picoseconds(6e-12)
    '6'
    """
    return f"{viscous_time * 1e12:.4g}"


def total_dissipation(table):
    """Sum (runs,) [J] of what the runs of a table have lost in all of A22's ways."""
    return table[list(DISSIPATION)].sum(axis=1)


def make_results(table, distributions=True):
    """Results of a table of runs (measure.COLUMNS), at least one."""
    found = curves(table, table.growth)
    small = small_mass(table)
    return Results(
        table,
        {key: _growth(curve, rows_of(table, key)) for key, curve in found.items()},
        curves(table, table.growth, head_on_mean, head_on_runs),
        curves(table, small),
        curves(table, table.growth + 0.5 * small),
        curves(table, (table.growth > MERGED).astype(float)),
        {key: _distributions(rows_of(table, key), Draws(table.seed[table.grains == key[0]])) for key in found}
        if distributions
        else {},
    )


def over_offsets(results, offsets, seeds=None):
    """Results of the runs at these offsets (B_off^2) alone, of some seeds alone if they are given, without size distributions:
    what is compared between sizes is of the same offsets."""
    table = results.table
    kept = np.isin(offset_squares(table), np.asarray(offsets))
    if seeds is not None:
        kept &= table.seed.isin(seeds).to_numpy()
    return make_results(table[kept], distributions=False)


def small_mass(table):
    """Mass (runs,) in fragments of SMALL grains or fewer over that of one aggregate, of a table of runs."""
    sizes = [sizes_from_text(text) for text in table.fragments]
    return np.array([own[own <= SMALL].sum() for own in sizes], dtype=float) / table.grains


def threshold_error(resamples):
    """Standard error from resamples (B,) of a threshold; None where LOST of them or more have none: the others would tell too
    small an error."""
    return resampling_error(resamples) if np.mean(~np.isfinite(resamples)) < LOST else None


def rows_of(table, key):
    """Rows of a size and T_vis."""
    return table[(table.grains == key[0]) & ((table.viscoelasticTime - key[1]).abs() < 1e-16)]


def _growth(curve, table):
    """Growth from the Curve of <f_gro> and its rows."""
    v_fra, drawn = (threshold_velocity(curve.velocities, values) for values in (curve.mean, curve.resamples))
    known = np.isfinite(v_fra)
    return Growth(
        **vars(curve),
        v_fra=float(v_fra) if known else None,
        v_fra_error=threshold_error(drawn) if known and curve.has_errors else None,
        v_fra_resamples=drawn,
        sticking_velocity=float(table.sticking_velocity.iloc[0]),
    )


def _distributions(table, draws):
    """{velocity: SizeDistribution} of a size and T_vis."""
    table, _ = whole_impacts(table)
    by_velocity = table.groupby(table.velocity.round(6))
    return {float(runs.velocity.iloc[0]): size_distribution(runs, draws) for _, runs in by_velocity}


def by_time(table, values):
    """[(T_vis, mean, error, number of pairs)] of values (runs,) of a table of runs of one size, without those that are NaN: the
    mean and error over pairs of aggregates, each of which counts once."""
    own = table.assign(value=np.asarray(values, dtype=float)).dropna(subset="value")
    of_pairs = own.groupby([own.viscoelasticTime.map(time_of_grid), "seed"]).value.mean()
    found = of_pairs.groupby(level=0)
    return [(float(time), *mean_and_error(means), len(means)) for time, means in found]


def at_velocities(velocity, wanted):
    """Whether a velocity [m/s] is one of those wanted."""
    return any(abs(velocity / each - 1) < SAME for each in wanted)


def pairs_text(number):
    """Words on so many pairs of aggregates.

    >>> pairs_text(1), pairs_text(3)
    ('1 pair', '3 pairs')
    """
    return f"{number} pair" + ("s" if number != 1 else "")


def named(quantity, growth):
    """The quantity with T_vis, size and, where they are not the paper's, offsets of a Curve, as lines name it."""
    return f"{quantity}, T_vis = {picoseconds(growth.viscous_time)} ps, {growth.grains} grains{offsets_text(growth.offsets)}"
