"""Yield stress and E* of aggregates from delta_max and tau_max against velocity (A24 section 4.3.3).

Weighted least squares over all runs of a filling at the sizes that have several velocities. The weight of a
run is 1/s^2, with s the standard deviation of d_max (of t_max) over the seeds of its point, smoothed over the
velocities of that size (statistics.smoothed_scatter); `raw` takes each point's own s instead, where it has three
seeds or more. A24 does not say what its weights are: these are our choice.

The same pairs of aggregates recur at all velocities, and d_max and t_max of a run go together, so that chi square has far
fewer degrees of freedom than numbers: what it should be is told by resampled pairs that obey the model."""

from dataclasses import dataclass

import numpy as np

from ...statistics import percentile_error
from ...theory.andrews import (
    Spheres,
    elastic_compression,
    elastic_time,
    largest_compression,
    plastic_compression,
    plastic_time,
    stress_if_rigid,
    time_of_largest_compression,
    young_if_elastic,
)
from .moduli_search import ModuliSearch

FEWEST_VELOCITIES = 3


@dataclass(frozen=True)
class VelocityFit:
    """values (sigma_plastic, E*) [Pa], inf where spheres that never yield (rigid ones) fit as well; their
    errors [Pa], None where too many resamples have no bound; resamples (B, 2); correlation of the logarithms;
    chi_square of the points' means, what pairs that obey the model would give on average (expected), and the chance of as
    much or more; radii [grain radii] and number of runs that
    were fitted; offset (delta_offset) [m] used, and where it is from; unbounded: the fraction of resamples
    in which a modulus is inf. All None where `reason` says why nothing was fitted."""

    filling: float
    values: tuple = (None, None)
    errors: tuple = (None, None)
    resamples: np.ndarray = None
    correlation: float = None
    chi_square: float = None
    expected: float = None
    chance: float = None
    radii: tuple = ()
    runs: int = 0
    offset: float = None
    offset_source: str = None
    unbounded: float = 0.0
    reason: str = None


def reduced_radius(radius, offset):
    """R* = (R + delta_offset)/2: A24 eqs 15, 16."""
    return 0.5 * (radius + offset)


def effective(d_max, t_max, velocity, offset, grain_radius):
    """(delta_max, tau_max): d_max + 2 delta_offset, and t_max less the time until contact, (2 r - 2
    delta_offset)/v (A24 eqs 17, 22; separation of the spheres at the start: 2 r)."""
    return d_max + 2.0 * offset, t_max - 2.0 * (grain_radius - offset) / velocity


def predicted(velocity, radius, grain_radius, density, sigma, young, offset):
    """(d_max [m], t_max [s]) of Andrews's spheres at velocity [m/s] and radius [m] of the aggregates, for density [kg/m^3],
    moduli [Pa] (inf: none) and delta_offset [m]; arrays that broadcast."""
    spheres = Spheres(reduced_radius(radius, offset), density, sigma, young)
    if np.all(np.isinf(young)):
        delta, tau = plastic_compression(velocity, spheres), plastic_time(velocity, spheres)
    elif np.all(np.isinf(sigma)):
        delta, tau = elastic_compression(velocity, spheres), elastic_time(velocity, spheres)
    else:
        delta, tau = largest_compression(velocity, spheres), time_of_largest_compression(velocity, spheres)
    return delta - 2.0 * offset, tau + 2.0 * (grain_radius - offset) / velocity


def fitted_sizes(points):
    """Mask (K,) of the points (one filling) whose size has FEWEST_VELOCITIES or more."""
    radii, counts = np.unique(points.radius, return_counts=True)
    return np.isin(points.radius, radii[counts >= FEWEST_VELOCITIES])


def fit_velocities(points, resampled, offset, resampled_offset, source, grain_radius, grain_density, raw=False):
    """VelocityFit of the points (one filling); resampled: (d_max, t_max), each (B, K); offset [m] with its
    resamples (B,), or a number for all of them; source: where the offset is from (str)."""
    filling = float(points.filling[0])
    mask = fitted_sizes(points)
    if not mask.any():
        most = np.unique(points.radius, return_counts=True)[1].max()
        return VelocityFit(
            filling, reason=f"no size at filling {filling:g} has {FEWEST_VELOCITIES} velocities " f"(at most {most})"
        )
    used = points.chosen(mask)
    scatter = [
        _scatter(used, own, smooth, raw)
        for own, smooth in ((used.raw_d_scatter, used.d_scatter), (used.raw_t_scatter, used.t_scatter))
    ]
    if not np.all(np.isfinite(scatter)):
        return VelocityFit(
            filling, reason=f"a size at filling {filling:g} has no point with two seeds: no " "scatter, so no weights"
        )
    errors = [s / np.sqrt(used.number) for s in scatter]
    search = ModuliSearch(used.velocity, filling * grain_density)

    def fit(d_max, t_max, shift):
        delta, tau = effective(d_max, t_max, used.velocity, shift, grain_radius)
        return search.best(delta, tau, *errors, np.broadcast_to(reduced_radius(used.radius, shift), delta.shape))

    moduli, chi_square = (result[0] for result in fit(used.d_max[None], used.t_max[None], offset))
    shifts = np.broadcast_to(resampled_offset, len(resampled[0]))
    ends, _ = fit(resampled[0][:, mask], resampled[1][:, mask], shifts[:, None])
    null = fit(
        *_obeying(
            used, (resampled[0][:, mask], resampled[1][:, mask]), moduli, offset, filling * grain_density, grain_radius
        ),
        offset,
    )[1]
    sane = ends[np.all(np.isfinite(ends), axis=1)]
    return VelocityFit(
        filling=filling,
        values=tuple(map(float, moduli)),
        resamples=ends,
        chi_square=float(chi_square),
        errors=tuple(percentile_error(ends[:, i]) for i in (0, 1)),
        expected=float(null.mean()),
        chance=float(np.mean(null >= chi_square)),
        correlation=float(np.corrcoef(np.log(sane.T))[0, 1]) if len(sane) > 2 else None,
        radii=tuple(np.unique(used.radius) / grain_radius),
        runs=int(used.number.sum()),
        offset=float(offset),
        offset_source=source,
        unbounded=1.0 - len(sane) / len(ends),
    )


def _obeying(points, resampled, moduli, offset, density, grain_radius):
    """(d_max, t_max) (B, K) [m, s] that obey the model with these moduli and scatter as the resampled pairs do."""
    model = predicted(points.velocity, points.radius, grain_radius, density, *moduli, offset)
    means = points.d_max, points.t_max
    return tuple(draws - mean + obeyed for draws, mean, obeyed in zip(resampled, means, model))


def _scatter(points, own, smooth, raw):
    return np.where((points.number >= 3) & (own > 0), own, smooth) if raw else smooth


def moduli_errors_of_design(moduli, velocity, radius, density, d_error, t_error):
    """Standard errors [Pa] of (sigma, E*) that a weighted fit has to first order when the means d_max [m] and t_max
    [s] (K,) at velocities [m/s] and reduced radii [m] (K,) have the errors d_error, t_error (K,), independent of
    each other."""

    def model(log_moduli):
        spheres = Spheres(radius, density, *np.exp(log_moduli))
        return np.concatenate(
            [largest_compression(velocity, spheres) / d_error, time_of_largest_compression(velocity, spheres) / t_error]
        )

    x, step = np.log(moduli), 1e-5
    slope = np.stack([(model(x + step * unit) - model(x - step * unit)) / (2.0 * step) for unit in np.eye(2)], axis=1)
    return np.asarray(moduli) * np.sqrt(np.diag(np.linalg.inv(slope.T @ slope)))


def degenerate_curve(ratio, velocity, density, samples=300):
    """(sigma, E*) [Pa] (samples,) of all elastoplastic pairs with delta_max/R* = ratio at velocity [m/s], and
    sigma_elastic from which nothing yields, with E* of eq 30: A24 Fig. 10. sigma goes from the rigid-plastic
    limit (where E* = inf, left out) to sigma_elastic."""
    young = young_if_elastic(ratio, velocity, density)
    elastic_from = 2.0 * young / np.pi * np.sqrt(ratio)
    least = stress_if_rigid(ratio, velocity, density)
    sigma = least + (elastic_from - least) * np.linspace(0.0, 1.0, samples + 1)[1:] ** 2
    # 28 with 27 and 29 is a square equation in delta_crit/R*; the smaller root is the one below delta_max.
    rest = 0.5 * ratio**2 * (1.0 - least / sigma)
    critical = (ratio / 3.0 - np.sqrt(np.maximum(ratio**2 / 9.0 - 0.4 * rest, 0.0))) / 0.2
    return sigma, np.pi * sigma / (2.0 * np.sqrt(critical)), float(elastic_from), float(young)
