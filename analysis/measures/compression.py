"""Compression of two colliding aggregates: compression length d, mutual velocity v, and the largest d of the first
compression (Arakawa et al. 2024, A24, eqs 10-13).

v = +dd/dt, positive while the aggregates approach, but only between crossings: d jumps a little whenever a grain passes
through x = 0, because the averages over x > 0 and x < 0 then change their members.
"""

from dataclasses import dataclass

import numpy as np

from ..arrays import numbers


@dataclass(frozen=True)
class Maximum:
    """Largest compression length [m], its time [s], and the errors of both.

    inside is False at the first or last sample of a record: length is only a bound then.
    """

    length: float
    time: float
    length_error: float
    time_error: float
    inside: bool


def compression_and_velocity(x, x_velocity, aggregate_radius):
    """Compression length d [m] and mutual velocity v [m/s] of two aggregates (A24 eqs 10-13): d = 2 R_agg - (x_+ - x_-)
    and v = -(v_+ - v_-), positive while approaching, the means being over grains with x > 0 and x < 0; NaN while a
    side is empty.

    Parameters
    ----------
    x, x_velocity : (N,) array
        Positions [m] and velocities [m/s] along the collision axis from the centre of mass. A grain at 0 is on
        neither side.
    aggregate_radius : float [m]

    Examples
    --------
    >>> compression_and_velocity([-3.0, 0.0, 1.0, 2.0], [2.0, 0.0, -3.0, -3.0], 2.5)
    (0.5, 5.0)
    """
    x = numbers("x", x, (None,), gaps=True)
    x_velocity = numbers("x_velocity", x_velocity, x.shape, gaps=True)
    aggregate_radius = numbers("aggregate_radius", aggregate_radius, (), positive=True)
    right, left = (x > 0).nonzero()[0], (x < 0).nonzero()[0]
    if not (right.size and left.size):
        return float("nan"), float("nan")
    of = lambda side: (side.size, np.add.reduce(x[side]), np.add.reduce(x_velocity[side]))
    return tuple(map(float, of_sides(of(right), of(left), aggregate_radius)))


def of_sides(right, left, aggregate_radius):
    """(d, v) of compression_and_velocity() from (number, sum of x, sum of its velocity) of the grains with x > 0, and
    with x < 0; NaN while one side is empty."""
    n, x, v = right
    m, y, w = left
    with np.errstate(invalid="ignore", divide="ignore"):
        return 2.0 * aggregate_radius - (x / n - y / m), -(v / n - w / m)


def maximum_compression(time, d, v):
    """Largest compression length of a record, between its samples.

    Beside the largest sample d is Hermite's cubic through (d, v) of neighbouring samples.

    Parameters
    ----------
    time, d, v : (T,) array
        Rising times [s], compression length [m] and dd/dt [m/s]. Samples where d or v is NaN are left out.

    Returns
    -------
    Maximum or None
        length_error is the larger of the difference from the parabola through three samples and of what d and v
        disagree by (d jumps where a grain crosses x = 0), time_error that of the differences from the parabola's
        vertex and from the nearest time where v falls through 0. None without any sample.

    Examples
    --------
    >>> top = maximum_compression([0.0, 1.0, 2.0], [0.0, 1.0, 0.0], [2.0, 0.0, -2.0])
    >>> print(top.length, top.time, top.inside)
    1.0 1.0 True
    """
    time = numbers("time", time, (None,))
    d, v = (numbers(name, values, time.shape, gaps=True) for name, values in (("d", d), ("v", v)))
    if not np.all(np.diff(time) > 0):
        raise ValueError(f"time: must rise, does not after sample {np.argmin(np.diff(time) > 0)}")
    known = np.isfinite(d) & np.isfinite(v)
    if not known.any():
        return None
    time, d, v = time[known], d[known], v[known]
    k = int(np.argmax(d))
    if k == 0 or k == time.size - 1:
        step = np.diff(time).max() if time.size > 1 else np.inf
        return Maximum(d[k], time[k], abs(v[k]) * step if time.size > 1 else np.inf, step, False)
    tops = [_hermite_top(time[i : i + 2], d[i : i + 2], v[i : i + 2]) for i in (k - 1, k)]
    d_max, t_max = max(tops)
    near = slice(k - 1, k + 2)
    vertex_d, vertex_t = _parabola_vertex(time[near], d[near])
    mismatch = np.abs(np.diff(d[near]) - 0.5 * (v[near][1:] + v[near][:-1]) * np.diff(time[near])).max()
    crossings = falls_through_zero(time, v)
    to_crossing = np.abs(crossings - t_max).min() if crossings.size else np.diff(time[near]).max()
    return Maximum(d_max, t_max, max(abs(d_max - vertex_d), mismatch), max(abs(t_max - vertex_t), to_crossing), True)


def first_compression(time, d, v):
    """Maximum of the first compression: until v, once it has fallen through 0, rises again.

    This is d_max everywhere. Aggregates that stuck may creep together further, long after the collision. Arguments
    and None as maximum_compression.
    """
    v = np.asarray(v, dtype=float)
    falls = np.flatnonzero((v[:-1] > 0) & (v[1:] <= 0))
    rises = np.flatnonzero((v[:-1] <= 0) & (v[1:] > 0))
    rises = rises[rises > falls[0]] if falls.size else rises[:0]
    end = int(rises[0]) + 1 if rises.size else len(v)
    return maximum_compression(time[:end], d[:end], v[:end])


def largest_return_speed(time, v, start):
    """(speed [m/s], time [s]) at which the halves part fastest after the largest compression (A24 section 5.3).

    That is minus the minimum of v (T,) after `start`; NaN if v is never negative then, or if its minimum is the last
    sample, so that the speed may still grow."""
    time, v = np.asarray(time, dtype=float), np.asarray(v, dtype=float)
    later = np.flatnonzero((time >= start) & np.isfinite(v))
    if not later.size:
        return np.nan, np.nan
    place = later[np.argmin(v[later])]
    if v[place] >= 0.0 or place == later[-1]:
        return np.nan, np.nan
    return float(-v[place]), float(time[place])


def _hermite_top(t, d, v):
    """Highest point (value, time) of the cubic through two samples with slopes, between them."""
    h = t[1] - t[0]
    m0, m1, rise = v[0] * h, v[1] * h, d[1] - d[0]
    # d0 + m0 s + b s^2 + a s^3 on 0 <= s <= 1
    a, b = m0 + m1 - 2.0 * rise, 3.0 * rise - 2.0 * m0 - m1
    candidates = [0.0, 1.0]
    candidates += [s.real for s in np.roots([3.0 * a, 2.0 * b, m0]) if abs(s.imag) < 1e-12 and 0.0 < s.real < 1.0]
    return max((d[0] + s * (m0 + s * (b + s * a)), t[0] + s * h) for s in candidates)


def _parabola_vertex(t, d):
    """Vertex (value, time) of the parabola through three samples, the middle one being the largest."""
    left, right = (d[1] - d[0]) / (t[1] - t[0]), (d[2] - d[1]) / (t[2] - t[1])
    curvature = (right - left) / (t[2] - t[0])
    if curvature >= 0:
        return d[1], t[1]
    slope = left + curvature * (t[1] - t[0])
    shift = -slope / (2.0 * curvature)
    return d[1] + 0.5 * slope * shift, t[1] + shift


def falls_through_zero(x, y):
    """x (M,) at which y (K,), linear between rising x (K,), falls from positive to zero or below."""
    i = np.flatnonzero((y[:-1] > 0) & (y[1:] <= 0))
    return x[i] + (x[i + 1] - x[i]) * y[i] / (y[i] - y[i + 1])
