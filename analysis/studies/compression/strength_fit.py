"""The power law P = P0 phi^n of one set of parameters (K13 eqs 23, 25), with errors that know how bins hang together.

The pressures of one cluster at neighbouring filling factors deviate together, so that the scatter about the line says
nothing. The errors are from the seeds, which are independent: the fit is repeated without each of them in turn (the
jackknife), which keeps whatever correlation the bins have."""

from dataclasses import dataclass

import numpy as np

from .paper import EXPONENT

FEWEST_BINS = 3
ROUNDING = 1e-12  # of ln P0 and n: seeds that agree to this agree


@dataclass(frozen=True)
class StrengthFit:
    """P = P0 phi^n between the filling factors `between` (low, high), over `bins` bins and `runs` seeds: scale (P0 [Pa]),
    exponent; errors (of ln P0 and of n) and their correlation, None for one seed; at_three (P0 [Pa] with n = 3) and the
    error of its logarithm. `reason` says why nothing could be fitted; the numbers are None then."""

    between: tuple
    runs: int
    bins: int = 0
    scale: float = None
    exponent: float = None
    errors: tuple = (None, None)
    correlation: float = None
    at_three: float = None
    at_three_error: float = None
    reason: str = None


def within(filling, low, high):
    """(K,) bool: the filling factors (K,) from low to high, both included."""
    return (filling >= low * (1 - 1e-9)) & (filling <= high * (1 + 1e-9))


def fit_strength(filling, pressure, low, high):
    """StrengthFit of pressure (S, K) [Pa] of S seeds at filling factors (K,): least squares of the logarithm of the mean
    over the seeds (K13 takes the arithmetic mean), over the bins from low to high in which every seed has a value and the mean
    is positive whichever seed is left out: below, only some clusters touch their images yet."""
    pressure = np.asarray(pressure, dtype=float)
    runs = len(pressure)
    rests = np.array([np.delete(pressure, s, axis=0).mean(axis=0) for s in range(runs)]) if runs > 1 else pressure
    used = within(filling, low, high) & np.isfinite(pressure).all(axis=0) & (rests > 0).all(axis=0)
    bins = int(used.sum())
    if bins < FEWEST_BINS:
        reason = f"{bins} bins of the filling factor between {low:.3g} and {high:.3g}: a power law needs {FEWEST_BINS}"
        return StrengthFit((low, high), runs, bins, reason=reason)
    x = np.log(filling[used])
    best = _fit(x, pressure[:, used].mean(axis=0))
    values = dict(scale=float(np.exp(best[0])), exponent=float(best[1]), at_three=float(np.exp(best[2])))
    if runs < 2:
        return StrengthFit((low, high), runs, bins, **values)
    rest = np.array([_fit(x, mean) for mean in rests[:, used]])
    away = rest - rest.mean(axis=0)
    covariance = (runs - 1) / runs * away.T @ away
    error = np.sqrt(np.diag(covariance))
    error[error < ROUNDING] = 0.0
    correlation = float(covariance[0, 1] / (error[0] * error[1])) if error[0] * error[1] > 0 else None
    return StrengthFit(
        (low, high),
        runs,
        bins,
        **values,
        errors=(float(error[0]), float(error[1])),
        correlation=correlation,
        at_three_error=float(error[2]),
    )


def _fit(x, pressure):
    """(ln P0, n, ln P0 with n = 3)."""
    y = np.log(pressure)
    exponent, offset = np.polyfit(x, y, 1)
    return offset, exponent, (y - EXPONENT * x).mean()
