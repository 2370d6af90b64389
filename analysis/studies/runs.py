"""Groups of a table of runs, and estimates of each."""

from copy import copy
from functools import reduce

import numpy as np
import pandas

from ..printable import suggested
from .estimate import Estimate, Fraction, curve, mean_over_points, stretch, weights_of_pairs

SAME = 2e-3  # relative: numbers are printed so, 50.1 for 10^1.7


class SeveralRuns(ValueError):
    """A pair of aggregates that would count more than once; the message is one line."""


class Runs:
    """A table of runs (DataFrame, a row a run), and what is independent in it.

    pair        column that names a pair of aggregates
    population  columns whose values have pairs of their own (the number of grains: pair 1 of 500 is not pair 1 of 2,000)

    KeyError for a column that the table lacks, here and of `by` below."""

    def __init__(self, table, pair="seed", population=()):
        _columns(table, (pair, *population))
        self.table, self.pair, self.population = table, pair, tuple(population)
        self.average, self.points, self.weights = None, (0,), np.ones(1)

    def of(self, table):
        """The same for another table."""
        found = copy(self)
        found.table = table
        return found

    def where(self, which=None, /, **values):
        """The runs with these values in their columns (as alike() has it), of those for which which(table) is true."""
        table = self.table if which is None else self.table[np.asarray(which(self.table), dtype=bool)]
        for name, value in values.items():
            table = table[alike(table[name], value)]
        return self.of(table)

    def over(self, column, points, rule=None):
        """The same, with each pair averaged over a column (offsets, say) before the pairs are. points: the values that a pair must have
        all of to count; rule(points (K,), rising) -> weights (K,); None: equal."""
        found = copy(self)
        found.average, found.points = column, np.sort(np.asarray(points, dtype=float))
        found.weights = np.ones(len(found.points)) if rule is None else np.asarray(rule(found.points), dtype=float)
        return found

    def estimates(self, values, by):
        """Series of Estimate of the mean over pairs, by the columns `by`: of a column, or of a function table -> (runs,). Runs without
        a value (NaN) don't count."""
        keys = _columns(self.table, by)
        values = pandas.Series(np.asarray(self._values(values), dtype=float), self.table.index)
        point, number = pandas.Series(0, self.table.index), len(self.points)
        if self.average:
            x = self.table[self.average].to_numpy(dtype=float)
            places = np.abs(x[:, None] - self.points).argmin(axis=1)
            point = pandas.Series(places, self.table.index).where(alike(x, self.points[places]))
        pair, point = self._names(self.table).rename("_pair"), point.rename("_point")
        cells = values.groupby([*keys, pair, point]).mean().unstack("_point").reindex(columns=range(number)).dropna()
        weights = self.weights / self.weights.sum()
        groups = _groups(cells, by, levels=True)
        return _series({key: mean_over_points(own.droplevel(list(by)), weights) for key, own in groups}, by)

    def parts(self, of, by, level):
        """Series of estimates of several things, {label: column or function}, by the columns `by` and `level`: the label."""
        return together({label: self.estimates(values, by) for label, values in of.items()}, level)

    def shares(self, of, total, by, level):
        """The same over the estimates of a total (a column or function)."""
        total = self.estimates(total, by)
        return together({label: ratios(self.estimates(values, by), total) for label, values in of.items()}, level)

    def beside(self, level, reference, values, by, of, same_pairs=False):
        """Series of of(estimates, estimates) (differences, ratios), by the columns `by` and `level`: of `values` at every other value of a
        column, and at its reference. Of the pairs that both have in a group; where they share none, of all, unless it must be the
        same_pairs."""
        plain, found = self.where(**{level: reference}), {}
        others = self.where(lambda table: ~alike(table[level], reference))
        for value in sorted(set(others.table[level])) or [reference]:
            first, second = _shared(others.where(**{level: value}), plain, by, same_pairs)
            found[value] = of(first.estimates(values, by), second.estimates(values, by))
        return together(found, level)

    def fractions(self, values, by, undecided=None):
        """Series of Fraction: of runs for which a column, or a function table -> (runs,), is true; undecided: the same for runs that are
        counted apart. A pair counts once: where it has several runs in a group, SeveralRuns."""
        maybe = pandas.Series(False, self.table.index) if undecided is None else self._values(undecided).astype(bool)
        table = self.table.assign(value=self._values(values).astype(bool) & ~maybe, maybe=maybe)
        found = {}
        for key, rows in _groups(table, by):
            twice = self._names(rows).duplicated(keep=False)
            if twice.any():
                place = ", ".join(f"{name} = {value}" for name, value in zip(by, key))
                runs = ", ".join(map(str, rows[twice].get("run", [])[:2]))
                raise SeveralRuns(f"{place}: a pair of aggregates has several runs ({runs}); must have one")
            found[key] = Fraction(int(rows.value.sum()), len(rows), int(rows.maybe.sum()))
        return _series(found, by)

    def fit(self, f, names, by=(), fitted=None):
        """Series of Estimate, by the columns `by` and `number`: names of the K numbers that f(rows (DataFrame), weights (B, n)) -> (B, K)
        fits to all runs of a group at once. fitted: numbers fitted that count against the pairs (None: K)."""
        found = {}
        for key, rows in _groups(self.table, by):
            labels, n = self._names(rows).to_list(), self._names(rows).nunique()
            value = np.asarray(f(rows, np.ones((1, len(rows)))), dtype=float)[0]
            draws = np.asarray(f(rows, weights_of_pairs(labels)), dtype=float)
            count = len(names) if fitted is None else fitted
            drawn = value + (stretch(n, count) if n > count else np.nan) * (draws - value)
            for k, name in enumerate(names):
                found[(*key, name)] = Estimate(float(value[k]), drawn[None, :, k], n, fitted=count)
        return _series(found, (*by, "number"))

    def _names(self, rows):
        """Names of the pairs of a table's rows: with the population, so that they are unique."""
        columns = [column.astype(str) for column in _columns(rows, (*self.population, self.pair))]
        return columns[0].str.cat(columns[1:], sep="|") if len(columns) > 1 else columns[0]

    def _values(self, values):
        return values(self.table) if callable(values) else self.table[values]


def _shared(first, second, by, only):
    """Two Runs without those of pairs that only one has, in groups by columns where they share some; only: in all groups. Of averages over
    points a pair has in both the same of them."""
    points = lambda own: own.table[own.average].map(_key) if own.average else [None] * len(own.table)
    keys = [
        list(zip(*(own.table[name].map(_key) for name in by), points(own), own._names(own.table)))
        for own in (first, second)
    ]
    both = set(keys[0]) & set(keys[1])
    groups = {key[: len(by)] for key in both}
    kept = ([key in both or not (only or key[: len(by)] in groups) for key in own] for own in keys)
    return tuple(own.of(own.table[np.array(keep, dtype=bool)]) for own, keep in zip((first, second), kept))


def along(series, level, f, of=curve):
    """Series of Estimate of f(x (K,), y (..., K)) along one level of a Series of Estimate, x rising, for every value of the others.
    of(f, x, estimates): what makes the Estimate."""
    others = [name for name in series.index.names if name != level]
    groups = ((key, own.sort_index(level=level)) for key, own in _groups(series, others, levels=True))
    found = {key: of(f, own.index.get_level_values(level), own.to_list()) for key, own in groups}
    return _series(found, others)


def differences(first, second):
    """Series of first less second, where both have an estimate."""
    first, second = first.align(second, join="inner")
    return first - second


def ratios(first, second):
    """Series of first over second, where both have an estimate, and second is told from 0 by two of its standard errors."""
    known = [abs(estimate.value) > 2 * (estimate.error or 0.0) for estimate in second]
    first, second = first.align(second[known], join="inner")
    return first / second


def together(of, level, names=()):
    """One Series of {label: Series of the same levels}, with the label as one more level; names: of these levels, where there may be none."""
    frames = {label: own for label, own in of.items() if len(own)}
    if not frames:
        return _series({}, (*(next(iter(of.values())).index.names if of else names), level))
    names = list(next(iter(frames.values())).index.names)
    frames = {label: own.reorder_levels(names) if len(names) > 1 else own for label, own in frames.items()}
    joined = pandas.concat(frames, names=[level])
    return joined.reorder_levels([*joined.index.names[1:], level])


def finite(series):
    """The estimates of a Series that have a value: fits have none with too few runs."""
    return series[[bool(np.isfinite(estimate.value)) for estimate in series]]


def each(series, f):
    """Series of f(estimate, *its values of the levels)."""
    return pandas.Series([f(own, *key) for key, own in keyed(series)], series.index, dtype=object)


def at(series, **where):
    """The one Estimate or Fraction of a Series at these values of its levels (numbers to SAME); None where there is none. KeyError for a
    level that it lacks, ValueError where several are left."""
    known = [name for name in series.index.names if name is not None]
    for name in where:
        if name not in known:
            raise KeyError(f"no level {name}{suggested(name, known)}")
    left = select(series, **where)
    if len(left) > 1:
        raise ValueError(f"{where}: {len(left)} estimates: must be one, by {', '.join(known)}")
    return left.iloc[0] if len(left) else None


def select(series, **where):
    """The part of a Series at these values of some levels, without these levels; one of which a tuple of values is wanted stays."""
    for name, value in where.items():
        series = series[alike(series.index.get_level_values(name), value)]
    single = [name for name, value in where.items() if not isinstance(value, tuple)]
    return series.droplevel(single) if len(single) < series.index.nlevels else series


def alike(values, wanted):
    """Whether values, one or (n,), are printed as wanted: a number or (n,) numbers, a word, or a tuple, for one of these. Whole numbers
    (seeds, grains) must be equal.

    >>> alike([50.1, 0.0], 10**1.7).tolist(), alike(["a", "b"], "b").tolist(), alike([1, 2], (2, 3)).tolist()
    ([True, False], [False, True], [False, True])
    """
    values = np.asarray(values)
    if isinstance(wanted, tuple):
        return reduce(np.logical_or, (alike(values, one) for one in wanted), np.zeros(values.shape, dtype=bool))
    if isinstance(wanted, str) and values.dtype.kind in "fiub":
        return np.zeros(values.shape, dtype=bool)
    if values.dtype.kind not in "fiu":
        return values == wanted
    whole = (values == np.round(values)) & (wanted == np.round(wanted))
    return np.where(
        whole, values == wanted, np.abs(values - wanted) <= SAME * np.maximum(np.abs(values), np.abs(wanted))
    )


def keyed(series):
    """((value of each level, ...), value) of a Series."""
    return ((key if isinstance(key, tuple) else (key,), value) for key, value in series.items())


def _groups(own, by, levels=False):
    """((key, ...), part) of a table by columns, or of what has them as levels of its index."""
    if not by:
        yield (), own
        return
    keys = list(by) if levels else _columns(own, by)
    how = {"level" if levels else "by": keys if len(keys) > 1 else keys[0]}
    for key, part in own.groupby(**how):
        yield key if isinstance(key, tuple) else (key,), part


def _columns(table, names):
    """Columns of a table, as values that are the same where they are printed so; KeyError for one that it lacks."""
    for name in names:
        if name not in table:
            raise KeyError(f"table of runs: no {name}{suggested(name, table.columns)}")
    return [table[name].map(_key) for name in names]


def _key(value):
    return float(f"{value:.9g}") if isinstance(value, float) else value


def _series(found, by):
    if not by:
        return pandas.Series(list(found.values()), dtype=object)
    index = pandas.MultiIndex.from_tuples(list(found), names=list(by))
    return pandas.Series(list(found.values()), index, dtype=object)
