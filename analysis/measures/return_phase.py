"""The return phase of a collision: from the largest compression on, the halves part, until tension slows them down again
(Arakawa et al. 2024, A24, section 5.3, where v reaches its minimum at about 344 ns)."""

import numpy as np


def largest_return_speed(time, v, start):
    """(speed [m/s], time [s]) at which the halves part fastest after the time `start` [s] of the largest compression:
    minus the minimum of v (T,) [m/s] (A24 eqs 12, 13) over times (T,) [s]; (None, None) where v is never negative then,
    or its minimum is the record's last sample, so that the speed may still grow.

    >>> largest_return_speed([0.0, 1.0, 2.0, 3.0], [2.0, 0.0, -1.0, -0.5], 1.0)
    (1.0, 2.0)
    """
    time, v = np.asarray(time, dtype=float), np.asarray(v, dtype=float)
    later = np.flatnonzero((time >= start) & np.isfinite(v))
    if not later.size:
        return None, None
    place = later[np.argmin(v[later])]
    if v[place] >= 0.0 or place == later[-1]:
        return None, None
    return float(-v[place]), float(time[place])
