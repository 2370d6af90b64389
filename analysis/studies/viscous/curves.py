"""Means against velocity at one size and T_vis, with errors from the seeds."""

from dataclasses import dataclass

import numpy as np

from ...statistics import resampling_error
from .impact_mean import Draws, has_scatter, impact_mean

SAME = 2e-3  # relative: velocities that count as the same


@dataclass(frozen=True)
class Curve:
    """A mean over runs of `grains` grains an aggregate and viscous_time [s] against velocity: velocities (V,) [m/s], mean (V,),
    error (V,) (NaN: not known), resamples (B, V), pairs of aggregates (their number)."""

    grains: int
    viscous_time: float
    velocities: np.ndarray
    mean: np.ndarray
    error: np.ndarray
    resamples: np.ndarray
    pairs: int

    @property
    def has_errors(self):
        """Whether the seeds allow errors."""
        return bool(np.isfinite(self.error).any())

    def place(self, velocity):
        """Index of a velocity [m/s]; None where it is not among those of the curve."""
        found = np.flatnonzero(np.abs(self.velocities / velocity - 1) < SAME)
        return int(found[0]) if len(found) else None

    def at(self, velocity):
        """(mean, error; None: not known) at a velocity [m/s]; None where it is not among those of the curve."""
        k = self.place(velocity)
        if k is None:
            return None
        return float(self.mean[k]), float(self.error[k]) if np.isfinite(self.error[k]) else None


def of_other_pairs(resamples):
    """Resamples (B, ...) of one size that go with those of another: the sizes are independent pairs of aggregates, though
    their resamples came from the same random numbers."""
    return np.roll(resamples, 1, axis=0)


def with_error(value, error, digits=3):
    """'0.152 +- 0.012' with so many digits; '-' for None, the value alone without an error."""
    if value is None:
        return "-"
    return f"{value:.{digits}f}" + (f" +- {error:.{digits}f}" if error is not None else "")


def difference(first, second, velocity):
    """(mean, error; None: not known) of one Curve less another of the same pairs of aggregates at a velocity [m/s]; None where
    one of them doesn't have it."""
    i, j = first.place(velocity), second.place(velocity)
    if i is None or j is None:
        return None
    known = np.isfinite(first.error[i]) and np.isfinite(second.error[j])
    error = resampling_error(first.resamples[:, i] - second.resamples[:, j]) if known else None
    return float(first.mean[i] - second.mean[j]), error


def curves(table, values, mean=impact_mean):
    """{(grains, T_vis): Curve} of a table of runs and values (runs,) of its rows, by impact_mean or head_on_mean; without
    velocities where there is no such mean, and without curves of none."""
    found, table = {}, table.assign(averaged=values)
    for grains, of_size in table.groupby("grains"):
        draws = Draws(of_size.seed)
        for time, runs in of_size.groupby(of_size.viscoelasticTime.round(16)):
            own = _curve(int(grains), float(time), runs, draws, mean)
            if own is not None:
                found[int(grains), float(time)] = own
    return found


def _curve(grains, time, table, draws, mean):
    points = []
    for _, runs in table.groupby(table.velocity.round(6)):
        found = mean(runs, runs.averaged, draws)
        if found is not None:
            error = resampling_error(found[1]) if has_scatter(runs) else None
            points.append((float(runs.velocity.iloc[0]), float(found[0]), np.nan if error is None else error, found[1]))
    if not points:
        return None
    velocities, means, errors, resamples = zip(*points)
    arrays = (np.array(each, dtype=float) for each in (velocities, means, errors))
    return Curve(grains, time, *arrays, np.stack(resamples, axis=1), table.seed.nunique())
