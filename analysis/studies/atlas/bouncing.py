"""The size from which on aggregates bounce, against velocity."""

import numpy as np

STEPS, RIDGE = 25, 1e-2  # of Newton's method; on coefficients of variables in units of their scatter


def threshold_exponent(rows, weights):
    """a (B, 1) of N ~ v^a at which half of the runs bounce, from rows (DataFrame, n, with `bounced`, grains_target, velocity, v_break) and
    weights (B, n): logistic regression on ln N and ln v. NaN where no run bounces, or all do."""
    points = np.log(np.column_stack([rows.grains_target, rows.velocity / rows.v_break]))
    scatter = points.std(axis=0)
    x = np.column_stack([np.ones(len(points)), (points - points.mean(axis=0)) / scatter])
    y = rows.bounced.to_numpy()
    if not 0 < y.mean() < 1:
        return np.full((len(weights), 1), np.nan)
    found = np.zeros((len(weights), 3))
    ridge = RIDGE * np.diag([0.0, 1.0, 1.0])
    for _ in range(STEPS):
        p = 1 / (1 + np.exp(-np.clip(found @ x.T, -30, 30)))
        slope = (weights * (y - p)) @ x - found @ ridge
        curvature = np.einsum("bn,ni,nj->bij", weights * p * (1 - p), x, x) + ridge + 1e-9 * np.eye(3)
        found += np.linalg.solve(curvature, slope[..., None])[..., 0]
    by_grains, by_velocity = (found[:, 1:] / scatter).T
    return (-by_velocity / by_grains)[:, None]
