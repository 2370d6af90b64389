"""A number with its bootstrap draws over independent pairs of aggregates. What follows from such numbers keeps the draws, so that
differences and ratios of what the same pairs gave have the right errors by themselves.

A draw weighs every pair by an exponential random number (the Bayesian bootstrap, Rubin 1981). A pair's weights follow from its name
alone: they are the same wherever the pair occurs, and independent of those of any other. A mean over points within a pair (offsets,
say) has a second row of draws, in which every point of every pair has weights of its own: two pairs whose means agree by chance would
have no error otherwise. An error is the larger of the two."""

import math
from dataclasses import dataclass, field
from functools import lru_cache
from zlib import crc32

import numpy as np
import pandas
from scipy.stats import binomtest, fisher_exact
from scipy.stats import t as student

CONFIDENCE = 0.95
DRAWS = 1000
RANDOM_SEED = 20240124
LOST = 0.05  # with this part of the draws undefined or more, the others would tell too small an error
ROUNDING = 1e-12  # relative: draws that differ by less are the same number, rounded differently
EXACT = math.inf  # pairs behind a number that has no scatter: a closed form


def exact_interval(successes, trials, confidence):
    """(low, high): the exact interval of a probability (Clopper & Pearson 1934)."""
    interval = binomtest(int(successes), int(trials)).proportion_ci(confidence, method="exact")
    return float(interval.low), float(interval.high)


@lru_cache(maxsize=5000)
def weights_of(pair):
    """Weights (DRAWS,) of one pair of aggregates, by its name (str)."""
    return np.random.default_rng([RANDOM_SEED, crc32(pair.encode())]).exponential(size=DRAWS)


def weights_of_pairs(pairs):
    """Weights (DRAWS, n) of n pairs, by their names."""
    return np.stack([weights_of(pair) for pair in pairs], axis=1)


def stretch(pairs, fitted=1):
    """Factor of deviations of a statistic with `fitted` numbers, without which the draws of few pairs scatter too little (for a
    mean exactly: the variance of Dirichlet weights is 1/(n + 1) of the sample's, n - 1 degrees of freedom)."""
    return math.sqrt((pairs + 1) / (pairs - fitted))


def _operator(f):
    def of(one, other):
        if isinstance(other, Estimate):
            return combine(f, one, other)
        return combine(lambda a: f(a, other), one) if np.isscalar(other) else NotImplemented

    return of


class Number:
    """What an Estimate and a Fraction can be written as."""

    @property
    def text(self):
        """'54.0 ± 1.0 (4)', with the number of pairs where there is one."""
        return repr(self)

    @property
    def record(self):
        """Value, error, 95 % interval and number of pairs, for JSON (dict)."""
        low, high = self.interval()
        return {"value": self.value, "error": self.error, "low": low, "high": high, "pairs": self.pairs}


@dataclass(frozen=True, eq=False)
class Estimate(Number):
    """value; draws (1 or 2, DRAWS), NaN where undefined: of pairs, and of single points where it is a mean over such; pairs: the fewest
    independent pairs of aggregates behind it, EXACT for a closed form; fitted: how many numbers were fitted to them.

    >>> a, b = mean({"1": 2.0, "2": 4.0, "3": 3.0}), mean({"1": 1.0, "2": 3.0, "3": 2.0})
    >>> (a - b).value, round((a - b).error, 6), (a / 2).value
    (1.0, 0.0, 1.5)
    """

    value: float
    draws: np.ndarray
    pairs: float
    fitted: int = field(default=1, kw_only=True)

    @property
    def freedom(self):
        """Student's degrees of freedom of its error."""
        return self.pairs - self.fitted

    @property
    def error(self):
        """Standard error: the scatter of the draws about the value; None for one pair, and where LOST of the draws or more are undefined; 0 where
        all pairs gave the same number."""
        if self.pairs == EXACT:
            return 0.0
        if self.pairs < 2:
            return None
        errors = [_scatter(row, self.value) for row in self.draws]
        return None if None in errors else max(errors)

    @property
    def text(self):
        return repr(self) if self.pairs == EXACT else f"{self!r} ({self.pairs:g})"

    def interval(self, confidence=CONFIDENCE, runs=EXACT):
        """(low, high), Student's, of the difference from a number of so many runs of somebody else's (error_beside); (None, None) without an
        error."""
        error = self.error_beside(runs)
        if error is None or (error == 0 and self.pairs != EXACT):
            return None, None
        reach = error * float(student.ppf(0.5 + 0.5 * confidence, self.freedom)) if error else 0.0
        return self.value - reach, self.value + reach

    def error_beside(self, runs):
        """Standard error of the difference from the mean of so many independent runs of somebody else's that scatter as these
        pairs do (math.inf: their number has no error); None without an error."""
        error = self.error
        return None if error is None else 0.0 if self.pairs == EXACT else error * math.sqrt(1 + self.pairs / runs)

    def chance(self, low, high, runs=EXACT):
        """p of a number as far beyond low to high, of so many runs of somebody else's, by Student's t: either way where both are the same number,
        else one-sided, and 1 within; None without an error."""
        both = self.error_beside(runs)
        if not both:
            return None
        beyond = max(low - self.value, self.value - high)
        if low < high and beyond <= 0:
            return 1.0
        return float((1 if low < high else 2) * student.sf(abs(beyond) / both, self.freedom))

    __add__ = __radd__ = _operator(lambda a, b: a + b)
    __sub__, __rsub__ = _operator(lambda a, b: a - b), _operator(lambda a, b: b - a)
    __mul__ = __rmul__ = _operator(lambda a, b: a * b)
    __truediv__, __rtruediv__ = _operator(lambda a, b: a / b), _operator(lambda a, b: b / a)

    def __neg__(self):
        return self * -1.0

    def __repr__(self):
        if self.error is None and self.pairs > 1 and math.isfinite(self.value):
            return f"about {self.value:.2g}"
        return number_text(self.value, self.error)


@dataclass(frozen=True, eq=False)
class Fraction(Number):
    """How many of independent runs ended so: successes of pairs; undecided: runs that may have, and are in neither.

    >>> Fraction(3, 5, undecided=1).value, Fraction(3, 5, undecided=1).counts
    (0.6, (3, 4))
    """

    successes: int
    pairs: int
    undecided: int = 0
    error = None

    @property
    def value(self):
        """The fraction, with undecided runs counted as no."""
        return self.successes / self.pairs

    @property
    def counts(self):
        """Successes with every undecided run counted as no, and as yes."""
        return self.successes, self.successes + self.undecided

    def interval(self, confidence=CONFIDENCE, runs=EXACT, value=None):
        """(low, high): the exact interval, with the undecided runs counted either way; beside a value of so many runs of somebody else's with
        their error too, so that less the value it is the interval of the difference (Newcombe 1998, method 10, of exact intervals)."""
        ends = [exact_interval(k, self.pairs, confidence) for k in self.counts]
        if runs == EXACT:
            return ends[0][0], ends[1][1]
        least, most = exact_interval(round(value * runs), runs, confidence)
        few, many = (k / self.pairs for k in self.counts)
        low = few - math.hypot(few - ends[0][0], most - value)
        return low, many + math.hypot(ends[1][1] - many, value - least)

    def chance(self, low, high, runs=EXACT):
        """p of a fraction as far beyond low to high, of so many runs (Fisher's test; the binomial one where it has no error): either way where both
        are the same number, else one-sided, and 1 within. The largest of all ways to count the undecided."""
        return max(self._chance(k, low, high, runs) for k in range(self.counts[0], self.counts[1] + 1))

    def _chance(self, k, low, high, runs):
        """The same of k successes; their count, where it is not whole, is rounded towards ours."""
        own = k / self.pairs
        if low < high and low <= own <= high:
            return 1.0
        limit, whole = (low, math.floor) if own < low else (high, math.ceil)
        way, whole = ("less" if own < low else "greater", whole) if low < high else ("two-sided", round)
        if runs == EXACT:
            return float(binomtest(k, self.pairs, limit, way).pvalue)
        theirs = whole(limit * runs)
        return float(fisher_exact([[k, self.pairs - k], [theirs, runs - theirs]], way)[1])

    def __repr__(self):
        return f"{self.successes} of {self.pairs}" + (f" ({self.undecided} undecided)" if self.undecided else "")


def mean(of_pairs):
    """Estimate of the mean of {pair's name: number}, at least one."""
    return mean_over_points(pandas.Series(of_pairs, dtype=float).to_frame(), np.ones(1))


def mean_over_points(table, weights):
    """Estimate of the mean over pairs of sum_k weights[k] y_k, from y as a DataFrame (a row a pair, its name the index; a column a
    point), weights (K,) of sum 1."""
    values = table.to_numpy(dtype=float)
    draws = [deviations(values @ weights, list(table.index))]
    if len(weights) > 1:
        names = ([f"{pair} at {k}" for pair in table.index] for k in range(len(weights)))
        draws.append(sum(weight * deviations(*own) for weight, *own in zip(weights, values.T, names)))
    value = float((values @ weights).mean())
    return Estimate(value, value + np.stack(draws), len(table))


def deviations(values, names):
    """Deviations (DRAWS,) of the mean of values (n,) of so named pairs; zeros for one."""
    if len(values) < 2:
        return np.zeros(DRAWS)
    weights = weights_of_pairs(names)
    return stretch(len(values)) * (weights @ (values - values.mean())) / weights.sum(axis=1)


def exact(value):
    """Estimate without scatter."""
    return Estimate(float(value), np.full((1, DRAWS), float(value)), EXACT)


def combine(f, *estimates):
    """Estimate of f(numbers): f is called once with the values, and once with all draws (arrays in, array out)."""
    with np.errstate(all="ignore"):
        value, draws = f(*(np.float64(e.value) for e in estimates)), f(*(e.draws for e in estimates))
    draws = np.asarray(draws, dtype=float) + np.zeros((1, DRAWS))  # of a function that ignores them, too
    pairs, freedom = min(e.pairs for e in estimates), min(e.freedom for e in estimates)
    return Estimate(float(value), draws, pairs, fitted=1 if pairs == EXACT else pairs - freedom)


def curve(f, x, estimates):
    """Estimate of f(x (K,), y (..., K)), for thresholds, fits and extrapolations; f works along the last axis."""
    x = np.asarray(x, dtype=float)
    return combine(lambda *y: f(x, np.stack(np.broadcast_arrays(*y), axis=-1)), *estimates)


def _scatter(row, value):
    """Root mean square of one row of draws about the value, which may stand at an end of them (1/E* of rigid-plastic spheres); None with LOST
    of them or more undefined, 0 where they agree to rounding."""
    good = row[np.isfinite(row)]
    if len(good) <= (1 - LOST) * len(row):
        return None
    spread = math.sqrt(np.mean((good - value) ** 2))
    return spread if spread > ROUNDING * np.abs(good).max() else 0.0


def number_text(value, error=None):
    """'54.0 ± 1.0': the value to two digits of its error, or to four of its own.

    >>> number_text(1.23456, 0.0191), number_text(1234.6, 21.0), number_text(0.5), number_text(None), number_text(12345.6, 1520.0)
    ('1.235 ± 0.019', '1235 ± 21', '0.5', '-', '12300 ± 1500')
    """
    if value is None or not math.isfinite(value):
        return "inf" if value == math.inf else "-"
    if not error:
        return f"{value:.4g}" if abs(value) < 1e4 else f"{value:.0f}"
    digits = 1 - math.floor(math.log10(float(f"{error:.1e}")))
    return f"{round(value, digits):.{max(0, digits)}f} ± {round(error, digits):.{max(0, digits)}f}"


def range_text(low, high):
    """'1 to 2', or 'above 1' and 'below 2' without the other end.

    >>> range_text(0.5, 2), range_text(0.5, math.inf)
    ('0.5 to 2', 'above 0.5')
    """
    if math.isinf(low) and math.isinf(high):
        return "no bound"
    if math.isinf(low) or math.isinf(high):
        return f"above {number_text(low)}" if math.isinf(high) else f"below {number_text(high)}"
    return f"{number_text(low)} to {number_text(high)}"
