"""A periodic cell and its compression (Kataoka et al. 2013, K13): virial pressure, filling factor, strength. SI units.

N grains at position (N,3), anywhere: the cell with edges cell_size (3,) is around the origin, and two grains meet as
their nearest images. M contacts: pairs (M,2) of rows. Pressures are positive where the grains push outwards.

Between two samples of a history the pressure is the work of the grains on the boundaries over the change of volume:
the mean over all steps of the virial's pressure (eq 21, damping forces included), or of that on the piston, as K13
averages. The virial's own series is of the moment of each sample, which misses oscillations faster than samples.
"""

import numpy as np

AVERAGED = 1000.0  # t0 over which K13 averages the pressure (section 2.4)
SMOOTHED = 0.1  # noise lifts the largest tension over AVERAGED, by 6 % at a filling factor of 0.3, by half at 0.1


def nearest_image(separation, cell_size):
    """separation (..., 3) between grains as that between their nearest images."""
    separation = np.asarray(separation, dtype=float)
    return separation - cell_size * np.round(separation / cell_size)


def contact_pressure(position, pairs, normal_force, cell_size):
    """Sum of (r_i - r_j) f_ij over 3 V [Pa]: the second term of K13 eq 21.

    normal_force (M,) [N], positive when repulsive, is all that is needed: sliding pulls at right angles to r_i - r_j
    (A24 eq A8), rolling and twisting exert torques only.
    """
    first, second = np.asarray(pairs, dtype=np.intp).reshape(-1, 2).T
    distance = np.linalg.norm(nearest_image(position[first] - position[second], cell_size), axis=1)
    return float(distance @ np.asarray(normal_force)) / (3.0 * float(np.prod(cell_size)))


def kinetic_pressure(mass, position, velocity, cell_size, rate):
    """2 K/(3 V) [Pa] with the translational kinetic energy K of the grains' images in the cell (K13 eqs 8-11): the
    first term of K13 eq 21.

    It counts the mean flow of the cell too, as K13 does. mass (N,) [kg]; rate (3,) [1/s] of the edges' logarithms.
    """
    inside = velocity - rate * cell_size * np.round(position / cell_size)
    twice = float(np.asarray(mass) @ np.einsum("ij,ij->i", inside, inside))
    return twice / (3.0 * float(np.prod(cell_size)))


def filling_factor(radius, cell_size):
    """Volume of the spheres, radius (N,), over that of the cell (K13 eq 22; overlaps counted twice)."""
    return float(4.0 / 3.0 * np.pi * np.sum(np.asarray(radius, dtype=float) ** 3) / np.prod(cell_size))


def work_on_boundaries(history):
    """Work (T,) [J] of the grains on what compresses them: the boundaries of a periodic cell, or plates."""
    return history["boundaryWork"] + history["constraintWork"]


def compressing(history):
    """(T,) bool: the samples up to the largest filling factor; those after it are of the stretching."""
    return np.arange(len(history["filling"])) <= int(np.argmax(history["filling"]))


def volume(history):
    """Volume of the cell (T,) [m^3]."""
    return np.prod([history[f"edge_{axis}"] for axis in "xyz"], axis=0)


def windows(time, width):
    """(first, last + 1) of the samples, time (T,), in each window of that width, one after the other.

    The last, incomplete window is left out, unless it is the only one.
    """
    number = np.floor((time - time[0]) / width).astype(int)
    starts = np.flatnonzero(np.diff(number, prepend=-1))
    ends = np.append(starts[1:], len(time))
    whole = max(1, len(starts) - 1)
    return list(zip(starts[:whole], ends[:whole]))


def pressures(history):
    """(filling factors (K,), pressures (K,) [Pa]) between the samples while the cell shrinks, the fillings half-way."""
    part = compressing(history)
    filling, size = history["filling"][part], volume(history)[part]
    return np.sqrt(filling[1:] * filling[:-1]), np.diff(work_on_boundaries(history)[part]) / np.diff(size)


def pressure_over(history, width):
    """(filling factors (K,), pressures (K,) [Pa]) over successive windows of `width` [s] while the cell shrinks."""
    return _work_over_volume(history, compressing(history), width)


def pressure_at_end(history, width):
    """Pressure [Pa] over the last `width` [s], work over volume; of a cell that was stretched the mean of the
    samples."""
    last = history["time"] >= history["time"][-1] - width
    if last.sum() < 2 or not compressing(history).all():
        return float(history["pressure"][last].mean())
    work, size = work_on_boundaries(history)[last], volume(history)[last]
    return float((work[-1] - work[0]) / (size[-1] - size[0]))


def tension(history, width):
    """(filling factors (K,), tensions (K,) [Pa]) over successive windows of `width` [s] while the cell is stretched.

    Along one axis it is the stress on that axis, tangential forces included. Empty without stretching.
    """
    after = ~compressing(history)
    after[np.argmax(history["filling"])] = True
    if after.sum() < 3:
        return np.array([]), np.array([])
    fillings, pressures = _work_over_volume(history, after, width)
    return fillings, -pressures


def tensile_strength(history, width):
    """(largest tension() [Pa], the filling factor there), over SMOOTHED of the time that it takes to get there, and
    `width` [s] at least; NaN of a cell that was not stretched."""
    _, stress = tension(history, width)
    if not len(stress):
        return float("nan"), float("nan")
    fillings, stress = tension(history, width * max(1.0, SMOOTHED * np.argmax(stress)))
    k = np.argmax(stress)
    return float(stress[k]), float(fillings[k])


def at_filling(history, name, filling):
    """Value of a series when the filling factor is reached, linear between samples; NaN outside of the run."""
    part = compressing(history)
    return float(np.interp(filling, history["filling"][part], history[name][part], left=np.nan, right=np.nan))


def filling_at_pressure(history, pressure, width):
    """The filling factor from which on the pressure, averaged over `width` [s], stays above `pressure` [Pa].

    NaN where it never does, or always did.
    """
    fillings, pressures = pressure_over(history, width)
    below = np.flatnonzero(pressures < pressure)
    if not len(below) or below[-1] + 1 == len(pressures):
        return float("nan")
    k = below[-1]
    logarithms = np.log(np.maximum(pressures[k : k + 2], 1e-3 * pressure))
    return float(np.exp(np.interp(np.log(pressure), logarithms, np.log(fillings[k : k + 2]))))


def _work_over_volume(history, part, width):
    time, work, filling = history["time"][part], work_on_boundaries(history)[part], history["filling"][part]
    size = volume(history)[part]
    # From the first sample of a window to that of the next.
    edges = [(a, min(b, len(time) - 1)) for a, b in windows(time, width) if a < len(time) - 1]
    pressures = [(work[b] - work[a]) / (size[b] - size[a]) for a, b in edges]
    return np.array([filling[a : b + 1].mean() for a, b in edges]), np.array(pressures)
