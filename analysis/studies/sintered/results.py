"""All results of a set of runs: points with their statistics, fits of broken necks, critical velocities for growth."""

from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import Mapping

import numpy as np
import pandas

from ...measures.outcome import BOUNCING, STICKING, UNDECIDED
from ...runs.format import BROKEN_BONDS
from ...statistics import mean_and_error
from ...theory.chains import stretching_period
from ...theory.pair_constants import ICE, pair_constants
from . import fits, paper
from .growth import critical_velocity
from .measure import EARLY, LOST, PARTS, REACHED, TIMES

LAW = MappingProxyType({"cut": 1, "sliding_factor": 2.0})  # of ordinary contacts: section 3.2, eqs 10 to 12
MAIN = MappingProxyType({"planar": 1, "criticalRolling": 2e-10, "viscoelasticTime": 0.0})
# What tells points apart; every run of a point has another seed.
POINT = (
    *("planar", "criticalRolling", "viscoelasticTime", "cut", "sliding_factor"),
    *("growth_velocity", "neck", "velocity"),
)
IN_TIME = (*(f"left_{number}" for number in TIMES), *(f"part_{name}_{EARLY}" for name in PARTS))
MEANS = (
    "contacts",
    "initial_radius",
    "largest",
    "second",
    "fragments",
    "gyration_radius",
    "cut_per_grain",
    "cut_per_touching",
    "cut_energy",
    "by_rolling",
    "rolling_of_lost",
    "stretching_of_lost",
    *(f"part_{name}" for name in PARTS),
    *IN_TIME,
    *("loops_at_start", "loops", "loop_size", "new_loop_size"),
)


@dataclass(frozen=True)
class Point:
    """The runs of one parameter set: those of POINT as attributes, energy_ratio (NaN: unsintered), runs (their number),
    means {name: (mean, standard error or None)} of MEANS (by_rolling: over runs in which necks broke; cut_energy: N_cut E_sint
    over K(0); X_of_lost: fraction of all that was dissipated; X_N: after N periods, or at the end of runs in
    which nothing could meet or break any more before, None unless all have it),
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
class Results:
    """table (a row a run, measure.COLUMNS), other_sizes (number of runs left out of it: BCCA aggregates of another number of
    grains), points ([Point], sorted), fits ({(planar, T_vis): {selection of
    fits.SELECTIONS: fits.Fit}}), critical ({(planar, beta): growth.Critical or None} of BCCA aggregates without drag, for the
    paper's beta), both of the
    runs with xi_crit = 2 Angstrom and the law; law ({column: value} of ordinary contacts, LAW: S17's)."""

    table: pandas.DataFrame
    points: tuple
    fits: Mapping
    critical: Mapping
    other_sizes: int = 0
    law: Mapping = field(default_factory=lambda: LAW)

    def select(self, **values):
        """[Point] with these attributes, to a relative 2e-3 (velocities are printed so)."""
        return [p for p in self.points if all(same(getattr(p, name), value) for name, value in values.items())]

    def main(self, **values):
        """[Point] in the plane, xi_crit = 2 Angstrom, without drag, of the law, and with these attributes."""
        return self.select(**{**MAIN, **self.law, **values})

    def runs(self, **values):
        """The rows of `table` in the plane, xi_crit = 2 Angstrom, without drag, of the law, and with these values in their
        columns."""
        return runs_with(self.table, **{**MAIN, **self.law, **values})

    def sintered(self, **values):
        """The rows of `table` of sintered aggregates, without drag, of the law, and with these values in their columns."""
        return runs_with(self.table[self.table.neck > 0], **{**self.law, "viscoelasticTime": 0.0, **values})

    def paired(self, column, first, second):
        """Values (n,) of a column in the BCCA runs() with `first` {column: value} less those with `second`, seed by seed: n seeds
        that both have."""
        chosen = [self.runs(**{"growth_velocity": 0.0, **values}) for values in (first, second)]
        values = [runs.groupby("packing_seed")[column].mean() for runs in chosen]
        return (values[0] - values[1]).dropna().to_numpy()


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
    everything, table = len(table), _of_one_size(table)
    table = table.assign(broken=table[list(BROKEN_BONDS)].sum(axis=1))
    table = _with_ended(table)
    lost = sum(table[f"part_{name}"] for name in LOST)
    new_loops = table.loops - table.loops_at_start
    table = table.assign(
        cut_per_grain=table.broken / table.grains,
        cut_per_touching=table.broken / table.touching.where(table.touching > 0),
        # K(0) is half an E_k = m V_c^2/4 a grain
        cut_energy=2 * table.broken / table.grains / table.energy_ratio,
        rolling_of_lost=table.part_rolling_friction / lost,
        stretching_of_lost=table.part_stretching / lost,
        by_rolling=table.brokenByRolling / table.broken.where(table.broken > 0),
        loop_size=table.loop_grains / table.loops.where(table.loops > 0),
        new_loop_size=(table.loop_grains - table.loop_grains_at_start) / new_loops.where(new_loops > 0),
    )
    keys = [table[name].map(lambda value: float(f"{value:.6g}")) for name in POINT]
    points = tuple(_point(key, runs) for key, runs in table.groupby(keys))
    found = Results(table, points, fits={}, critical={}, other_sizes=everything - len(table))
    return of_law(found)


def of_law(results, **law):
    """The same Results with another law as the main one: LAW with these columns changed, and fits and critical velocities of it."""
    law = MappingProxyType({**LAW, **law})
    found = replace(results, law=law)
    laws, critical = {}, {}
    for planar, drag in sorted({(p.planar, p.viscoelasticTime) for p in found.points}):
        runs = found.runs(planar=planar, viscoelasticTime=drag)
        laws[planar, drag] = fits.fit_all(runs[runs.neck > 0], POINT)
    for planar, neck in sorted(
        {(p.planar, p.neck) for p in found.points if p.neck in paper.CRITICAL_VELOCITIES}, reverse=True
    ):
        critical[planar, neck] = critical_velocity(found.runs(planar=planar, neck=neck, growth_velocity=0.0))
    return replace(found, fits=MappingProxyType(laws), critical=MappingProxyType(critical))


def _of_one_size(table):
    """The runs of BCCA aggregates of S17's number of grains, or of the commonest where none has that; those of compacted
    aggregates, which differ in size, all."""
    compacted = table.growth_velocity > 0
    sizes = table.grains[~compacted]
    own = 2 * paper.GRAINS
    if len(sizes) and not (sizes == own).any():
        own = sizes.mode().iloc[0]
    return table[compacted | (table.grains == own)]


def _with_ended(table):
    """The table with the end's energies at the times that come after the end of runs in which nothing could meet or break any more."""
    filled = {}
    period = table.grain_radius.map(lambda radius: stretching_period(pair_constants(ICE, radius)))
    for number in TIMES:
        over = table.ended_by & (table.time < REACHED * number * period)
        columns = {f"left_{number}": table.part_kinetic + table.part_elastic}
        if number == EARLY:
            columns.update({f"part_{name}_{EARLY}": table[f"part_{name}"] for name in PARTS})
        filled.update({name: table[name].where(~over, last) for name, last in columns.items()})
    return table.assign(**filled)


def _point(key, runs):
    means = {}
    for name in MEANS:
        values = runs[name].to_numpy(dtype=float)
        known = values[np.isfinite(values)]
        enough = len(known) == len(values) if name in IN_TIME else len(known)
        means[name] = mean_and_error(known) if enough else None
    return Point(
        *(int(v) if n in ("planar", "cut") else v for n, v in zip(POINT, key)),
        float(runs.energy_ratio.iloc[0]),
        len(runs),
        MappingProxyType(means),
        MappingProxyType(runs.outcome.value_counts().to_dict()),
        int((runs.largest > 0.5).sum()),
    )
