"""Means over the impact parameter, the threshold of fragmentation, and fits to the sizes of fragments (A22 sections 2.4, 3.2 and 4)."""

import numpy as np

SQUARES = tuple(i / 12 for i in range(13))  # B_off^2 of A22
SMALL = 10  # grains of a fragment that counts as small
MERGED = 0.5  # f_gro above which two aggregates have merged; two remnants have some 0, all in one piece is 1
SMALL_FITTED = 0.05  # of all grains, to which fragments count as small in a fit
LARGE_FITTED = 100  # grains: A22's alpha = 1 is for N much larger (section 3.4)


def offset_weights(squares):
    """Weights (K,) of A at rising B_off^2 = squares (K,), from 0 to 1, in <A> = int_0^1 2 B A dB = int_0^1 A d(B^2): A22
    eq 29, by the trapezoidal rule in B_off^2, which is exact for A linear in it.

    >>> offset_weights([0.0, 0.5, 1.0]).tolist()
    [0.25, 0.5, 0.25]
    """
    steps = np.diff(squares)
    return 0.5 * (np.append(steps, 0.0) + np.append(0.0, steps))


def threshold_velocity(velocities, growth):
    """v_fra [m/s] where growth (..., V), over rising velocities (V,), first falls from above 0 to 0 or below, linear in the logarithm
    of the velocity between two of them; NaN where it doesn't within them (A22 section 3.2).

    >>> float(threshold_velocity([10.0, 1000.0], [1.0, -1.0]).round(6))
    100.0
    """
    growth, log = np.asarray(growth, dtype=float), np.log(np.asarray(velocities, dtype=float))
    if len(log) < 2:
        return np.full(growth.shape[:-1], np.nan)[()]
    falls = (growth[..., :-1] > 0) & (growth[..., 1:] <= 0)
    k = np.argmax(falls, axis=-1)[..., None]
    above, below = (np.take_along_axis(growth, k + i, axis=-1)[..., 0] for i in (0, 1))
    k = k[..., 0]
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        crossing = np.exp(log[k] + (log[k + 1] - log[k]) * above / (above - below))
    return np.where(falls.any(axis=-1), crossing, np.nan)[()]


def fragment_exponent(numbers, grains):
    """alpha of N_cum(<= N) = c N^(2 - alpha)/(2 - alpha) (A22 eq 41): least squares of the logarithms of grains (..., G) against
    numbers (G,); NaN where one of them is not positive, and with fewer than three."""
    x, y = np.log(np.asarray(numbers, dtype=float)), np.asarray(grains, dtype=float)
    if len(x) < 3:
        return np.full(y.shape[:-1], np.nan)[()]
    with np.errstate(divide="ignore", invalid="ignore"):
        y = np.log(np.where(y > 0, y, np.nan))
    away = x - x.mean()
    return 2.0 - (y @ away) / (away @ away)
