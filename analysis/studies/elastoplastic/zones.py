"""How far the filling of the zones that meet, which the packings alone give, tells d_max.

At one velocity, about the means m_i of the sizes i: d_max = m_i + b R (zone filling - 1) + scatter [grain radii]."""

import numpy as np

FEWEST_PAIRS = 4  # that are left beyond the sizes and the slope


def zone_correlation(rows, weights):
    """(B, 3): correlation of d_max with R times the filling of the zones, slope b, and the fraction of the variance of d_max that it
    explains, less what a covariate of no use would (adjusted R^2); for rows with radius, d, zone_filling and weights (B, n)."""
    size, place = np.unique(rows.radius, return_inverse=True)
    members = np.eye(len(size))[place]
    own = weights @ members

    def away(values):
        return values - ((weights * values) @ members / own)[:, place]

    x, y = away((rows.radius * rows.zone_filling).to_numpy()), away(rows.d.to_numpy())
    xx, yy, xy = (np.sum(weights * product, axis=1) for product in (x * x, y * y, x * y))
    with np.errstate(invalid="ignore"):  # NaN where all zones are alike
        correlation, slope = xy / np.sqrt(xx * yy), xy / xx
    left = len(rows) - len(size)
    return np.stack([correlation, slope, 1.0 - (1.0 - correlation**2) * left / (left - 1)], axis=1)
