"""Means against velocity at one size and T_vis, with errors from the seeds."""

from dataclasses import dataclass

import numpy as np

from ...statistics import resampling_error
from .grid import SAME, time_of_grid
from .impact_mean import Draws, impact_mean, whole_impacts


@dataclass(frozen=True)
class Curve:
    """A mean over runs of `grains` grains an aggregate and viscous_time [s] against velocity: velocities (V,) [m/s], mean (V,),
    error (V,) (NaN: not known, from one pair of aggregates), resamples (B, V), numbers (V,) of pairs, offsets (B_off^2, rising; the
    same at all velocities)."""

    grains: int
    viscous_time: float
    velocities: np.ndarray
    mean: np.ndarray
    error: np.ndarray
    resamples: np.ndarray
    numbers: np.ndarray
    offsets: tuple

    @property
    def pairs(self):
        """Pairs of aggregates behind the curve: the fewest at a velocity."""
        return int(self.numbers.min())

    @property
    def has_errors(self):
        """Whether the error is known at every velocity, so that what follows from all of them has one."""
        return bool(np.isfinite(self.error).all())

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
    one of them doesn't have it, or they are of other offsets."""
    i, j = first.place(velocity), second.place(velocity)
    if i is None or j is None or first.offsets != second.offsets:
        return None
    known = np.isfinite(first.error[i]) and np.isfinite(second.error[j])
    error = resampling_error(first.resamples[:, i] - second.resamples[:, j]) if known else None
    return float(first.mean[i] - second.mean[j]), error


def curves(table, values, mean=impact_mean, counted=whole_impacts):
    """{(grains, T_vis): Curve} of a table of runs and values (runs,) of its rows, by impact_mean of the runs of whole_impacts, or by
    head_on_mean of those of head_on_runs; without velocities where there is no such mean, and without curves of none."""
    found, table = {}, table.assign(averaged=values)
    for grains, of_size in table.groupby("grains"):
        draws = Draws(of_size.seed)
        for time, runs in of_size.groupby(of_size.viscoelasticTime.map(time_of_grid)):
            own = _curve(int(grains), float(time), *counted(runs), draws, mean)
            if own is not None:
                found[int(grains), float(time)] = own
    return found


def _curve(grains, time, table, offsets, draws, mean):
    points = []
    for _, runs in table.groupby(table.velocity.round(6)):
        found, number = mean(runs, runs.averaged, draws), runs.seed.nunique()
        if found is not None:
            error = resampling_error(found[1]) if number > 1 else None
            points.append((runs.velocity.iloc[0], found[0], np.nan if error is None else error, number, found[1]))
    if not points:
        return None
    velocities, means, errors, numbers, resamples = zip(*points)
    arrays = (np.array(each, dtype=float) for each in (velocities, means, errors))
    return Curve(grains, time, *arrays, np.stack(resamples, axis=1), np.array(numbers), offsets)
