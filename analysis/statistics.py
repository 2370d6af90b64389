"""Statistics of runs that differ by their seeds: errors, intervals, and a bootstrap over pairs of aggregates.

Whether there is scatter at all is decided by the number of runs, never by a standard deviation of exactly 0: rounding
makes that 1e-17, or not, from one processor to another."""

import numpy as np
from scipy.special import digamma
from scipy.stats import binomtest
from scipy.stats import t as student

CONFIDENCE = 0.95
RESAMPLES = 1000
RANDOM_SEED = 20240124
# Numbers that agree to this fraction of their size are the same number, rounded differently.
_ROUNDING = 1e-12


def mean_and_error(values):
    """(mean, standard error) of values (n,); the error is None for one value, 0 where they agree to rounding.

    >>> mean_and_error([1.0, 3.0]), mean_and_error([2.0])
    ((2.0, 1.0), (2.0, None))
    """
    values = np.asarray(values, dtype=float)
    return float(values.mean()), float(scatter(values) / np.sqrt(len(values))) if len(values) > 1 else None


def ratio_and_error(above, below):
    """(ratio of the means, standard error) of values (n,) and (n,), a pair of which is of one draw: leaving one draw out at a time
    (the jackknife). The error is None for one draw, or where the rest has nothing below; the ratio is NaN without anything below.

    >>> ratio_and_error([1.0, 3.0], [2.0, 6.0]), ratio_and_error([1.0], [2.0])
    ((0.5, 0.0), (0.5, None))
    """
    above, below = np.asarray(above, dtype=float), np.asarray(below, dtype=float)
    number, whole = len(above), below.sum()
    ratio = float(above.sum() / whole) if whole else float("nan")
    rest = whole - below
    if number < 2 or not rest.all():
        return ratio, None
    without = (above.sum() - above) / rest
    return ratio, float(np.sqrt(number - 1) * _without_rounding(without.std(), without))


def ratio_of_two(above, below):
    """(ratio, standard error) of two independent (mean, standard error or None), to first order; None where one is 0 or has no
    error.

    >>> ratio_of_two((1.0, 0.3), (2.0, 0.8))
    (0.5, 0.25)
    """
    ratio = above[0] / below[0] if below[0] else float("nan")
    if not above[0] or not below[0] or above[1] is None or below[1] is None:
        return ratio, None
    return ratio, float(abs(ratio) * np.hypot(above[1] / above[0], below[1] / below[0]))


def scatter(values):
    """Standard deviation of values (n,) about their mean, n - 1 degrees of freedom; NaN for one value, 0 where they agree
    to rounding."""
    values = np.asarray(values, dtype=float)
    return _without_rounding(values.std(ddof=1), values) if len(values) > 1 else float("nan")


def pooled_scatter(scatters, numbers):
    """(standard deviation of one run, its degrees of freedom) from the standard deviations (K,) (NaN: one run) of groups of
    numbers (K,) runs each; (None, 0) without a group of two.

    >>> pooled_scatter([1.0, float("nan"), 7.0], [2, 1, 2])
    (5.0, 2)
    """
    scatters, numbers = np.asarray(scatters, dtype=float), np.asarray(numbers)
    known = np.isfinite(scatters) & (numbers > 1)
    if not known.any():
        return None, 0
    freedom = numbers[known] - 1
    return float(np.sqrt(np.average(np.square(scatters[known]), weights=freedom))), int(freedom.sum())


def resampling_error(resamples):
    """Standard error: the standard deviation over resamples (B,), of those that are finite; None where fewer than two
    are, 0 where they agree to rounding."""
    resamples = np.asarray(resamples, dtype=float)
    finite = resamples[np.isfinite(resamples)]
    return _without_rounding(finite.std(ddof=1), finite) if finite.size > 1 else None


def percentile_error(resamples):
    """Half the distance between the 15.87 and the 84.13 per cent of resamples (B,), which is one standard deviation of a
    normal distribution and bears the long tails of a modulus; None where it is not finite."""
    low, high = np.quantile(resamples, [0.158655, 0.841345], method="nearest")
    return 0.5 * float(high - low) if np.isfinite(high) else None


def _without_rounding(spread, values):
    return 0.0 if spread <= _ROUNDING * np.abs(values).max() else float(spread)


def wilson(successes, trials):
    """(low, high): Wilson's score interval of a probability at CONFIDENCE.

    >>> wilson(0, 10)[0], wilson(10, 10)[1]
    (0.0, 1.0)
    """
    interval = binomtest(successes, trials).proportion_ci(CONFIDENCE, method="wilson")
    return float(interval.low), float(interval.high)


def student_interval(values):
    """(low, high): Student's interval of the mean of values (n,) at CONFIDENCE; (None, None) for one value, and where
    they agree to rounding: numbers without scatter (as the zeros of runs that stick) say nothing of their error.

    >>> low, high = student_interval([1.0, 2.0, 3.0])
    >>> round(low, 3), round(high, 3)
    (-0.484, 4.484)
    """
    mean, error = mean_and_error(values)
    if not error:
        return None, None
    reach = float(student.ppf(0.5 + 0.5 * CONFIDENCE, len(values) - 1)) * error
    return mean - reach, mean + reach


def student_chance(difference, freedom):
    """Chance of a difference as large as this (in standard errors) or larger, either way, where the error was estimated
    with `freedom` degrees of freedom: Student's t. With three seeds 3.8 errors are p = 0.06, not 1e-4.

    >>> round(student_chance(3.8, 2), 3)
    0.063
    """
    return float(2.0 * student.sf(abs(difference), freedom))


def pair_weights(pairs, resamples=RESAMPLES, random_seed=RANDOM_SEED):
    """Weights (B, n) for B resamples of runs that belong to `pairs` (n,) of aggregates, any labels: one exponential
    number a pair, the same in all its runs, so that the runs of a pair are never taken for independent."""
    names, index = np.unique(np.asarray(pairs), return_inverse=True)
    return np.random.default_rng(random_seed).exponential(size=(resamples, names.size))[:, index]


def stretch(pairs, fitted):
    """Factor of a standard error from pair_weights where `fitted` numbers were fitted to so many pairs: without it the errors
    of few pairs come out too small. For a mean (fitted = 1) it is that of weighted_deviations."""
    return float(np.sqrt((pairs + 1.0) / (pairs - fitted)))


def group_means(values, group, weights):
    """Weighted means (B, n) of values (n,) over each one's group, labels (n,), for weights (B, n)."""
    out = np.empty(weights.shape)
    for name in np.unique(group):
        own = group == name
        out[:, own] = (weights[:, own] @ values[own] / weights[:, own].sum(axis=1))[:, None]
    return out


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


def weighted_deviations(sample, weights):
    """Deviations (B,) of the mean of a sample (n,) in a Bayesian bootstrap with exponential weights (B, n), stretched by
    [(n+1)/(n-1)]^(1/2), without which the errors of few runs come out too small (Rubin 1981: Dirichlet weights)."""
    n = len(sample)
    own = weights / weights.sum(axis=1, keepdims=True) * np.sqrt((n + 1.0) / (n - 1.0))
    return own @ (sample - sample.mean())
