"""Which runs are nearest to a query, and whether it is among them at all."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import ConvexHull, QhullError, cKDTree

from ..theory import ICE, pair_constants, sticking_velocity_without_drag
from .columns import breaking_velocity
from .rules import KINDS
from .variables import FIT, decided, energy, scaled, variables

NEAREST = 5  # runs that are shown
# In units of the scatter of the runs, whatever their number. With this margin the region of the first 700 runs holds 96 % of the next 700.
MARGIN, NEAR = 0.25, 0.7
# Over E_break, whatever the material: what making and breaking one contact dissipates, which is energy() of two grains at the fastest at which
# they stick.
ONE_CONTACT = (sticking_velocity_without_drag(pair_constants(ICE, 1e-7)) / breaking_velocity(ICE, 1e-7)) ** 2 / 4


@dataclass(frozen=True)
class Slow:
    """Collisions that have done nothing but stick.

    energy  kinetic energy over E_break below which all runs did
    number  of these
    most    95 % upper limit of the chance of anything else there, from their number: the upper end of an interval of 90 %"""

    energy: float
    number: int
    most: float


def slow(runs):
    """Slow, of decided rows of a table of runs."""
    own, sticks = energy(variables(runs)), runs.outcome == KINDS[0]
    limit = own.max() if sticks.all() else own[~sticks].min()
    number = int((own < limit).sum())
    return Slow(limit, number, 1 - 0.05 ** (1 / max(number, 1)))


class Neighbours:
    """Of the decided rows of a table of runs, in `runs`: distances in the coordinates of variables.scaled(), each in units of its scatter among
    the runs; without the impact parameter where a query is averaged over it. ValueError where they fill no region."""

    def __init__(self, table):
        self.runs = decided(table).reset_index(drop=True)
        self.slow = slow(self.runs[self.runs.split == FIT])
        points = scaled(variables(self.runs))
        self.scatter = points.std(axis=0)
        place = points / self.scatter
        self.tree, self.tree_of_impact = cKDTree(place[:, :-1]), cKDTree(place)
        try:
            self.faces = ConvexHull(self.tree.data).equations
        except (QhullError, ValueError):
            raise ValueError(f"{len(points)} runs: fill no region in {self.tree.m} variables; must be more") from None

    def nearest(self, points, averaged):
        """Rows (n, NEAREST) of `runs` that are nearest to variables() points; averaged: at any impact parameter."""
        return self._tree(averaged).query(self._place(points, averaged), NEAREST)[1]

    def beyond(self, points):
        """Distance (n,) of variables() points beyond the convex hull of the runs, negative inside of it; above MARGIN a query is an extrapolation.

        Where all runs stick, slower collisions are taken to: those below `slow.energy` are where they would be with that energy, and those below
        ONE_CONTACT beyond nowhere."""
        own = energy(points)
        faster = points.assign(velocity=points.velocity * np.sqrt(np.maximum(self.slow.energy / own, 1.0)))
        found = (self._place(faster, True) @ self.faces[:, :-1].T + self.faces[:, -1]).max(axis=1)
        return np.where(own < ONE_CONTACT, np.minimum(found, 0.0), found)

    def within(self, points, averaged):
        """Number (n,) of runs at no more than NEAR; averaged: at any impact parameter."""
        return self._tree(averaged).query_ball_point(self._place(points, averaged), NEAR, return_length=True)

    def _tree(self, averaged):
        return self.tree if averaged else self.tree_of_impact

    def _place(self, points, averaged):
        place = scaled(points) / self.scatter
        return place[:, :-1] if averaged else place
