"""Andrews's elastoplastic spheres in place of aggregates: what they predict of d_max and t_max, and the straight lines and moduli that are
fitted to collisions (A24 sections 4.2 and 4.3).

    d_max = delta_max(v, R*) - 2 delta_offset,   t_max = tau_max(v, R*) + 2 (r - delta_offset)/v,   R* = (R + delta_offset)/2

Lengths in grain radii. E* enters as its inverse, the compliance: it is finite, 0 for rigid-plastic spheres, where E* has no bound."""

from dataclasses import dataclass

import numpy as np

from ...statistics import smoothed_scatter
from ...theory import andrews
from ..estimate import ROUNDING
from ..runs import alike
from .levenberg import least_squares

VELOCITY = 10**0.5  # m/s, at which A24 compares sizes; printed as 3.2 m/s
FEWEST_VELOCITIES = 3  # of a size that A24's way takes the moduli from


@dataclass(frozen=True)
class Aggregates:
    """Andrews's spheres in place of aggregates: stress: sigma_plastic [Pa]; compliance: 1/E* [1/Pa]; offset: delta_offset [grain radii];
    density of an aggregate [kg/m^3]; grain_radius [m]. Floats, or arrays that broadcast."""

    stress: float
    compliance: float
    offset: float
    density: float
    grain_radius: float

    def at(self, radius, velocity):
        """(d_max [grain radii], t_max [s]) at a radius [grain radii] and a velocity [m/s]."""
        # Everything in the model is proportional to R*.
        spheres = self._spheres(0.5 * (radius + self.offset))
        depth = andrews.largest_compression(velocity, spheres)
        time = andrews.time_of_largest_compression(velocity, spheres) * self.grain_radius
        return depth - 2.0 * self.offset, time + time_of_contact(self.offset, velocity, self.grain_radius)

    def restitution(self, velocity):
        """Coefficient of restitution (A24 section 5.3), the same for every size."""
        return andrews.restitution(velocity, self._spheres(1.0))

    def _spheres(self, reduced_radius):
        with np.errstate(divide="ignore"):
            young = 1.0 / np.maximum(self.compliance, 0.0)
        return andrews.Spheres(reduced_radius, self.density, self.stress, young)


def time_of_contact(offset, velocity, grain_radius):
    """t_col [s], when surfaces that start 2 r - 2 delta_offset apart meet (A24 after eq 21); offset [grain radii]."""
    return 2.0 * (1.0 - offset) * grain_radius / velocity


# What A24 prints, by filling: sigma_plastic, E* [Pa] (eqs 34, 35), delta_offset [grain radii] (18, 20), delta_max/R* (19, 21).
PRINTED = {0.4: (2.25e6, 15.7e6, 0.271, 0.113), 0.3: (0.428e6, 4.96e6, -0.010, 0.199)}


def printed(filling, grain):
    """Aggregates with the values that A24 prints for a filling factor, of grains with grain_density and grain_radius; KeyError for another
    filling."""
    stress, young, offset, _ = PRINTED[filling]
    return Aggregates(stress, 1.0 / young, offset, filling * grain.grain_density, grain.grain_radius)


def straight_line(x, y, weights):
    """(slope, intercept) (B,) of y (n,) or (B, n) against x (n,), least squares with weights (B, n)."""
    mean = lambda values: np.sum(weights * values, axis=1) / weights.sum(axis=1)
    slope = (mean(x * y) - mean(x) * mean(y)) / (mean(x * x) - mean(x) ** 2)
    return slope, mean(y) - slope * mean(x)


def offset_of_line(c1, c2):
    """delta_offset [grain radii] that makes delta_max proportional to R*: c2/(2 - c1), from A24 eqs 14 to 17 and 19. Eq 18 prints
    2 - c1/2, but its number 0.271 is this one."""
    return c2 / (2.0 - c1)


def size_line(rows, weights):
    """(B, 5): c1, c2 (A24 eq 14), delta_offset (18), delta_max/R* (19), and d_max where the line is known best, at R = 60 r: from d_max
    [grain radii] against the radius of rows, at one velocity, for weights (B, n) of theirs."""
    c1, intercept = straight_line(rows.radius.to_numpy(), rows.d.to_numpy(), weights)
    return np.stack([c1, -intercept, offset_of_line(c1, -intercept), 2.0 * c1, c1 * 60.0 + intercept], axis=1)


def papers_way(rows, weights):
    """(B, 3): sigma_plastic [Pa], 1/E* [1/Pa] and delta_offset [grain radii] as A24 finds them: the offset from d_max against size at one
    velocity (eq 18), then the moduli from d_max and t_max of the sizes that have several velocities (section 4.3.3)."""
    at = alike(rows.velocity, VELOCITY)
    if rows[at].radius.nunique() < 2:
        return np.full((len(weights), 3), np.nan)
    offset = size_line(rows[at], weights[:, at])[:, 2]
    several = (rows.groupby("radius").velocity.transform("nunique") >= FEWEST_VELOCITIES).to_numpy()
    return fit_moduli(rows[several], weights[:, several], offset)


def papers_offset(rows, weights):
    """The same with A24's delta_offset; NaN at a filling for which it has none."""
    filling = rows.filling.iloc[0]
    if filling not in PRINTED:
        return np.full((len(weights), 3), np.nan)
    return fit_moduli(rows, weights, np.full(len(weights), PRINTED[filling][2]))


def fit_moduli(rows, weights, offset=None):
    """(B, 3): sigma_plastic [Pa], 1/E* [1/Pa] and delta_offset [grain radii] that fit d_max and t_max of rows (one filling) best, for
    weights (B, n) of theirs; offset (B,): held there. NaN with too few sizes or velocities, or no point with two pairs.

    A run counts by 1/s^2, s its scatter (_points): our choice, A24 doesn't say. Where rigid-plastic spheres fit as well, the compliance is 0; where spheres that never yield do, the stress is any
    that none reaches."""
    if rows.velocity.nunique() < FEWEST_VELOCITIES or (offset is None and rows.radius.nunique() < 2):
        return np.full((len(weights), 3), np.nan)
    residuals, stress = _residuals(rows, weights)
    start = np.tile([np.log(stress), *_START], (len(weights), 1))
    if not np.isfinite(residuals(start)).all():
        return np.full(start.shape, np.nan)
    low, high = (np.tile(ends, (len(weights), 1)) for ends in zip(*_BOUNDS))
    if offset is not None:
        low[:, 2] = high[:, 2] = offset
    x, chi_square = least_squares(residuals, start, low, high)
    high[:, 1] = 0.0
    rigid, rigid_chi_square = least_squares(residuals, x, low, high)
    x = np.where((rigid_chi_square <= chi_square)[:, None], rigid, x)
    return np.stack([*_moduli(x), x[:, 2]], axis=1)


# What is searched: ln sigma_plastic, 100 delta_crit/R* and delta_offset, in which the model is smooth up to the rigid-plastic limit.
_BOUNDS = ((np.log(1e3), np.log(1e13)), (0.0, 1000.0), (-1.5, 1.5))
_START = (3.0, 0.1)


def _moduli(x):
    """(sigma_plastic, 1/E*) (B,) at places x (B, 3): delta_crit/R* = (pi sigma/(2 E*))^2, A24 eq 24."""
    stress = np.exp(x[:, 0])
    return stress, 2.0 / np.pi * np.sqrt(0.01 * x[:, 1]) / stress


def _residuals(rows, weights):
    """(places (B, 3) -> residuals (B, 2 K) of the means at K sizes and velocities, stress of rigid-plastic spheres without offset [Pa])."""
    radius, velocity, number, own, (depth, time) = _points(rows, weights)
    data, error = (np.concatenate(both, axis=-1) for both in zip(depth, time))
    grain, root = rows.iloc[0], np.sqrt(np.tile(own, 2))
    density = grain.filling * grain.grain_density

    def residuals(x):
        stress, compliance = _moduli(x)
        model = Aggregates(stress[:, None], compliance[:, None], x[:, 2:], density, grain.grain_radius)
        both = np.broadcast_arrays(*model.at(radius, velocity))
        return root * (np.concatenate(both, axis=1) - data) / error

    ratio = np.average(2.0 * depth[0][0] / radius / velocity, weights=number)
    return residuals, andrews.stress_if_rigid(max(ratio, 1e-3), 1.0, density)


def _points(rows, weights):
    """(radius [grain radii], velocity [m/s], number of runs (K,), their weights (B, K), [(means (B, K), scatter of a run (K,)) of d
    and of t_max]) at the K sizes and velocities of rows; the scatter is a power of the velocity that is common to all sizes."""
    (radius, velocity), place = np.unique(rows[["radius", "velocity"]].to_numpy().T, axis=1, return_inverse=True)
    members = np.eye(len(radius))[place.ravel()]
    number, own, found = members.sum(axis=0), weights @ members, []
    for values in (rows[column].to_numpy() for column in ("d", "t_max")):
        away = values - (values @ members / number)[place.ravel()]
        scatter = np.sqrt(away**2 @ members / np.maximum(number - 1, 1))
        scatter[scatter <= ROUNDING * np.abs(values).max()] = 0.0
        found.append(((weights * values) @ members / own, smoothed_scatter(velocity, scatter, number)))
    return radius, velocity, number, own, found


def degenerate_curve(ratio, density, velocity=VELOCITY, samples=200):
    """(sigma_plastic, 1/E*) (samples,) [Pa, 1/Pa] of all elastoplastic spheres with delta_max/R* = ratio at a velocity [m/s]: A24 Fig. 10,
    from the rigid-plastic limit to the stress from which nothing yields."""
    least, young = andrews.stress_if_rigid(ratio, velocity, density), andrews.young_if_elastic(ratio, velocity, density)
    stress = np.linspace(least, elastic_stress(ratio, young), samples)
    # Eqs 27 to 29 are quadratic in delta_crit/R*; the smaller root is the one below delta_max.
    rest = 0.5 * ratio**2 * (1.0 - least / stress)
    critical = (ratio / 3.0 - np.sqrt(np.maximum(ratio**2 / 9.0 - 0.4 * rest, 0.0))) / 0.2
    return stress, 2.0 / np.pi * np.sqrt(critical) / stress


def elastic_stress(ratio, young):
    """sigma_plastic [Pa] from which spheres of reduced modulus E* [Pa] with delta_max/R* = ratio don't yield: A24 eq 24."""
    return 2.0 * young / np.pi * np.sqrt(ratio)
