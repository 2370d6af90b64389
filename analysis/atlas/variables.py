"""Coordinates of collisions in the atlas's model, which runs of the table count, and the region that they fill.

A point is a row of a DataFrame with the columns FEATURES; variables() makes points of a table of runs.
"""

from typing import NamedTuple

import numpy as np
import pandas
from scipy.spatial import ConvexHull, cKDTree

from ..measures.outcome import NEVER_MET, UNDECIDED
from ..theory import ICE, breaking_velocity, pair_constants, sticking_velocity_without_drag
from .rules import KINDS

FEATURES = ("velocity", "grains", "mass_ratio", "filling", "impact_square")
FIT, HELD_OUT = "fit", "held_out"  # values of the column `split`
CHOSEN = range(3_000, 10_000)  # `number` of the runs that were chosen by a model
# Each has a model and tables of its own: of the same filling, close-packed aggregates bounce several times as often.
STRUCTURES = {"grown": ("bcca", "bpca", "compressed"), "close-packed": ("cpe",)}
GROWN, CLOSE_PACKED = STRUCTURES
# In units of the scatter of the runs. With this margin the region of the first 700 runs holds 96 % of the next 700.
MARGIN, NEAR = 0.25, 0.7
NEAREST = 5  # runs


# What making and breaking one contact dissipates, over E_break, of every material: energy() of two grains at the
# highest velocity at which they stick.
ONE_CONTACT = (sticking_velocity_without_drag(pair_constants(ICE, 1e-7)) / breaking_velocity(ICE, 1e-7)) ** 2 / 4


def variables(table):
    """Points (n rows) of a table of runs with the columns of atlas.columns: velocity over v_break, grains of the larger
    aggregate, mass ratio (at most 1), filling factor (mean by mass of both), square of the impact parameter."""
    share = 1 / (1 + table.mass_ratio)
    return pandas.DataFrame(
        {
            "velocity": table.velocity / table.v_break,
            "grains": table.grains_target,
            "mass_ratio": table.mass_ratio,
            "filling": share * table.filling_target + (1 - share) * table.filling_projectile,
            "impact_square": table.impact**2,
        }
    )


def scaled(points):
    """Coordinates (n, 5) of points in which the model works: logarithms of the first three."""
    points = points[list(FEATURES)].to_numpy(dtype=float)
    return np.column_stack([np.log(points[:, :3]), points[:, 3:]])


def energy(points):
    """Kinetic energy of the collision over E_break (n,)."""
    return points.grains * points.mass_ratio / (1 + points.mass_ratio) * points.velocity**2 / 2


def of_structure(table, structure):
    """Rows of a table of runs that are of one of STRUCTURES."""
    return table[table.structure.isin(STRUCTURES[structure])]


def decided(table):
    """Rows to which a model may be fitted, or by which it is judged: the aggregates touched, the outcome is decided."""
    return table[~table.outcome.isin([NEVER_MET, UNDECIDED])]


def fit_and_held_out(table):
    """Two tables: the decided rows that a model may be fitted to, and those that are held out."""
    own = decided(table)
    return tuple(own[(own.split == FIT) == is_fit].reset_index(drop=True) for is_fit in (True, False))


def drawn(table):
    """Rows that were drawn at random: fractions of them are those of the space that they were drawn from.

    The others were chosen where a model was least sure; held-out rows among CHOSEN were not.
    """
    return table[~table.number.isin(CHOSEN) | (table.split == HELD_OUT)]


class Slow(NamedTuple):
    """Slow collisions, which all stick: `number` runs with an `energy` below this one [E_break] did, so that anything
    else has a chance of at most `most` there (95 %)."""

    energy: float
    number: int
    most: float


def slow(runs):
    """The Slow of decided rows of a table of runs."""
    own, sticks = energy(variables(runs)), runs.outcome == KINDS[0]
    limit = own.max() if sticks.all() else own[~sticks].min()
    number = int((own < limit).sum())
    return Slow(limit, number, 1 - 0.05 ** (1 / max(number, 1)))


class Region:
    """The region that the decided rows of a table of runs fill, and which of these rows are near to a point.

    Distances are in the coordinates of scaled(), each in units of its scatter among the runs; averaged: without the
    impact parameter. `runs` are the rows.
    """

    def __init__(self, table):
        self.runs = decided(table).reset_index(drop=True)
        self.slow = slow(self.runs[self.runs.split == FIT])
        points = scaled(variables(self.runs))
        self._scatter = points.std(axis=0)
        place = points / self._scatter
        self._trees = {True: cKDTree(place[:, :-1]), False: cKDTree(place)}
        self._faces = ConvexHull(place[:, :-1]).equations

    def nearest(self, points, averaged):
        """Rows (n, NEAREST) of `runs` that are nearest to points."""
        return self._trees[averaged].query(self._place(points, averaged), NEAREST)[1]

    def within(self, points, averaged):
        """Number (n,) of runs that are no farther than NEAR from points."""
        return self._trees[averaged].query_ball_point(self._place(points, averaged), NEAR, return_length=True)

    def beyond(self, points):
        """Distance (n,) of points from the convex hull of the runs, negative inside; above MARGIN is extrapolation.

        Collisions slower than any run that did not stick count as if they had that run's energy, `slow.energy`.
        Those below ONE_CONTACT are never beyond.
        """
        own = energy(points)
        faster = points.assign(velocity=points.velocity * np.sqrt(np.maximum(self.slow.energy / own, 1.0)))
        found = (self._place(faster, True) @ self._faces[:, :-1].T + self._faces[:, -1]).max(axis=1)
        return np.where(own < ONE_CONTACT, np.minimum(found, 0.0), found)

    def _place(self, points, averaged):
        place = scaled(points) / self._scatter
        return place[:, :-1] if averaged else place
