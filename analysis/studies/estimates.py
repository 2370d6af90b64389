"""Numbers of a table of runs (a pandas DataFrame, a row a run) with their standard errors.

A number is any function of the table, a statistic. Its error is the jackknife's over independent pairs of aggregates,
which the column `pair` tells apart: the statistic again without each pair in turn (Efron & Tibshirani 1993, eq 11.5).
Means, differences and ratios of the same pairs, thresholds and fits need nothing more."""

import math
from dataclasses import dataclass

import numpy as np
import pandas

from ..measures.compression import falls_through_zero
from ..measures.outcome import NEVER_MET, UNDECIDED
from ..runs.format import SAME


@dataclass(frozen=True)
class Estimate:
    """A number (NaN: not known) with its standard error (None: fewer than two pairs, or undefined without one of them;
    0: a closed form), the independent pairs behind it (0: a closed form), and of a fraction how it was counted, '3 of
    4'."""

    value: float
    error: float | None = 0.0
    pairs: int = 0
    counted: str = ""

    def __mul__(self, unit):
        return Estimate(self.value * unit, self.error and self.error * unit, self.pairs, self.counted)

    def __str__(self):
        behind = self.counted or self.pairs
        return number_text(self.value, self.error) + (f" ({behind})" if behind else "")


def where(runs, **values):
    """The runs with these values in their columns: numbers to a relative 1e-9, words as they are."""
    for name, value in values.items():
        column = runs[name].to_numpy()
        runs = runs[column == value if isinstance(value, str) else np.isclose(column, value, rtol=SAME, atol=0.0)]
    return runs


def estimate(statistic, runs):
    """Estimate of a statistic, a function from a DataFrame to a number (NaN where the runs do not suffice), of runs
    with the column `pair`, best those alone that it is about.

    >>> print(estimate(mean("d"), pandas.DataFrame({"pair": [1, 2, 3, 4], "d": [1.0, 2.0, 3.0, 4.0]})))
    2.50 ± 0.65 (4)
    """
    return estimates(lambda own: [statistic(own)], runs)[0]


def estimates(statistic, runs):
    """The same of a statistic that gives several numbers at once (a fit): list of Estimate."""
    pairs = runs["pair"].to_numpy()
    value = np.asarray(statistic(runs), dtype=float)
    names = pandas.unique(pairs)
    without = np.array([statistic(runs[pairs != name]) for name in names], dtype=float).reshape(len(names), len(value))
    return [_jackknife(*own) for own in zip(value, without.T)]


def _jackknife(value, without):
    """Estimate from a value and the same without each pair (n,); pairs that change nothing are not behind it."""
    behind = without[~(np.abs(without - value) <= 1e-13 * np.abs(value))]  # but for rounding
    n = len(behind) or len(without)
    if len(behind) < 2 or not np.isfinite(behind).all():
        return Estimate(float(value), None, n)
    return Estimate(float(value), math.sqrt((n - 1) / n * np.sum((behind - behind.mean()) ** 2)), n)


def mean(values):
    """Statistic: the mean over pairs of each pair's mean of a column, or of a function from runs to values (runs,),
    without NaN."""

    def of(runs):
        own = values(runs) if callable(values) else runs[values]
        return own.groupby(runs["pair"]).mean().mean()

    return of


def average(values):
    """Estimate of the mean of independent values (n,), without NaN."""
    values = values.dropna()
    return Estimate(values.mean(), values.std() / len(values) ** 0.5 if len(values) > 1 else None, len(values))


def beside(statistic, one, other, of=np.subtract):
    """Estimate of of(statistic(one), statistic(other)), a difference or a ratio: of the pairs that are in both tables
    of runs, or of all where none is."""
    shared = set(one["pair"]) & set(other["pair"])
    one, other = (own[own["pair"].isin(shared)] if shared else own for own in (one, other))
    both = pandas.concat([one.assign(first=True), other.assign(first=False)], ignore_index=True)
    return estimate(lambda runs: of(statistic(runs[runs["first"]]), statistic(runs[~runs["first"]])), both)


def fraction(runs, so, undecided=None):
    """Estimate of the fraction of runs that are so (Series of bool): p = (k + 1)/(n + 2), with the binomial error [p
    (1 - p)/n]^(1/2); undecided (Series of bool): which runs count neither way. ValueError where a pair has several
    runs."""
    if runs["pair"].duplicated().any():
        raise ValueError("a fraction of runs: a pair has several runs; must have one")
    open_runs = 0 if undecided is None else int(undecided.sum())
    k, n = int(so.sum()), len(runs) - open_runs
    if n < 1:
        return Estimate(math.nan, None, 0)
    p = (k + 1) / (n + 2)
    return Estimate(p, math.sqrt(p * (1 - p) / n), n, f"{k} of {n}" + (f", {open_runs} undecided" if open_runs else ""))


def ending(runs, outcome):
    """Estimate of the fraction of runs that end so (an outcome of measures.outcome), of those that met and are
    decided."""
    met = runs[runs.outcome != NEVER_MET]
    return fraction(met, met.outcome == outcome, met.outcome == UNDECIDED)


def threshold(x, y):
    """x at which y (K,) first falls from above 0 to 0 or below, linear between rising x (K,); NaN where it does not.
    Of mean growth efficiency against velocity: the threshold velocity of fragmentation (Arakawa et al. 2022, section
    3.2)."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    falls = falls_through_zero(x, y)
    return falls[0] if len(falls) else math.nan


def zero_of_fit(x, y):
    """x at which y (K,), fitted linear in ln x, is 0; NaN with fewer than three values of x (K,). Of growth efficiency
    against velocity: above it targets lose more than they gain."""
    x, y = np.log(np.asarray(x, dtype=float)), np.asarray(y, dtype=float)
    if len(np.unique(x)) < 3:
        return math.nan
    away = x - x.mean()
    return float(np.exp(x.mean() - y.mean() * (away @ away) / (away @ y)))


def exponent(x, y):
    """n of y ~ x^n: least squares of the logarithms; NaN with fewer than three points, or where one of y is not
    positive."""
    x, y = np.asarray(x, dtype=float), np.asarray(y, dtype=float)
    if len(x) < 3 or not (y > 0).all():
        return math.nan
    away = np.log(x) - np.log(x).mean()
    return float(np.log(y) @ away / (away @ away))


def number_text(value, error=None):
    """'54.0 ± 1.0': the value to two digits of its error, or to four of its own.

    >>> number_text(1.23456, 0.0191), number_text(12345.6, 1520.0), number_text(0.5)
    ('1.235 ± 0.019', '12300 ± 1500', '0.5')
    """
    if not math.isfinite(value):
        return "inf" if value == math.inf else "-"
    if not error:
        return f"{value:.4g}" if abs(value) < 1e4 else f"{value:.0f}"
    digits = 1 - math.floor(math.log10(float(f"{error:.1e}")))
    return f"{round(value, digits):.{max(0, digits)}f} ± {round(error, digits):.{max(0, digits)}f}"
