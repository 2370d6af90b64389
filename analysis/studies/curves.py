"""Numbers that curves have: where one falls through 0, and which power it follows."""

import numpy as np


def threshold_velocity(velocities, values):
    """Velocity [m/s] at which values (..., V), over rising velocities (V,), first fall from above 0 to 0 or below, linear in the
    logarithm of the velocity between two of them; NaN where they don't within them (Arakawa et al. 2022, section 3.2).

    >>> float(threshold_velocity([10.0, 1000.0], [1.0, -1.0]).round(6))
    100.0
    """
    values, log = np.asarray(values, dtype=float), np.log(np.asarray(velocities, dtype=float))
    if len(log) < 2:
        return np.full(values.shape[:-1], np.nan)[()]
    falls = (values[..., :-1] > 0) & (values[..., 1:] <= 0)
    k = np.argmax(falls, axis=-1)[..., None]
    above, below = (np.take_along_axis(values, k + i, axis=-1)[..., 0] for i in (0, 1))
    k = k[..., 0]
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        crossing = np.exp(log[k] + (log[k + 1] - log[k]) * above / (above - below))
    return np.where(falls.any(axis=-1), crossing, np.nan)[()]


def power(x, y):
    """n of y ~ x^n: least squares of the logarithms of y (..., K) against those of x (K,); NaN where one of y is not positive, and with fewer
    than three.

    >>> float(power([1.0, 2.0, 4.0], [3.0, 12.0, 48.0]).round(9))
    2.0
    """
    x, y = np.log(np.asarray(x, dtype=float)), np.asarray(y, dtype=float)
    if len(x) < 3:
        return np.full(y.shape[:-1], np.nan)[()]
    away = x - x.mean()
    return np.log(np.where(y > 0, y, np.nan)) @ away / (away @ away)
