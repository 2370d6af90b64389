"""Pressure and coordination number of a compression at fixed filling factors."""

import numpy as np

from ...measures.periodic_cell import compressing, pressures
from ...theory.aggregates import bcca_coordination
from ...theory.compression import compressive_strength_dense

# Eight a decade from 0.001 to 0.24, where a bin reaches half-way to its neighbours. Above, pressure rises too steeply for bins as wide:
# these are narrow, and the last are those that runs to 0.5 and 0.64 cover.
LOOSE = 10.0 ** (np.arange(-24, -4) / 8.0)
DENSE = np.array([0.30, 0.35, 0.40, 0.45, 0.49, 0.55, 0.60, 0.625])
FILLINGS = np.concatenate([LOOSE, DENSE])
# A bin is from its filling factor over this to that times this.
HALF_BINS = np.concatenate([np.full(len(LOOSE), 10.0 ** (1.0 / 16.0)), np.full(len(DENSE), 1.02)])


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
