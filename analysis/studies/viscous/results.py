"""All results of a set of runs."""

from dataclasses import dataclass
from typing import Mapping

import numpy as np
import pandas

from ...statistics import mean_and_error, resampling_error
from .impact_mean import Draws, has_scatter, head_on_mean, impact_mean
from .measure import DISSIPATION, is_reference
from .size_distribution import SizeDistribution, size_distribution
from .threshold import threshold_velocity

CLOSE = 2e-3  # relative: velocities that count as the same


@dataclass(frozen=True)
class Growth:
    """<f_gro>, or f_gro at B_off = 0, against velocity at one size and T_vis: velocities (V,) [m/s], mean (V,), error (V,) (NaN: not known),
    resamples (B, V); v_fra [m/s] (None: outside the velocities), its error (None: not known) and resamples (B,);
    distributions ({velocity: SizeDistribution}); sticking_velocity [m/s] of two grains."""

    grains: int
    viscous_time: float
    velocities: np.ndarray
    mean: np.ndarray
    error: np.ndarray
    resamples: np.ndarray
    v_fra: float
    v_fra_error: float
    v_fra_resamples: np.ndarray
    distributions: Mapping[float, SizeDistribution]
    sticking_velocity: float

    @property
    def has_errors(self):
        """Whether the seeds allow errors."""
        return bool(np.isfinite(self.error).any())


@dataclass(frozen=True)
class Results:
    """table (a row a run, measure.COLUMNS); {(grains, T_vis): Growth}: growth of means over B_off, where some velocity has B_off
    from 0 to 1, and head_on."""

    table: pandas.DataFrame
    growth: Mapping
    head_on: Mapping

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


def make_results(table):
    """Results of a table of runs (measure.COLUMNS), at least one."""
    return Results(table, _growths(table, impact_mean), _growths(table[table.impact == 0], head_on_mean))


def _growths(table, mean):
    """{(grains, T_vis): Growth} of a table of runs, with impact_mean or head_on_mean."""
    found = {}
    for grains, of_size in table.groupby("grains"):
        draws = Draws(of_size.seed)
        for time, runs in of_size.groupby(of_size.viscoelasticTime.round(16)):
            own = _growth(int(grains), float(time), runs, draws, mean)
            if own is not None:
                found[int(grains), float(time)] = own
    return found


def _growth(grains, time, table, draws, mean):
    velocities, means, resamples, errors, distributions = [], [], [], [], {}
    for _, runs in table.groupby(table.velocity.round(6)):
        found = mean(runs, runs.growth, draws)
        if found is None:
            continue
        velocity = float(runs.velocity.iloc[0])
        velocities.append(velocity)
        means.append(float(found[0]))
        resamples.append(found[1])
        errors.append(resampling_error(found[1]) if has_scatter(runs) else np.nan)
        if mean is impact_mean:
            distributions[velocity] = size_distribution(runs, draws)
    if not velocities:
        return None
    resamples = np.stack(resamples, axis=1)
    v_fra, drawn = threshold_velocity(velocities, means), threshold_velocity(velocities, resamples)
    known = np.isfinite(v_fra)
    return Growth(
        grains,
        time,
        np.array(velocities),
        np.array(means),
        np.array(errors, dtype=float),
        resamples,
        float(v_fra) if known else None,
        resampling_error(drawn) if known and np.isfinite(errors).any() else None,
        drawn,
        distributions,
        float(table.sticking_velocity.iloc[0]),
    )


def by_time(table, values):
    """[(T_vis, mean, error, number)] of values (runs,) of a table, without those that are NaN."""
    found = []
    values = np.asarray(values, dtype=float)
    times = table.viscoelasticTime.to_numpy().round(16)
    for time in np.unique(times):
        own = values[(times == time) & np.isfinite(values)]
        if len(own):
            found.append((float(time), *mean_and_error(own), len(own)))
    return found


def named(quantity, growth):
    """The quantity with T_vis and size of a Growth, as lines name it."""
    return f"{quantity}, T_vis = {picoseconds(growth.viscous_time)} ps, {growth.grains} grains"
