"""A compression against the filling factor: from the history of a run to values at fixed filling factors.

The pressure is the work of the grains on the boundaries over the change of volume. Between two samples that is the mean of the virial's
pressure (K13 eq 21, damping forces included) over all steps between them, as K13 averages; the virial's own series is of the moment of
each sample, which misses oscillations faster than samples."""

import numpy as np

from ...theory.aggregates import bcca_coordination
from ...theory.compression import compressive_strength_dense

# Eight a decade from 0.001 to 0.24, where a bin reaches half-way to its neighbours. Above, pressure rises too steeply for bins as wide:
# these are narrow, and the last are those that runs to 0.5 and 0.64 cover.
LOOSE = 10.0 ** (np.arange(-24, -4) / 8.0)
DENSE = np.array([0.30, 0.35, 0.40, 0.45, 0.49, 0.55, 0.60, 0.625])
FILLINGS = np.concatenate([LOOSE, DENSE])
# A bin is from its filling factor over this to that times this.
HALF_BINS = np.concatenate([np.full(len(LOOSE), 10.0 ** (1.0 / 16.0)), np.full(len(DENSE), 1.02)])
AVERAGED = 1000.0  # t0 over which K13 averages the pressure (section 2.4)


def compressing(history):
    """(T,) bool: the samples up to the largest filling factor; those after it are of the stretching."""
    return np.arange(len(history["filling"])) <= int(np.argmax(history["filling"]))


def volume(history):
    """Volume of the cell (T,) [m^3]."""
    return np.prod([history[f"edge_{axis}"] for axis in "xyz"], axis=0)


def windows(time, width):
    """(first, last + 1) of the samples, time (T,), in each window of that width, one after the other; the last, incomplete window is left
    out, unless it is the only one."""
    number = np.floor((time - time[0]) / width).astype(int)
    starts = np.flatnonzero(np.diff(number, prepend=-1))
    ends = np.append(starts[1:], len(time))
    whole = max(1, len(starts) - 1)
    return list(zip(starts[:whole], ends[:whole]))


def pressures(history):
    """(filling factors (K,), pressures (K,) [Pa]) between the samples while the cell shrinks, the fillings half-way."""
    part = compressing(history)
    filling, size = history["filling"][part], volume(history)[part]
    return np.sqrt(filling[1:] * filling[:-1]), np.diff(history["boundaryWork"][part]) / np.diff(size)


def pressure_over(history, width):
    """(filling factors (K,), pressures (K,) [Pa]) over successive windows of `width` [s] while the cell shrinks (K13 section 2.4)."""
    return _work_over_volume(history, compressing(history), width)


def tension(history, width):
    """(filling factors (K,), tensions (K,) [Pa]) over successive windows of `width` [s] while the cell is stretched. Along one axis it is the
    stress on that axis, the tangential forces included. Empty without stretching."""
    after = ~compressing(history)
    after[np.argmax(history["filling"])] = True
    if after.sum() < 3:
        return np.array([]), np.array([])
    fillings, pressures = _work_over_volume(history, after, width)
    return fillings, -pressures


def _work_over_volume(history, part, width):
    time, work, filling = (history[name][part] for name in ("time", "boundaryWork", "filling"))
    size = volume(history)[part]
    # From the first sample of a window to that of the next.
    edges = [(a, min(b, len(time) - 1)) for a, b in windows(time, width) if a < len(time) - 1]
    pressures = [(work[b] - work[a]) / (size[b] - size[a]) for a, b in edges]
    return np.array([filling[a : b + 1].mean() for a, b in edges]), np.array(pressures)


def pressure_at(history):
    """Pressure (K,) [Pa] at FILLINGS: the mean, over the time that the cell spends in the bin around each, of the pressure over that of T23's
    formula, times the formula at the filling factor itself, so that the bin's width leaves no bias where the pressure rises as the
    formula does. NaN where the run does not cover the bin."""
    between, pressure = pressures(history)
    ratio = pressure / compressive_strength_dense(between, 1.0)
    return compressive_strength_dense(FILLINGS, 1.0) * _binned(history, between, ratio)


def coordination_at(history):
    """Coordination number (K,) at FILLINGS: as pressure_at(), by the difference from A24 eq 45."""
    part = compressing(history)
    filling = history["filling"][part]
    away = history["coordination"][part] - bcca_coordination(filling)
    return bcca_coordination(FILLINGS) + _binned(history, filling, away)


def _binned(history, places, values):
    """Means (K,) of values (M,) at filling factors `places` (M,) over the bins; NaN where the run does not cover one."""
    first, last = history["filling"][0], history["filling"].max()
    found = np.full(len(FILLINGS), np.nan)
    for k, (low, high) in enumerate(zip(FILLINGS / HALF_BINS, FILLINGS * HALF_BINS)):
        inside = (places >= low) & (places < high)
        if inside.any() and first <= low and last >= high * (1.0 - 1e-9):
            found[k] = values[inside].mean()
    return found


def at_filling(history, name, filling):
    """Value of a series when the filling factor is reached, linear between samples; NaN outside of the run."""
    part = compressing(history)
    return float(np.interp(filling, history["filling"][part], history[name][part], left=np.nan, right=np.nan))


def filling_at_pressure(history, pressure, width):
    """The filling factor from which on the pressure, averaged over `width` [s], stays above `pressure` [Pa]; NaN where it never does, or
    always did."""
    fillings, pressures = pressure_over(history, width)
    k = _last_below(pressures < pressure)
    if k is None:
        return float("nan")
    logarithms = np.log(np.maximum(pressures[k : k + 2], 1e-3 * pressure))
    return float(np.exp(np.interp(np.log(pressure), logarithms, np.log(fillings[k : k + 2]))))


def filling_at_share(history, one, other, share):
    """The filling factor from which on, to the end of the compression, the series `one` is at least `share` of the series `other`, both
    counted from the start; NaN where it never is, or always was."""
    part = compressing(history)
    grown, reference = (history[name][part] - history[name][0] for name in (one, other))
    k = _last_below(grown < share * reference)
    return float("nan") if k is None else float(history["filling"][part][k + 1])


def _last_below(below):
    """Place of the last True of below (T,); None where there is none, or where it is the last of all."""
    places = np.flatnonzero(below)
    return int(places[-1]) if len(places) and places[-1] + 1 < len(below) else None
