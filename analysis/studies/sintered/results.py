"""All results of a set of runs: points with their statistics, the fit of broken necks."""

from dataclasses import dataclass
from types import MappingProxyType
from typing import Mapping

import numpy as np
import pandas

from ...measures.outcome import BOUNCING, STICKING, UNDECIDED
from ...runs.format import BROKEN_BONDS
from ...statistics import mean_and_error, pair_weights, resampling_error, stretch
from .measure import LOST, PARTS

# What tells points apart; every run of a point has another seed.
POINT = (
    *("planar", "criticalRolling", "viscoelasticTime", "cut", "sliding_factor"),
    *("growth_velocity", "neck", "velocity"),
)
MEANS = (
    "contacts",
    "initial_radius",
    "largest",
    "second",
    "fragments",
    "gyration_radius",
    "cut_per_grain",
    "by_rolling",
    "rolling_of_lost",
    "stretching_of_lost",
    *(f"part_{name}" for name in PARTS),
)


@dataclass(frozen=True)
class Point:
    """The runs of one parameter set: those of POINT as attributes, energy_ratio (NaN: unsintered), runs (their number),
    means {name: (mean, standard error or None)} of MEANS (by_rolling: over runs in which necks broke; None without any; X_of_lost:
    fraction of all that was dissipated),
    outcomes {kind: number}, grown (runs in which the largest piece has more than half the mass)."""

    planar: int
    criticalRolling: float
    viscoelasticTime: float
    cut: int
    sliding_factor: float
    growth_velocity: float
    neck: float
    velocity: float
    energy_ratio: float
    runs: int
    means: Mapping
    outcomes: Mapping
    grown: int

    def number(self, kind):
        """How many runs ended so."""
        return self.outcomes.get(kind, 0)

    @property
    def sticking(self):
        """How many runs ended in one piece, which is S17's sticking, whether their halves still swing or not."""
        return self.number(STICKING) + self.number(UNDECIDED)

    @property
    def bouncing(self):
        """How many runs ended in bouncing."""
        return self.number(BOUNCING)


@dataclass(frozen=True)
class Fit:
    """N_cut/N_t = amplitude (E_k/E_sint)^exponent through runs, with standard errors (None: too few seeds) and the number of
    runs and of points."""

    amplitude: float
    exponent: float
    amplitude_error: float
    exponent_error: float
    runs: int
    points: int


@dataclass(frozen=True)
class Results:
    """table (a row a run, measure.COLUMNS), points ([Point], sorted), fits ({(planar, T_vis): Fit or None} of the runs with
    xi_crit = 2 Angstrom and S17's LAW)."""

    table: pandas.DataFrame
    points: tuple
    fits: Mapping

    def select(self, **values):
        """[Point] with these attributes, to a relative 2e-3 (velocities are printed so)."""
        return [p for p in self.points if all(same(getattr(p, name), value) for name, value in values.items())]

    def main(self, **values):
        """[Point] in the plane, xi_crit = 2 Angstrom, without drag, S17's LAW, and with these attributes."""
        return self.select(**{**MAIN, **values})

    def runs(self, **values):
        """The rows of `table` in the plane, xi_crit = 2 Angstrom, without drag, S17's LAW, and with these values in their
        columns."""
        return runs_with(self.table, **{**MAIN, **values})

    def sintered(self, **values):
        """The rows of `table` of sintered aggregates, without drag, S17's LAW, and with these values in their columns."""
        return runs_with(self.table[self.table.neck > 0], **{**LAW, "viscoelasticTime": 0.0, **values})

    def paired(self, column, first, second):
        """Values (n,) of a column in the BCCA runs() with `first` {column: value} less those with `second`, seed by seed: n seeds
        that both have."""
        chosen = [self.runs(growth_velocity=0.0, **values) for values in (first, second)]
        values = [runs.groupby("packing_seed")[column].mean() for runs in chosen]
        return (values[0] - values[1]).dropna().to_numpy()


LAW = MappingProxyType({"cut": 1, "sliding_factor": 2.0})  # of ordinary contacts: section 3.2, eqs 10 to 12
MAIN = MappingProxyType({"planar": 1, "criticalRolling": 2e-10, "viscoelasticTime": 0.0, **LAW})


def same(a, b):
    """Whether two numbers are printed alike: within 2e-3 of the larger.

    >>> same(3.162, 10**0.5), same(0.0, 0.2)
    (True, False)
    """
    return abs(a - b) <= 2e-3 * max(abs(a), abs(b))


def runs_with(table, **values):
    """The rows of a table of runs that have these values in their columns, printed alike."""
    chosen = [table[name].map(lambda found, value=value: same(found, value)) for name, value in values.items()]
    return table[np.logical_and.reduce(chosen)]


def make_results(table):
    """Results of a table of runs (measure.COLUMNS), at least one."""
    table = table.assign(broken=table[list(BROKEN_BONDS)].sum(axis=1))
    lost = sum(table[f"part_{name}"] for name in LOST)
    table = table.assign(
        cut_per_grain=table.broken / table.grains,
        rolling_of_lost=table.part_rolling_friction / lost,
        stretching_of_lost=table.part_stretching / lost,
        by_rolling=table.brokenByRolling / table.broken.where(table.broken > 0),
    )
    keys = [table[name].map(lambda value: float(f"{value:.6g}")) for name in POINT]
    points = tuple(_point(key, runs) for key, runs in table.groupby(keys))
    fits = {}
    for planar, drag in sorted({(p.planar, p.viscoelasticTime) for p in points}):
        fits[planar, drag] = fit_broken(runs_with(table, **{**MAIN, "planar": planar, "viscoelasticTime": drag}))
    return Results(table, points, MappingProxyType(fits))


def _point(key, runs):
    means = {}
    for name in MEANS:
        values = runs[name].to_numpy(dtype=float)
        values = values[np.isfinite(values)]
        means[name] = mean_and_error(values) if len(values) else None
    return Point(
        *(int(v) if n in ("planar", "cut") else v for n, v in zip(POINT, key)),
        float(runs.energy_ratio.iloc[0]),
        len(runs),
        MappingProxyType(means),
        MappingProxyType(runs.outcome.value_counts().to_dict()),
        int((runs.largest > 0.5).sum()),
    )


def is_fitted(table):
    """Which runs (mask) the paper's fit is of: sintered, but not BCCA aggregates of beta = 0.2, with necks broken."""
    weak = (table.growth_velocity == 0) & (table.neck < 0.25)
    return (table.neck > 0) & ~weak & (table.broken > 0)


def fit_broken(table):
    """Fit of a table of runs (with `broken`), least squares of the logarithms of the points' means as in the paper; errors
    from resampling seeds, each with all its runs. None for fewer than two energy ratios."""
    table = table[is_fitted(table)]
    ratios = np.array([float(f"{r:.4g}") for r in table.energy_ratio])
    if len(np.unique(ratios)) < 2:
        return None
    group = table.groupby([*POINT, "energy_ratio"]).ngroup().to_numpy()
    x, y = np.log(table.energy_ratio.to_numpy()), table.cut_per_grain.to_numpy()
    slope, height = _line(x, y, group, np.ones((1, len(y))))
    seeds = table.packing_seed.to_numpy()
    errors = (None, None)
    if len(np.unique(seeds)) > 2:
        drawn = _line(x, y, group, pair_weights(seeds))
        widen = stretch(len(np.unique(seeds)), 2)
        errors = [resampling_error(values) * widen for values in (np.exp(drawn[1]), drawn[0])]
    return Fit(float(np.exp(height[0])), float(slope[0]), *errors, len(table), len(np.unique(group)))


def _line(x, y, group, weights):
    """(slope, height) (B,) of ln <y> against x, one point a group (weighted mean of y), for weights (B, n)."""
    names = np.unique(group)
    where = np.array([x[group == name][0] for name in names])
    mean = np.stack(
        [(weights[:, group == n] @ y[group == n]) / weights[:, group == n].sum(axis=1) for n in names], axis=1
    )
    slope, height = np.polyfit(where, np.log(mean).T, 1)
    return slope, height


def fit_curve(fit, ratios):
    """N_cut/N_t of a Fit, or of paper.FIT, at E_k/E_sint."""
    amplitude, exponent = (fit.amplitude, fit.exponent) if isinstance(fit, Fit) else fit
    return amplitude * np.asarray(ratios, dtype=float) ** exponent
