"""A compression as a function of the filling factor: from the history of a run to values at fixed filling factors."""

import numpy as np

# Eight a decade, 0.001 to 0.56; a bin reaches half-way to its neighbours.
FILLINGS = 10.0 ** (np.arange(-24, -1) / 8.0)
HALF_BIN = 10.0 ** (1.0 / 16.0)
AVERAGED = 1000.0  # t0 over which K13 averages the pressure (section 2.4)


def compressing(history):
    """(T,) bool: the samples up to the largest filling factor; those after it are of the stretching."""
    return np.arange(len(history["filling"])) <= int(np.argmax(history["filling"]))


def windows(time, width):
    """(first, last + 1) of the samples, time (T,), in each window of that width, one after the other; the last, incomplete
    window is left out, unless it is the only one."""
    number = np.floor((time - time[0]) / width).astype(int)
    starts = np.flatnonzero(np.diff(number, prepend=-1))
    ends = np.append(starts[1:], len(time))
    whole = max(1, len(starts) - 1)
    return list(zip(starts[:whole], ends[:whole]))


def averaged(history, names, width):
    """{name: (K,)} means of series over successive windows of `width` [s] while the cell shrinks (K13 section 2.4)."""
    part = compressing(history)
    edges = windows(history["time"][part], width)
    return {name: np.array([history[name][part][a:b].mean() for a, b in edges]) for name in names}


def pressure_at(history, fillings=FILLINGS, power=3.0):
    """Pressure (K,) [Pa] at filling factors (K,): the mean of P/phi^power over the bin around each, times phi^power, which
    leaves no bias of the bin's width where P goes with that power; NaN where the run does not cover the bin."""
    reduced = history["pressure"] / history["filling"] ** power
    return fillings**power * binned(history, reduced, fillings)


def binned(history, values, fillings=FILLINGS):
    """Means (K,) of values (T,) over the bins around the filling factors (K,), while the cell shrinks; NaN where the run
    does not cover the bin."""
    part = compressing(history)
    filling, values = history["filling"][part], values[part]
    found = np.full(len(fillings), np.nan)
    for k, centre in enumerate(fillings):
        low, high = centre / HALF_BIN, centre * HALF_BIN
        inside = (filling >= low) & (filling < high)
        if inside.any() and filling[0] <= low and filling[-1] >= high * (1.0 - 1e-9):
            found[k] = values[inside].mean()
    return found


def at_filling(history, name, filling):
    """Value of a series when the filling factor is reached, linear between samples; NaN outside of the run."""
    part = compressing(history)
    grown = history["filling"][part]
    if not grown[0] <= filling <= grown[-1]:
        return float("nan")
    return float(np.interp(filling, grown, history[name][part]))


def filling_at_pressure(history, pressure, width):
    """The filling factor from which on the pressure, averaged over `width` [s], stays above `pressure` [Pa]; NaN where it
    never does, or always did."""
    means = averaged(history, ("filling", "pressure"), width)
    below = np.flatnonzero(means["pressure"] < pressure)
    if not len(below) or below[-1] + 1 == len(means["pressure"]):
        return float("nan")
    k = below[-1]
    return float(
        np.exp(
            np.interp(
                np.log(pressure),
                np.log(np.maximum(means["pressure"][k : k + 2], 1e-3 * pressure)),
                np.log(means["filling"][k : k + 2]),
            )
        )
    )


def tension(history, width):
    """(filling factors (K,), tensions (K,) [Pa]) while the cell is stretched: minus the work of the grains on the
    boundaries per change of volume, over successive windows of `width` [s]. Along one axis it is the stress on that axis,
    the tangential forces included. Empty without stretching."""
    after = ~compressing(history)
    after[np.argmax(history["filling"])] = True
    if after.sum() < 3:
        return np.array([]), np.array([])
    time, work = history["time"][after], history["boundaryWork"][after]
    volume = np.prod([history[f"edge_{axis}"][after] for axis in "xyz"], axis=0)
    filling = history["filling"][after]
    # From the first sample of a window to that of the next.
    edges = [(a, min(b, len(time) - 1)) for a, b in windows(time, width) if a < len(time) - 1]
    stress = [-(work[b] - work[a]) / (volume[b] - volume[a]) for a, b in edges]
    return np.array([filling[a : b + 1].mean() for a, b in edges]), np.array(stress)
