"""Which runs are nearest to a query, and whether it is among them at all."""

from scipy.spatial import ConvexHull, QhullError, cKDTree

from .variables import decided, scaled, variables

NEAREST = 5  # runs that are shown
# In units of the scatter of the runs, whatever their number. With this margin the region of the first 700 runs holds 96 % of the next 700.
MARGIN, NEAR = 0.25, 0.7


class Neighbours:
    """Of the decided rows of a table of runs, in `runs`: distances in the coordinates of variables.scaled(), but for the impact parameter, each in
    units of its scatter among the runs. ValueError where they fill no region."""

    def __init__(self, table):
        self.runs = decided(table).reset_index(drop=True)
        points = scaled(variables(self.runs))[:, :-1]
        self.scatter = points.std(axis=0)
        self.tree = cKDTree(points / self.scatter)
        try:
            self.faces = ConvexHull(self.tree.data).equations
        except (QhullError, ValueError):
            raise ValueError(
                f"{len(points)} runs: fill no region in {points.shape[1]} variables; must be more"
            ) from None

    def nearest(self, points):
        """Rows (n, NEAREST) of `runs` that are nearest to variables() points."""
        return self.tree.query(self._place(points), NEAREST)[1]

    def beyond(self, points):
        """Distance (n,) of variables() points beyond the convex hull of the runs, negative inside of it; above MARGIN a query is an extrapolation."""
        return (self._place(points) @ self.faces[:, :-1].T + self.faces[:, -1]).max(axis=1)

    def within(self, points):
        """Number (n,) of runs at no more than NEAR."""
        return self.tree.query_ball_point(self._place(points), NEAR, return_length=True)

    def _place(self, points):
        return scaled(points)[:, :-1] / self.scatter
