"""Tables of outcomes on a grid (outcomes.txt): read, written, looked up. Their first lines describe them.

from analysis.atlas.outcome_table import read_outcomes
table = read_outcomes("analysis/gallery/atlas/outcomes.txt")
table.lookup(velocity=[1, 10], grains=500, mass_ratio=1, filling=0.15)["p_sticking"]
"""

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from scipy.interpolate import RegularGridInterpolator

from ..arrays import numbers
from ..printable import Refused, suggested
from ..runs.files import write_file
from .rules import KINDS, OF_KIND

PROBABILITIES, ERRORS = (tuple(f"{what}_{kind}" for kind in KINDS) for what in ("p", "error"))
TOUCHING = "p_touching"
LEFT = ("largest", "second", "fragment_index", "filling_after")  # of the aggregates
INTERVALS = ("largest_low", "largest_high", "filling_after_low", "filling_after_high")
INSIDE = "inside"  # 1 within the data and 0 outside
COLUMNS = (*PROBABILITIES, *ERRORS, TOUCHING, *LEFT, *OF_KIND, INSIDE, "runs")

SCALES = {"log10": np.log10, "linear": np.asarray}
OF_MAXWELL = "velocity: rms of a Maxwell distribution"  # a comment of tables that maxwell() has made
ROUNDING = 1e-7  # of the sum of a query's weights; nodes in a file have nine digits


@dataclass(frozen=True)
class Axis:
    """An axis of a table: name, scale ("log10" or "linear") and nodes (n,), increasing, n >= 2."""

    name: str
    scale: str
    nodes: np.ndarray

    def position(self, value):
        """Place of values between the nodes, 0 to n - 1: linear in the scaled value; beyond an end that of the end.

        ValueError for NaN and negative values.
        """
        value = np.asarray(value, dtype=float)
        if not np.all(value >= 0.0):
            raise ValueError(f"{self.name} = {np.min(value):g}: must be 0 or more")
        with np.errstate(divide="ignore"):
            scaled = SCALES[self.scale](value)
        return np.interp(scaled, SCALES[self.scale](self.nodes), np.arange(len(self.nodes)))

    def beyond(self, value):
        """-1 below the first node, 1 above the last, 0 between, for each value."""
        first, last = self.nodes[0] * (1 - ROUNDING), self.nodes[-1] * (1 + ROUNDING)
        return (np.asarray(value) > last).astype(int) - (np.asarray(value) < first)


def axes_of(velocity, grains, mass_ratio, filling):
    """The axes that every table of outcomes has, of these nodes."""
    scaled = {"velocity": velocity, "grains": grains, "mass_ratio": mass_ratio}
    return (*(Axis(name, "log10", nodes) for name, nodes in scaled.items()), Axis("filling", "linear", filling))


@dataclass(frozen=True)
class OutcomeTable:
    """A table on a grid: axes (of Axis), columns (names), values (nodes of each axis, columns) and comments (lines)."""

    axes: tuple
    columns: tuple
    values: np.ndarray
    comments: tuple = ()

    def column(self, name):
        """Values (nodes of each axis) of a column."""
        return self.values[..., self.columns.index(name)]

    def lookup(self, columns=None, **query):
        """Values between the nodes: multilinear in the scaled coordinates; beyond an edge those of the edge.

        Parameters
        ----------
        columns : list of str, optional
            All by default; `inside` always comes too.
        **query : float or array
            A value of every axis by its name, 0 or more; they broadcast.

        Returns
        -------
        dict of arrays
            By column. `inside` is below 1 where the values are extrapolated: 0 beyond an edge, and between next to a
            node without data.
        """
        names = [axis.name for axis in self.axes]
        if sorted(query) != sorted(names):
            raise ValueError(f"lookup of {', '.join(sorted(query))}: must be of {', '.join(names)}")
        wanted = tuple(dict.fromkeys((*(self.columns if columns is None else columns), INSIDE)))
        if unknown := [name for name in wanted if name not in self.columns]:
            raise ValueError(f"table of outcomes: no column {unknown[0]}{suggested(unknown[0], self.columns)}")
        given = np.broadcast_arrays(*(numbers(name, query[name], gaps=True) for name in names))
        places = np.stack([axis.position(value) for axis, value in zip(self.axes, given)], axis=-1)
        values = self.values[..., [self.columns.index(name) for name in wanted]]
        found = RegularGridInterpolator([np.arange(n) for n in values.shape[:-1]], values)(places)
        found = found.reshape((*places.shape[:-1], len(wanted)))  # of single numbers: not an array of one
        inside = found[..., wanted.index(INSIDE)]
        inside[np.any([axis.beyond(value) != 0 for axis, value in zip(self.axes, given)], axis=0)] = 0.0
        inside[inside > 1.0 - ROUNDING] = 1.0
        return {name: found[..., k] for k, name in enumerate(wanted)}

    def maxwell(self):
        """The same table for Maxwell-distributed speeds, its first axis being their root mean square.

        The distribution is that of collisions, v^3 exp(-3 v^2 / 2 <v^2>), as faster aggregates meet more often; with
        a threshold it gives the probability of DustPy (Stammler & Birnstiel 2022). `inside` becomes the fraction of
        collisions that are inside. Intervals are left out: means of their ends are no ends of an interval. Columns
        rules.OF_KIND are means over the collisions with that outcome. Refused for a table that is one.
        """
        if OF_MAXWELL in self.comments:
            raise Refused(f"table of outcomes: {OF_MAXWELL}; must be one of single speeds")
        all_speeds, between_ends = _maxwell_weights(self.axes[0])
        columns = tuple(name for name in self.columns if name not in INTERVALS)
        own = self.values[..., [self.columns.index(name) for name in columns]]
        values = np.tensordot(all_speeds, own, 1)
        for name, kind in OF_KIND.items():
            if {name, f"p_{kind}"} <= set(columns):
                k, p = columns.index(name), columns.index(f"p_{kind}")
                of_all, often = np.tensordot(all_speeds, own[..., k] * own[..., p], 1), values[..., p]
                values[..., k] = np.divide(of_all, often, out=values[..., k], where=often > 0)
        inside = columns.index(INSIDE)
        values[..., inside] = np.tensordot(between_ends, own[..., inside], 1)
        return replace(self, columns=columns, values=values, comments=(*self.comments, OF_MAXWELL))


def _maxwell_weights(axis):
    """Weights (rms, speed) of the nodes of an axis: of all collisions, and of those between its ends."""
    x = np.geomspace(1e-2, 5.0, 2000)  # speed over the rms
    density = x**4 * np.exp(-1.5 * x**2)  # per logarithm of x
    density /= density.sum()
    weights = np.zeros((2, len(axis.nodes), len(axis.nodes)))
    for row, rms in enumerate(axis.nodes):
        position = axis.position(rms * x)
        below = np.minimum(position.astype(int), len(axis.nodes) - 2)
        for of, part in zip(weights, (density, density * (axis.beyond(rms * x) == 0))):
            np.add.at(of[row], below, part * (1.0 - position + below))
            np.add.at(of[row], below + 1, part * (position - below))
    return weights


def read_outcomes(path):
    """OutcomeTable of a file; Refused where it is none."""
    lines = Path(path).read_text(encoding="ascii", errors="replace").split("\n")
    comments = tuple(line[1:].strip() for line in lines if line.startswith("#"))
    rows = iter([line.split() for line in lines if line.strip() and not line.startswith("#")])
    try:
        axes = tuple(_axis(next(rows)) for _ in range(int(next(rows)[0])))
        _, columns = next(rows), tuple(next(rows))
        values = np.array([[float(word) for word in row] for row in rows])
        values = values.reshape(*(len(axis.nodes) for axis in axes), len(columns))
    except (StopIteration, IndexError, ValueError) as error:  # words where numbers must be, or an end too early
        must = "must be a table of outcomes, as write_outcomes() makes it"
        raise Refused(f"{path}: {must}: {error}") from None
    if INSIDE not in columns or not np.isfinite(values).all():
        raise Refused(f"{path}: must have a column `{INSIDE}`, and numbers everywhere")
    return OutcomeTable(axes, columns, values, comments)


def _axis(words):
    name, number, scale = words[0], int(words[1]), words[2]
    nodes = np.array([float(word) for word in words[3 : 3 + number]])
    if scale not in SCALES or len(nodes) != number or number < 2 or np.any(np.diff(nodes) <= 0.0) or nodes[0] < 0.0:
        must = "2 or more, increasing, log10 or linear"
        raise ValueError(f"axis {name}: {scale}, {len(nodes)} of {number} nodes; must be {must}")
    return Axis(name, scale, nodes)


def write_outcomes(path, table):
    """Write an OutcomeTable, so that Fortran's list-directed reads take it, but for the comments.

    First the table's comments; then the number of axes, a line an axis (name, number of nodes, scale, nodes), the
    number of columns, their names, and a row a node, the last axis fastest.
    """
    lines = [f"# {comment}".rstrip() for comment in table.comments]
    lines += [f"{len(table.axes)} number of axes: name, number of nodes, scale, nodes"]
    lines += [" ".join([a.name, str(len(a.nodes)), a.scale, *(f"{node:.9g}" for node in a.nodes)]) for a in table.axes]
    lines += [f"{len(table.columns)} number of columns", " ".join(table.columns)]
    lines += [" ".join(f"{value:.6g}" for value in row) for row in table.values.reshape(-1, len(table.columns))]
    write_file(path, "\n".join(lines) + "\n")
