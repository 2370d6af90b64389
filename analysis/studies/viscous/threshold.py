"""The threshold velocity of fragmentation, v_fra, where <f_gro> = 0 (A22 section 3.2)."""

import numpy as np


def threshold_velocity(velocities, growth):
    """v_fra [m/s] where growth (V,) or (B, V), over rising velocities (V,), first falls from above 0 to 0 or below, linear
    in the logarithm of the velocity between two of them; NaN (or (B,) with NaNs) where it doesn't within them.

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
