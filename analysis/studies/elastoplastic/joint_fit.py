"""Yield stress, E* and delta_offset together, from d_max and t_max of all sizes and velocities of a filling.

A24 takes delta_offset from d_max against size at one velocity (eqs 14-18) and then sigma and E* from two sizes against
velocity. What E* comes out hangs on that offset: here all three are free, and what is compared is what was measured,

    d_max = delta_max(v, R*) - 2 delta_offset,   t_max = tau_max(v, R*) + 2 (r - delta_offset)/v,   R* = (R + delta_offset)/2.

The weight of a run is 1/s^2 (our choice; A24 doesn't give its own), with s the standard deviation over the seeds, a power
of the velocity that is common to all sizes. Errors, limits and chances are from resampled pairs of aggregates."""

from dataclasses import dataclass

import numpy as np

from ...statistics import percentile_error, smoothed_scatter
from .levenberg import least_squares
from .moduli_search import NO_WORSE, ModuliSearch
from .velocity_fit import FEWEST_VELOCITIES, predicted

# delta_offset [grain radii]: the surface lies between that of the centres and that of the grains, and some more.
_OFFSETS = np.linspace(-0.6, 0.9, 16)
_LARGEST_OFFSET = 1.5
_LEAST, _MOST = np.log(1e3), np.log(1e13)  # of the moduli [Pa]


@dataclass(frozen=True)
class JointFit:
    """values (sigma [Pa], E* [Pa], delta_offset [grain radii]), a modulus inf where spheres without it fit as well; errors of
    the same, None where too many resamples have no bound; limits: ((low, high) of each) at 95 %, inf without bound; resamples
    (B, 3); unbounded: fraction of resamples in which a modulus is inf; chi_square with what pairs that obey the model
    would give on average (expected) and the chance of as much or more; runs, pairs (their numbers), radii [grain radii],
    velocities (number); paper_excess: how much larger chi square is at A24's three values, with its chance, young_excess and young_chance: the same with
    A24's E* alone, sigma and delta_offset free (None: it has
    none). All None where `reason` says why nothing was fitted."""

    values: tuple = (None, None, None)
    errors: tuple = (None, None, None)
    limits: tuple = None
    resamples: np.ndarray = None
    unbounded: tuple = (0.0, 0.0)
    chi_square: float = None
    expected: float = None
    chance: float = None
    runs: int = 0
    pairs: int = 0
    radii: tuple = ()
    velocities: int = 0
    paper_excess: float = None
    paper_chance: float = None
    young_excess: float = None
    young_chance: float = None
    reason: str = None


class JointSearch:
    """The best (sigma, E*, delta_offset) at fixed velocities [m/s], radii of aggregates [m] (K,) and errors of d_max [m] and
    t_max [s] (K,); density [kg/m^3] of the aggregates, grain_radius [m]."""

    def __init__(self, velocity, radius, d_error, t_error, density, grain_radius):
        self.velocity, self.radius, self.density, self.unit = velocity, radius, density, grain_radius
        self.error = np.concatenate([d_error, t_error])

    def model(self, sigma, young, offset):
        """d_max and t_max (B, 2 K) over their errors for moduli [Pa] and offset [grain radii] (B,)."""
        sigma, young, offset = (np.asarray(a, dtype=float)[:, None] for a in (sigma, young, offset))
        both = predicted(self.velocity, self.radius, self.unit, self.density, sigma, young, offset * self.unit)
        shape = (len(offset), len(self.velocity))
        return np.concatenate([np.broadcast_to(each, shape) for each in both], axis=1) / self.error

    def start(self, d, t):
        """(sigma, E*, offset) (3,) near the best of one set d [m], t [s] (K,), moduli finite."""
        search, found = ModuliSearch(self.velocity, self.density), []
        for offset in _OFFSETS * self.unit:
            delta, tau = d + 2.0 * offset, t - 2.0 * (self.unit - offset) / self.velocity
            half, k = 0.5 * (self.radius + offset), len(d)
            moduli, chi_square = search.best(delta[None], tau[None], self.error[:k], self.error[k:], half[None])
            found.append((float(chi_square[0]), *moduli[0], offset / self.unit))
        _, sigma, young, offset = min(found)
        return np.array([min(sigma, 30.0 * young), min(young, 30.0 * sigma), offset])

    def best(self, d, t, start):
        """((sigma, E*, offset) (B, 3), chi square (B,)) of B sets d [m], t [s] (B, K), from a start (3,). A modulus is inf where
        spheres without it fit as well."""
        data = np.concatenate([d, t], axis=1) / self.error
        begin = np.tile([np.log(start[0]), np.log(start[1]), start[2]], (len(data), 1))
        low, high = np.array([_LEAST, _LEAST, -_LARGEST_OFFSET]), np.array([_MOST, _MOST, _LARGEST_OFFSET])

        def residuals(x):
            return self.model(np.exp(x[:, 0]), np.exp(x[:, 1]), x[:, 2]) - data

        x, chi_square = least_squares(residuals, begin, low, high)
        values = np.column_stack([np.exp(x[:, :2]), x[:, 2]])
        for absent in (0, 1):
            limit, limit_chi = self._without(absent, data, begin, low, high)
            take = limit_chi <= chi_square + NO_WORSE
            values[take] = limit[take]
            chi_square = np.where(take, limit_chi, chi_square)
        return values, chi_square

    def at_young(self, d, t, young, start):
        """Chi square (B,) of B sets d [m], t [s] (B, K) with E* [Pa] held at one value (inf: none), sigma and offset free."""
        data = np.concatenate([d, t], axis=1) / self.error
        begin = np.tile([np.log(start[0]), np.log(start[1]), start[2]], (len(data), 1))
        low, high = np.array([_LEAST, _LEAST, -_LARGEST_OFFSET]), np.array([_MOST, _MOST, _LARGEST_OFFSET])
        return self._holding(1, young, data, begin, low, high)[1]

    def _without(self, absent, data, begin, low, high):
        """The same without one modulus (its number)."""
        return self._holding(absent, np.inf, data, begin, low, high)

    def _holding(self, held, value, data, begin, low, high):
        """The same with one modulus (its number) held at a value [Pa]."""
        other = 1 - held

        def split(x):
            moduli = [None, None]
            moduli[held], moduli[other] = np.full(len(x), float(value)), np.exp(x[:, 0])
            return (*moduli, x[:, 1])

        keep = [other, 2]
        x, chi_square = least_squares(lambda x: self.model(*split(x)) - data, begin[:, keep], low[keep], high[keep])
        return np.column_stack(split(x)), chi_square


def joint_fit(points, resampled, grain_radius, grain_density, papers=None):
    """JointFit of points.Points of one filling; resampled: (d_max, t_max), each (B, K); papers: A24's (sigma [Pa], E* [Pa],
    delta_offset [grain radii]), None without."""
    filling = float(points.filling[0])
    if np.unique(points.velocity).size < FEWEST_VELOCITIES or np.unique(points.radius).size < 2:
        return JointFit(
            reason=f"sigma, E* and delta_offset together at filling {filling:g} need two sizes and {FEWEST_VELOCITIES} velocities"
        )
    scatter = [
        smoothed_scatter(points.velocity, own, points.number) for own in (points.raw_d_scatter, points.raw_t_scatter)
    ]
    if not np.all(np.isfinite(scatter)) or not np.all(np.array(scatter) > 0):
        return JointFit(
            reason=f"sigma, E* and delta_offset together at filling {filling:g}: no point with two seeds, so no weights"
        )
    errors = [s / np.sqrt(points.number) for s in scatter]
    search = JointSearch(points.velocity, points.radius, *errors, filling * grain_density, grain_radius)
    start = search.start(points.d_max, points.t_max)
    (values,), (chi_square,) = search.best(points.d_max[None], points.t_max[None], start)
    start = np.where(np.isfinite(values), values, start)
    draws, _ = search.best(*resampled, start)
    obeying = _obeying(search, points, resampled, values)
    _, null = search.best(*obeying, start)
    excess, chance = _excess(search, points, obeying, values, null, chi_square, papers)
    young_excess, young_chance = _young_excess(search, points, obeying, values, start, null, chi_square, papers)
    names = {(round(r, 12), seed) for r, seeds in zip(points.radius, points.seeds) for seed in seeds}
    return JointFit(
        values=tuple(map(float, values)),
        errors=tuple(percentile_error(draws[:, i]) for i in range(3)),
        limits=tuple(tuple(map(float, np.quantile(draws[:, i], [0.025, 0.975], method="nearest"))) for i in range(3)),
        resamples=draws,
        unbounded=tuple(float(np.mean(np.isinf(draws[:, i]))) for i in (0, 1)),
        chi_square=float(chi_square),
        expected=float(null.mean()),
        chance=float(np.mean(null >= chi_square)),
        runs=int(points.number.sum()),
        pairs=len(names),
        radii=tuple(np.unique(points.radius) / grain_radius),
        velocities=int(np.unique(points.velocity).size),
        paper_excess=excess,
        paper_chance=chance,
        young_excess=young_excess,
        young_chance=young_chance,
    )


def _obeying(search, points, resampled, values):
    """Data (B, K) that obey the model with these values and scatter as the resampled pairs do."""
    model = search.model(*(np.array([value]) for value in values))[0] * search.error
    k = len(points)
    return resampled[0] - points.d_max + model[:k], resampled[1] - points.t_max + model[k:]


def _excess(search, points, obeying, values, null, chi_square, papers):
    """(chi square at A24's values less the smallest, chance of as much at the true values); Nones without values."""
    if papers is None or None in papers:
        return None, None

    def at(d, t, parameters):
        data = np.concatenate([d, t], axis=1) / search.error
        return np.sum((search.model(*(np.array([p]) for p in parameters)) - data) ** 2, axis=1)

    excess = float(at(points.d_max[None], points.t_max[None], papers)[0] - chi_square)
    return excess, float(np.mean(at(*obeying, values) - null >= excess))


def _young_excess(search, points, obeying, values, start, null, chi_square, papers):
    """The same with A24's E* alone: the chance is that at the true E*."""
    if papers is None or papers[1] is None:
        return None, None
    excess = float(search.at_young(points.d_max[None], points.t_max[None], papers[1], start)[0] - chi_square)
    return excess, float(np.mean(search.at_young(*obeying, values[1], start) - null >= excess))
