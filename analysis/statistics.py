"""The scatter of runs from few of them at each of several points."""

import numpy as np
from scipy.special import digamma


def smoothed_scatter(x, scatter, number):
    """Standard deviations (K,) of one run that follow a power of x, from each point's own (K,), x (K,) and the number
    of runs (K,): ln s^2 against ln x by least squares, weighted with the degrees of freedom and freed of its bias
    (digamma). A constant for less than four points; NaN without any point of two runs.

    Weights 1/s^2 of three runs each would vary by orders of magnitude by chance alone."""
    # A point of two equal numbers has no logarithm.
    known = (number > 1) & (scatter > 0)
    if not known.any():
        return np.full(len(scatter), np.nan)
    freedom = number[known] - 1.0
    log = 2.0 * np.log(scatter[known]) - digamma(freedom / 2.0) + np.log(freedom / 2.0)
    x = np.log(x)
    degree = 1 if known.sum() >= 4 and np.ptp(x[known]) > 0 else 0
    return np.exp(0.5 * np.polyval(np.polyfit(x[known], log, degree, w=np.sqrt(freedom)), x))
