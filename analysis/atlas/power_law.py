"""The mass distribution of fragments as a power law."""

import numpy as np
from scipy.optimize import brentq

FEWEST = 5  # fragments, below which no index is told
RANGE = -3.0, 8.0


def power_law_index(sizes, most=None):
    """(index, its standard error) of dN/dm ~ m^-index, by maximum likelihood, for fragments of so many grains, sizes (K,), each of 1 to
    `most` grains (None: all of them together). NaN for fewer than FEWEST, and beyond RANGE.

    Clauset, Shalizi & Newman (2009), eq 3.7 with an upper end: mass is conserved, so that the index may be below 1.

    >>> round(power_law_index([1] * 64 + [2] * 16 + [4] * 4 + [8])[0], 1)
    2.7
    """
    sizes = np.asarray(sizes)
    if len(sizes) < FEWEST:
        return np.nan, np.nan
    log = np.log(np.arange(1, int(most or sizes.sum()) + 1))
    mean = np.log(sizes).mean()

    def moments(index):
        weights = np.exp(-index * log)
        first = (weights * log).sum() / weights.sum()
        return first, (weights * log**2).sum() / weights.sum() - first**2

    excess = lambda index: moments(index)[0] - mean
    if not excess(RANGE[0]) > 0 > excess(RANGE[1]):
        return np.nan, np.nan
    index = brentq(excess, *RANGE)
    return index, (len(sizes) * moments(index)[1]) ** -0.5
