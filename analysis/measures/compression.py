"""Compression of two colliding aggregates: compression length d, mutual velocity v, and their maximum
(Arakawa et al. 2024, A24, eqs 10-13).

As defined, v = +dd/dt (positive while the aggregates approach), but only between crossings: d jumps a little
whenever a grain passes through x = 0, because the averages over x > 0 and x < 0 then change their members.
"""

from dataclasses import dataclass

import numpy as np

from ..arguments import ANY, NOT_NEGATIVE, WrongArgument, number, numbers, takes


@dataclass(frozen=True)
class Maximum:
    """Largest compression: length d_max [m] at time t_max [s], their errors (see maximum_compression), and
    whether it is a maximum inside the record (False: at its first or last sample, so that d_max is only a
    bound)."""

    length: float
    time: float
    length_error: float
    time_error: float
    inside: bool


@takes(x=numbers("K"), aggregate_radius=number(NOT_NEGATIVE))
def compression_length(x, aggregate_radius):
    """d = 2 R_agg - (x_+ - x_-) [m], with x_+ (x_-) the mean of the x > 0 (x < 0): A24 eqs 10, 11.

    x (N,) [m] along the collision axis from the centre of mass, aggregate_radius [m]. A grain at x = 0 belongs to
    neither side. NaN while a side is empty.

    >>> compression_length([-3.0, 0.0, 1.0, 2.0], 2.5)
    0.5
    """
    return compression_and_velocity(x, x, aggregate_radius)[0]


@takes(x=numbers("K"), x_velocity=numbers("K"))
def mutual_velocity(x, x_velocity):
    """v = -(v_+ - v_-) [m/s], positive while approaching, with v_+ (v_-) the mean over grains with x > 0 (x < 0): A24
    eqs 12, 13.

    x (N,) [m], x_velocity (N,) [m/s]. NaN while a side is empty.

    >>> mutual_velocity([-1.0, 1.0], [2.0, -3.0])
    5.0
    """
    return compression_and_velocity(x, x_velocity, 0.0)[1]


def compression_and_velocity(x, x_velocity, aggregate_radius):
    """(d [m], v [m/s]) as compression_length and mutual_velocity define them, at the cost of one; NaNs while a side of
    x = 0 is empty."""
    x, x_velocity = np.asarray(x, dtype=float), np.asarray(x_velocity, dtype=float)
    right, left = (x > 0).nonzero()[0], (x < 0).nonzero()[0]
    if not (right.size and left.size):
        return float("nan"), float("nan")
    mean = lambda values, side: np.add.reduce(values[side]) / side.size  # at half the time of values[side].mean()
    d = 2.0 * aggregate_radius - (mean(x, right) - mean(x, left))
    return float(d), float(-(mean(x_velocity, right) - mean(x_velocity, left)))


@takes(time=numbers("N"), d=numbers("N", ANY), v=numbers("N", ANY))
def maximum_compression(time, d, v):
    """Maximum of the compression length between samples (A24: t_max is the time when d = d_max).

    time (T,) [s] rising, d (T,) [m], v (T,) [m/s] = dd/dt; samples where d or v is NaN are left out, and None
    is returned where none remains. Beside the largest sample d is Hermite's cubic through (d, v) of
    neighbouring samples; its highest point is d_max, and where it stands is t_max. length_error: the largest
    of the difference from the parabola through the three samples, and of the amount by which d and v disagree
    over the two intervals (d jumps when a grain crosses x = 0). time_error: the largest of the difference
    from the parabola's vertex and from the nearest time where v falls through zero. Returns Maximum.

    >>> top = maximum_compression([0.0, 1.0, 2.0], [0.0, 1.0, 0.0], [2.0, 0.0, -2.0])
    >>> print(top.length, top.time, top.inside)
    1.0 1.0 True
    """
    time, d, v = (np.asarray(a, dtype=float) for a in (time, d, v))
    if not np.all(np.diff(time) > 0):
        raise WrongArgument(f"time: falls or stays after sample {np.argmin(np.diff(time) > 0)}; must rise")
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
    vertex_d, vertex_t = _parabola_vertex(time[k - 1 : k + 2], d[k - 1 : k + 2])
    near = slice(k - 1, k + 2)
    mismatch = np.abs(np.diff(d[near]) - 0.5 * (v[near][1:] + v[near][:-1]) * np.diff(time[near])).max()
    crossings = _falls_through_zero(time, v)
    to_crossing = np.abs(crossings - t_max).min() if crossings.size else np.diff(time[near]).max()
    return Maximum(d_max, t_max, max(abs(d_max - vertex_d), mismatch), max(abs(t_max - vertex_t), to_crossing), True)


def first_compression(time, d, v):
    """(Maximum, whether d exceeds it later): the largest d before v, once fallen through zero, rises through it again.

    Aggregates that stuck may creep together further, long after the collision (A24 defines d_max as the largest d; it
    is this one then). Arguments and None as maximum_compression, of whole arrays without NaN between."""
    v = np.asarray(v, dtype=float)
    falls = np.flatnonzero((v[:-1] > 0) & (v[1:] <= 0))
    rises = np.flatnonzero((v[:-1] <= 0) & (v[1:] > 0))
    rises = rises[rises > falls[0]] if falls.size else rises[:0]
    end = int(rises[0]) + 1 if rises.size else len(v)
    first = maximum_compression(time[:end], d[:end], v[:end])
    return first, bool(first is not None and np.nanmax(d) > first.length)


def _hermite_top(t, d, v):
    """Highest point (value, time) of the cubic through two samples with slopes, on the interval between
    them."""
    h = t[1] - t[0]
    m0, m1, rise = v[0] * h, v[1] * h, d[1] - d[0]
    # d0 + m0 s + b s^2 + a s^3 on 0 <= s <= 1
    a, b = m0 + m1 - 2.0 * rise, 3.0 * rise - 2.0 * m0 - m1
    candidates = [0.0, 1.0]
    candidates += [s.real for s in np.roots([3.0 * a, 2.0 * b, m0]) if abs(s.imag) < 1e-12 and 0.0 < s.real < 1.0]
    return max((d[0] + s * (m0 + s * (b + s * a)), t[0] + s * h) for s in candidates)


def _parabola_vertex(t, d):
    """Vertex (value, time) of the parabola through three samples of which the middle one is the largest."""
    left, right = (d[1] - d[0]) / (t[1] - t[0]), (d[2] - d[1]) / (t[2] - t[1])
    curvature = (right - left) / (t[2] - t[0])
    if curvature >= 0:
        return d[1], t[1]
    slope = left + curvature * (t[1] - t[0])
    shift = -slope / (2.0 * curvature)
    return d[1] + 0.5 * slope * shift, t[1] + shift


def _falls_through_zero(time, v):
    """Times [s] at which v, linear between samples, falls from positive to zero or below."""
    i = np.flatnonzero((v[:-1] > 0) & (v[1:] <= 0))
    return time[i] + (time[i + 1] - time[i]) * v[i] / (v[i] - v[i + 1])
