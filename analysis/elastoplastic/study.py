"""All results of a set of runs."""

from dataclasses import dataclass
from typing import Mapping

import numpy as np

from . import paper
from .aggregate_constants import bulk_modulus, cpe_coordination, poisson_ratio
from .bounce import bounces
from .points import Points, percentile_error, points_of, resampled
from .size_fit import SizeFit, fit_sizes, size_velocity
from .start_offset import common_slope, correct
from .velocity_fit import VelocityFit, fit_velocities

# What d_max may be taken for, of a row; the first is A24's.
DEFINITIONS = {
    "as A24 defines it": lambda row: row.d_max,
    "less d(0) + 2 r": lambda row: row.d_max - row.offset,
    "by each aggregate's own grains": lambda row: row.label_d_max,
}


@dataclass(frozen=True)
class Filling:
    """Results at one filling factor: points with resamples (d_max, t_max), size_fits (SizeFit by
    DEFINITIONS), offset [m] and offset_source, velocity_fits (VelocityFit by what is special about it; ''
    comes first), slope (of d_max on the start's offset, its error), corrections ({index of point: Correction}
    in grain radii), coordination (mean inside the aggregates, its error), bulk_modulus [Pa] of eq 41, poisson
    (value, error), grain_radius [m]."""

    filling: float
    points: Points
    resamples: tuple
    size_fits: Mapping
    offset: float
    offset_source: str
    velocity_fits: Mapping
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
class Study:
    """rows (measure.Row), by_filling ({filling: Filling}), bounces (list of bounce.Bounce), grain_radius [m],
    grain_density [kg/m^3], overlap [m], pull_off_force [N]."""

    rows: tuple
    by_filling: Mapping
    bounces: tuple
    grain_radius: float
    grain_density: float
    overlap: float
    pull_off_force: float


def make_study(rows):
    """Study of rows (measure.Row), at least one; all of one material."""
    first = rows[0]
    fillings = sorted({round(row.filling, 6) for row in rows}, reverse=True)
    by_filling = {
        filling: _filling(filling, [r for r in rows if round(r.filling, 6) == filling]) for filling in fillings
    }
    return Study(
        tuple(rows),
        by_filling,
        tuple(bounces(rows)),
        first.grain_radius,
        first.grain_density,
        first.overlap,
        first.pull_off_force,
    )


def _filling(filling, rows):
    first = rows[0]
    r = first.grain_radius
    size_fits = {}
    for name, d_max in DEFINITIONS.items():
        points = points_of(rows, d_max)
        draws = resampled(points)
        size_fits[name] = fit_sizes(points, draws[0], r, size_velocity(points, paper.VELOCITY))
        if name == next(iter(DEFINITIONS)):
            own_points, own_draws = points, draws
    offset, offset_draws, source = _offset(filling, next(iter(size_fits.values())), r)
    offsets = offset, offset_draws, source
    fits = {
        "": _velocity_fit(own_points, own_draws, *offsets, first),
        "weights unsmoothed": _velocity_fit(own_points, own_draws, *offsets, first, raw=True),
    }
    if filling in paper.OFFSET and next(iter(size_fits.values())).reason is None:
        theirs = paper.OFFSET[filling] * r
        fits["A24's delta_offset"] = _velocity_fit(own_points, own_draws, theirs, theirs, "A24's", first)
    slope, corrections = _corrections(own_points, rows)
    inner = np.array([row.inner_coordination for row in rows])
    modulus = float(
        bulk_modulus(filling, cpe_coordination(filling, r, first.overlap), r, first.overlap, first.pull_off_force)
    )
    return Filling(
        filling,
        own_points,
        own_draws,
        size_fits,
        offset,
        source,
        fits,
        slope,
        corrections,
        (float(inner.mean()), float(inner.std(ddof=1) / np.sqrt(len(inner))) if len(inner) > 1 else None),
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
        return offset, offset, "A24's, for want of sizes here"
    return None, None, None


def _velocity_fit(points, draws, offset, offset_draws, source, row, raw=False):
    if offset is None:
        filling = float(points.filling[0])
        return VelocityFit(
            filling, reason=f"no delta_offset at filling {filling:g}: neither two sizes, nor one of " "A24's"
        )
    return fit_velocities(points, draws, offset, offset_draws, source, row.grain_radius, row.grain_density, raw)


def _corrections(points, rows):
    unit = rows[0].grain_radius
    offsets = points_of(rows, lambda row: row.offset)
    groups = [(o[0] / unit, d[0] / unit) for o, d in zip(offsets.samples, points.samples)]
    slope = common_slope([group for group in groups if len(group[0]) > 1])
    return slope, {k: correct(*group, slope) for k, group in enumerate(groups)}


def _poisson(fit, modulus):
    if fit.reason or not np.isfinite(fit.values[1]):
        return None, None
    # An E* without bound is one beyond every nu_agg: eq 42 goes to -1 there.
    young = np.minimum(fit.resamples[:, 1], 1e6 * modulus)
    return float(poisson_ratio(fit.values[1], modulus)), percentile_error(poisson_ratio(young, modulus))
