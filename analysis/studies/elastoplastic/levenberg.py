"""Levenberg's and Marquardt's method for many sets of data at once."""

import numpy as np

_STEPS = 60
_DIFFERENCE = 1e-6  # of the parameters in the derivatives
_ENOUGH = 1e-7  # change of the parameters at which the search ends


def least_squares(residuals, x, low, high):
    """x (B, P) and chi square (B,) at the minimum next to each of the places x (B, P), within low and high (B, P); where these are equal
    a parameter is held. residuals: places (B, P) -> (B, M), each row of its own set of data."""
    x, free = np.clip(x, low, high), high > low
    damping = np.full(len(x), 1e-3)
    rest = residuals(x)
    chi_square = np.sum(rest**2, axis=1)
    units = np.eye(x.shape[1])
    for _ in range(_STEPS):
        slope = np.stack([residuals(x + _DIFFERENCE * unit) - rest for unit in units], axis=2) / _DIFFERENCE
        slope = slope * free[:, None, :]
        normal = np.einsum("bki,bkj->bij", slope, slope)
        size = np.trace(normal, axis1=1, axis2=2) + 1e-30
        damped = normal + units * (damping * size)[:, None, None]
        step = -np.linalg.solve(damped, np.einsum("bki,bk->bi", slope, rest)[:, :, None])[:, :, 0]
        new = np.clip(x + np.clip(step, -1.0, 1.0), low, high)
        new_rest = residuals(new)
        new_chi_square = np.sum(new_rest**2, axis=1)
        better = new_chi_square < chi_square
        moved = np.where(better, np.abs(new - x).max(axis=1), 0.0)
        x, rest = np.where(better[:, None], new, x), np.where(better[:, None], new_rest, rest)
        chi_square = np.where(better, new_chi_square, chi_square)
        damping = np.clip(np.where(better, damping / 5.0, damping * 10.0), 1e-12, 1e6)
        if np.all((moved < _ENOUGH) & (better | (damping > 1e3))):
            break
    return x, chi_square
