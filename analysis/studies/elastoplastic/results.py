"""All results of a set of runs."""

from dataclasses import dataclass
from typing import Mapping

import numpy as np
import pandas

from ...progress import progress
from ...statistics import mean_and_error, percentile_error
from ...theory.aggregates import bulk_modulus, cpe_coordination, poisson_ratio
from ..collision_points import collision_point
from . import paper
from .joint_fit import JointFit, joint_fit
from .points import Points, parameter_sets, points_of, resampled
from .size_fit import SizeFit, adjusted_difference, fit_sizes, joint_difference, size_velocity
from .start_offset import common_slope, correct
from .velocity_fit import VelocityFit, fit_velocities
from .zone_fit import COVARIATES, adjust, fit_slope

# What d_max may be taken for, of a table of runs; the first is A24's.
DEFINITIONS = {
    "as A24 defines it": lambda table: table.d_max,
    "less d(0) + 2 r": lambda table: table.d_max - table.offset,
    "by each aggregate's own grains": lambda table: table.label_d_max,
}

# Columns that are the same for all runs.
# A24 gives neither errors nor the list of its sizes; its line is taken to have ten seeds at each of these.
PAPER_RADII = (40, 50, 60, 70, 80)

CONSTANTS = ("grain_radius", "grain_density", "overlap", "pull_off_force")


@dataclass(frozen=True)
class Filling:
    """Results at one filling factor: factor, points with resamples (d_max, t_max), size_fits (SizeFit by
    DEFINITIONS), offset [m] and offset_source, velocity_fits (VelocityFit by what is special about it; ''
    comes first), joint (JointFit), differences ({definition: size_fit.JointDifference from A24's line, None without}),
    covariates ({zone_fit.COVARIATES: Slope of d_max, None without}), adjusted ([zone_fit.Adjusted] of d_max by size),
    zone_times (the same two of t_max: Slope on the filling of the zones, [Adjusted]; None and [] without), slope (of d_max on
    the start's offset at the velocity of the size fit, its error), corrections ({index of point there: Correction} in grain
    radii), coordination (mean inside the aggregates, its error), bulk_modulus [Pa] of eq 41, poisson
    (value, error), grain_radius [m]."""

    factor: float
    points: Points
    resamples: tuple
    size_fits: Mapping
    offset: float
    offset_source: str
    velocity_fits: Mapping
    joint: JointFit
    differences: Mapping
    covariates: Mapping
    adjusted: list
    zone_times: tuple
    slope: tuple
    corrections: Mapping
    coordination: tuple
    bulk_modulus: float
    poisson: tuple
    grain_radius: float

    @property
    def size_fit(self) -> SizeFit:
        return next(iter(self.size_fits.values()))

    @property
    def velocity_fit(self) -> VelocityFit:
        return self.velocity_fits[""]


@dataclass(frozen=True)
class Results:
    """table (a row a run, measure.COLUMNS), by_filling ({filling: Filling}), bounces (CollisionPoint of each filling, radius [grain radii], velocity),
    grain_radius [m], grain_density [kg/m^3], overlap [m], pull_off_force [N]."""

    table: pandas.DataFrame
    by_filling: Mapping
    bounces: tuple
    grain_radius: float
    grain_density: float
    overlap: float
    pull_off_force: float

    def runs(self, filling, radius=None, velocity=None):
        """Table of the runs at a filling factor, and at a radius [m] and a velocity [m/s] where they are given."""
        table = self.table[self.table.filling.round(6) == filling]
        for name, value in (("radius", radius), ("velocity", velocity)):
            if value is not None:
                table = table[(table[name] / value - 1.0).abs() < 1e-6]
        return table


def make_results(table):
    """Results of a table of runs (measure.COLUMNS), at least one; all of one material."""
    fillings = table.filling.round(6)
    by_filling = {
        float(filling): _filling(float(filling), table[fillings == filling])
        for filling in progress(sorted(fillings.unique(), reverse=True), "fitting")
    }
    constants = {name: float(table[name].iloc[0]) for name in CONSTANTS}
    return Results(table, by_filling, tuple(_bounces(table)), **constants)


def _bounces(table):
    for _, runs in parameter_sets(table):
        first = runs.iloc[0]
        radius = float(first.radius / first.grain_radius)
        yield collision_point(
            {"filling": float(first.filling), "radius": radius, "velocity": float(first.velocity)}, runs
        )


def _filling(filling, table):
    r, density, overlap, force = (float(table[name].iloc[0]) for name in CONSTANTS)
    points = {name: points_of(table, d_max) for name, d_max in DEFINITIONS.items()}
    draws = {name: resampled(each) for name, each in points.items()}
    size_fits = {
        name: fit_sizes(each, draws[name][0], r, size_velocity(each, paper.VELOCITY)) for name, each in points.items()
    }
    own = next(iter(DEFINITIONS))
    offset = _offset(filling, size_fits[own], r)
    fits = _velocity_fits(points[own], draws[own], offset, size_fits[own], r, density)
    velocity = size_fits[own].velocity
    at_velocity = table[(table.velocity / velocity - 1.0).abs() < 1e-6]
    slope, corrections = _corrections(points[own], table, velocity)
    covariates, adjusted = _covariates(at_velocity)
    modulus = float(bulk_modulus(filling, cpe_coordination(filling, r, overlap), r, overlap, force))
    return Filling(
        filling,
        points[own],
        draws[own],
        size_fits,
        offset[0],
        offset[2],
        fits,
        joint_fit(points[own], draws[own], r, density, _papers_values(filling)),
        _differences(filling, size_fits, points, at_velocity, covariates, r),
        covariates,
        adjusted,
        _zone_times(at_velocity),
        slope,
        corrections,
        # A pair has the same packings at every velocity.
        mean_and_error(table.drop_duplicates(["radius", "seed"]).inner_coordination),
        modulus,
        _poisson(fits[""], modulus),
        r,
    )


def _offset(filling, fit, grain_radius):
    """(delta_offset [m], its resamples, where it is from); Nones where there is none."""
    if fit.reason is None:
        return fit.values["offset"] * grain_radius, fit.resamples["offset"] * grain_radius, "fitted to the sizes here"
    if filling in paper.OFFSET:
        offset = paper.OFFSET[filling] * grain_radius
        return offset, offset, "A24's, since one size gives none"
    return None, None, None


def _velocity_fits(points, draws, offset, size_fit, grain_radius, grain_density):
    filling = float(points.filling[0])
    if offset[0] is None:
        reason = f"no delta_offset at filling {filling:g}: neither two sizes, nor one of A24's"
        return {name: VelocityFit(filling, reason=reason) for name in ("", "weights unsmoothed")}
    scale = grain_radius, grain_density
    fits = {
        "": fit_velocities(points, draws, *offset, *scale),
        "weights unsmoothed": fit_velocities(points, draws, *offset, *scale, raw=True),
    }
    if filling in paper.OFFSET and size_fit.reason is None:
        theirs = paper.OFFSET[filling] * grain_radius
        fits["A24's delta_offset"] = fit_velocities(points, draws, theirs, theirs, "A24's", *scale)
    return fits


def _papers_values(filling):
    values = paper.YIELD_STRESS.get(filling), paper.YOUNG.get(filling), paper.OFFSET.get(filling)
    return None if None in values else values


def _differences(filling, fits, points, table, covariates, grain_radius):
    """differences of Filling; the last one adjusted for the filling of the zones, from the table at the size fit's velocity."""
    own, zone = next(iter(fits.values())), next(iter(covariates.values()))
    line = paper.line(filling)
    if own.reason is not None or line is None or abs(own.velocity / paper.VELOCITY - 1.0) > 1e-3:
        return {}
    design = PAPER_RADII, paper.SEEDS
    found = {name: joint_difference(fit, points[name], line, *design, grain_radius) for name, fit in fits.items()}
    if zone is not None:
        radius, d_max = (table[name].to_numpy() / grain_radius for name in ("radius", "d_max"))
        away = table.zone_filling.to_numpy() - 1.0
        found["adjusted for the filling of the zones"] = adjusted_difference(
            radius, d_max, away, line, *design, zone.total
        )
    return found


def _covariates(table):
    """(covariates, adjusted) of Filling from the runs at one velocity."""
    slopes = {name: fit_slope(table, column) for name, column in COVARIATES.items()}
    zone = next(iter(slopes.values()))
    return slopes, [] if zone is None else adjust(table, zone)


def _zone_times(table):
    """zone_times of Filling from the runs at one velocity."""
    slope = fit_slope(table, of="t_max")
    return slope, [] if slope is None else adjust(table, slope, of="t_max")


def _corrections(points, table, velocity):
    """Of the points at one velocity, where each pair of aggregates occurs once."""
    unit = table.grain_radius.iloc[0]
    offsets = points_of(table, lambda runs: runs.offset)
    groups = {
        k: (offsets.samples[k][0] / unit, points.samples[k][0] / unit, [f"{k} {seed}" for seed in points.seeds[k]])
        for k in np.flatnonzero(points.velocity == velocity)
    }
    slope = common_slope([group for group in groups.values() if len(group[0]) > 1])
    return slope, {k: correct(*group[:2], slope) for k, group in groups.items()}


def _poisson(fit, modulus):
    if fit.reason or not np.isfinite(fit.values[1]):
        return None, None
    # An E* without bound is one beyond every nu_agg: eq 42 goes to -1 there.
    young = np.minimum(fit.resamples[:, 1], 1e6 * modulus)
    return float(poisson_ratio(fit.values[1], modulus)), percentile_error(poisson_ratio(young, modulus))
