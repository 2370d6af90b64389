"""Which runs are nearest to a query, and whether it is among them at all."""

import numpy as np
from scipy.spatial import cKDTree

from .variables import decided, scaled, variables

NEAREST = 5  # runs whose mean distance tells whether a query is within the data


class Neighbours:
    """Of the decided rows of a table of runs, in `runs`: distances in the coordinates of variables.scaled(), but for the impact parameter, each in
    units of its scatter among the runs."""

    def __init__(self, table):
        self.runs = decided(table).reset_index(drop=True)
        points = scaled(variables(self.runs))[:, :-1]
        self.scatter = points.std(axis=0)
        self.tree = cKDTree(points / self.scatter)
        own = self.tree.query(self.tree.data, NEAREST + 1)[0][:, 1:]
        self.usual = float(np.quantile(own.mean(axis=1), 0.95))

    def nearest(self, points):
        """(rows (n, NEAREST) of `runs`, beyond (n,)) of variables() points: the mean distance to these rows over the usual one, which 95 % of the
        runs have from each other or less; above 1 a query is an extrapolation."""
        distance, rows = self.tree.query(self._place(points), NEAREST)
        return rows, distance.mean(axis=1) / self.usual

    def within(self, points):
        """Number (n,) of runs at no more than the usual distance."""
        return self.tree.query_ball_point(self._place(points), self.usual, return_length=True)

    def _place(self, points):
        return scaled(points)[:, :-1] / self.scatter
